// A rig of lights around a target, as a journal: all of them, then each alone.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "edit/draft/journal_draft.h"

namespace relook {

inline constexpr std::array<std::string_view, 4> kRigStyles{"three-point", "softboxes", "rim", "product"};

struct RigOptions {
  std::string style{kRigStyles.front()};
  std::string target;       // node; "": all that is visible
  bool uses_lamps = false;  // spots in place of areas, for --integrator whitted
  bool replaces = false;    // the scene's own lights and its environment go dark in the rig, too
  double level = 0.8;       // the value of a white diffuse surface that faces the key
};
/// Step "rig" adds the lights and their nodes, seen from the camera; a step for each, from "rig", leaves nothing else
/// alight but what emits. Throws InputError when there is nothing to light.
[[nodiscard]] JournalDraft draft_rig(const LookDocument& document, const Camera& camera, const RigOptions& options);

}  // namespace relook
