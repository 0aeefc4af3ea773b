// What edits would change, found by making them and taking them back.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "scene/compile/state.h"

namespace relook {

/// Tries edits of each value at a pointer into the look document and below it. `is_wanted` sees the state after an
/// edit, and what changed; when it refuses, another value is tried. The state is as before in the end. Throws
/// InputError{file, pointer, ...} if there is nothing at the pointer.
void try_edits(SceneState& state, std::string_view file, const std::string& pointer,
               const std::function<bool(const SceneDelta&)>& is_wanted);

}  // namespace relook
