// A step of a replay under the path integrator: edits of lights' colours cost pixels, in a sum that lights share the
// samples that they light, edits of one light its own rays, all others the samples that they reach. The frame afterwards
// equals render() of the edited scene, bit for bit.
#pragma once
#include "edit/scene_history.h"
#include "replay/replay_parts.h"
#include "replay/step_result.h"

namespace relook {

/// Applies an edit. Throws what it throws, with everything as before.
[[nodiscard]] StepResult path_step(ReplayParts& parts, const SceneEdit& edit);
/// Makes the terms that edits of these parameters of materials exchange before there is any such edit (paper 4.1.1).
void keep_path_terms(ReplayParts& parts, const ParameterSet& parameters);

}  // namespace relook
