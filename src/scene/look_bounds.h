// Where the nodes of a look document stand in the world, without compiling it: for cameras and automatic lights.
#pragma once
#include <string>

#include "scene/compile_transform.h"
#include "scene/look.h"

namespace relook {

/// World matrix of a node that hangs on a root, without the node's own scale: what a camera on it has.
[[nodiscard]] WideTransform unscaled_transform(const LookDocument& document, const std::string& node);

/// World bounds of everything visible; empty if there is nothing.
[[nodiscard]] WideBox world_bounds(const LookDocument& document);

}  // namespace relook
