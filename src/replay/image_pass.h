// One pass over the image after a change of the scene: which tiles the change may reach, and the ray trees and colours
// of their samples worked out anew (tile_update.h), the largest tiles first. Everything is counted.
#pragma once
#include <span>
#include <vector>

#include "replay/replay_parts.h"
#include "replay/step_result.h"
#include "replay/tile_update.h"

namespace relook {

/// What of a pass is not as the scene has it.
struct PassKind {
  std::span<const ObjectId> absent{};  // objects that are in no ray tree afterwards, increasing
  bool keeps_trees = true;             // false: an intermediate frame of a drag, whose samples come with their colours
};

/// Works `change` out against the stored trees; those of the tiles change, but for the paths: see keep_trees(). Returns
/// what is new, in the order of tiles.
[[nodiscard]] std::vector<NewSamples> run_pass(ReplayParts& parts, StepChange& change, const PassKind& kind,
                                               StepResult& result, StopWatch& watch);

/// Takes over the paths of a pass that keeps trees, with what follows from them.
void keep_trees(ReplayParts& parts, std::span<const NewSamples> fresh, const StepChange& change);

/// Works pixels out again that lie under samples with new colours or, by tile, under those of `others`, which may be
/// empty. `on_top`: by tile, colours to show in place of the stored ones; empty: none.
void refresh_pixels(StoredImage& stored, std::span<const NewSamples> fresh, std::span<const SampleColors> others,
                    std::span<const SampleColors> on_top, StepResult& result);

}  // namespace relook
