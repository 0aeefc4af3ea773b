// Parameters that a user has chosen as subject to change (paper 4.1.1): their colour trees are kept before any step has
// changed them, with everything else as constants.
#pragma once
#include <string>

#include "color/expression/parameter_set.h"
#include "scene/compile/state.h"

namespace relook {

/// The colour parameters at a pointer into the look document and below it, told from what edits there would change:
/// they are tried on the state, which is as before afterwards. Throws InputError{"--params", pointer, ...}: there is
/// nothing, or nothing that changes colours alone.
[[nodiscard]] ParameterSet parameters_at(SceneState& state, const std::string& pointer);

}  // namespace relook
