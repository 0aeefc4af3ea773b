#pragma once
#include <string>
#include <vector>

#include "options/arguments.h"
#include "scene/look/look.h"
#include "terminal/console.h"

namespace relook {

/// What --camera may name: the cameras that stand in the scene, by name, then other nodes that hold one of them.
[[nodiscard]] std::vector<std::string> camera_names(const LookDocument& document);

/// `inspect SCENE|CACHE --cameras`: a line each: name, eye, direction, field of view, aspect.
void inspect_cameras(const Arguments& arguments, Console& console);

}  // namespace relook
