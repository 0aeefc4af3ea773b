// Edits of lights at random, on scenes of the integrator `path`.
#pragma once
#include "random_changes.h"

namespace relook {

/// An edit of one light, of the environment or of what emits, in lights_scene() or study_scene() as it is now.
[[nodiscard]] Change random_light_change(const Json& look, Dice& dice);
/// One of these or random_change(), both perhaps in one edit.
[[nodiscard]] Change random_path_change(const Json& look, Dice& dice);

}  // namespace relook
