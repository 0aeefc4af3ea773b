// Where the nodes of a look document stand in the world, without compiling it: for cameras and automatic lights.
#pragma once
#include <map>
#include <string>

#include "scene/compile_transform.h"
#include "scene/look.h"

namespace relook {

/// World matrix of every node that hangs on a root.
[[nodiscard]] std::map<std::string, WideTransform> world_transforms(const LookDocument& document);

/// World bounds of everything visible; empty if there is nothing.
[[nodiscard]] Box world_bounds(const LookDocument& document);

}  // namespace relook
