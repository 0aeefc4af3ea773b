// What a replay of a journal will cost, without touching the image: the journal is replayed on a proxy, the same view
// with a small share of its pixels, and what was counted there is scaled. Times and bytes are extrapolated from two
// proxies, since a part of them does not grow with the image.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "edit/apply.h"
#include "edit/frame_place.h"
#include "edit/journal.h"
#include "frame/image.h"
#include "image/render.h"
#include "scene/compile/state.h"

namespace relook {

/// One frame of a replay, as predicted.
struct PlannedFrame {
  FramePlace place;
  bool is_whole_step = false;  // of a drag or wedge: the frame is its last one
  std::string name;
  std::uint32_t from = 0;  // the step in whose state it starts; 0: base
  Classification classification;
  std::uint64_t samples_affected = 0, pixels_changed = 0;
  double seconds = 0;                // of all phases but writing
  std::uint64_t resident_bytes = 0;  // afterwards
};

struct Plan {
  std::uint64_t samples_total = 0;
  std::uint32_t proxy_width = 0, proxy_height = 0;  // of the larger one
  std::vector<PlannedFrame> frames;                 // in the order of the report's, without step 0
};

/// `document`, `camera` and `view`: those of the cache; `journal` has passed check_journal() on them. Replays with
/// default structures and no limit on memory.
[[nodiscard]] Plan plan_replay(const LookDocument& document, const Camera& camera,
                               const std::shared_ptr<PyramidStore>& pyramids, const ViewOptions& view,
                               const Journal& journal, const Progress& progress = {});

}  // namespace relook
