// What of a scene cannot be seen though its file names it, in words, for the console of the command that opens the
// scene (cli/input/load_scene.cpp).
#pragma once
#include <string>
#include <vector>

#include "scene/look/look.h"

namespace relook {

/// Nodes that are scaled to nothing, lights without a direction, textures without an image: one sentence each, with
/// what it means for the picture; under Integrator::whitted one for each kind of light that it does without. Requires:
/// check_values() passed.
[[nodiscard]] std::vector<std::string> look_warnings(const LookDocument& document,
                                                     Integrator integrator = Integrator::whitted);

}  // namespace relook
