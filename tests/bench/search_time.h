// Selection-dependent preprocessing (paper 3.1) alone: from what an edit changes to the samples that depend on it, by
// looking at every sample's path, or at groups first. In a step without groups this is part of the update.
#pragma once
#include "setup.h"

namespace relook {

/// Seconds without and with groups, each the fastest of some runs.
struct SearchTimes {
  double without = 0, with = 0;
};

/// Follows a journal on a scene of its own.
class SearchTimer {
 public:
  explicit SearchTimer(SceneState state) : state_(std::move(state)) {}
  /// Applies the next edit. `replayer`: about to apply it, with groups and without atoms.
  [[nodiscard]] SearchTimes next(const Replayer& replayer, const Edit& edit, const Journal& journal);

 private:
  SceneState state_;
};

}  // namespace relook
