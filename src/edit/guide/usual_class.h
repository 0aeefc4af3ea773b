// The class that a usual change of one value has, found by trying some and taking them back.
#pragma once
#include <string>

#include "scene/compile/state.h"
#include "scene/look/look_paths.h"

namespace relook {

/// "color", "optical", "geometric", "mixed"; "color, optical across a bucket" where a small change is color and a
/// larger one is not; "no effect" where the scene shows no difference; "fixed" where no other value is taken. What a
/// journal's step really is, its own values decide (`inspect JOURNAL --scene`). The state is as before in the end.
[[nodiscard]] std::string usual_class(SceneState& state, const LookPath& path);

}  // namespace relook
