// A drag (paper 2.2): what it moves is lifted, that is, taken out of the ray trees when it moves first; from then on
// each frame renders it on top of the image where it is, and the ray trees stay without it until the drag ends.
#pragma once
#include <vector>

#include "replay/image_pass.h"

namespace relook {

/// Works on the parts of a replay, which outlive it.
class Drag {
 public:
  explicit Drag(ReplayParts& parts) : parts_(parts) {}

  [[nodiscard]] bool has_lifted() const { return !lifted_.empty(); }
  /// Are there only objects that are elsewhere now, or gone?
  [[nodiscard]] static bool is_movement(const StepChange& change);
  /// An intermediate frame, brought up to date. Requires: is_movement(change).
  void show(StepChange& change, StepResult& result, StopWatch& watch);
  /// Makes a change also put what is lifted, where it is now, back into the ray trees. Returns where it was seen, by
  /// tile; empty: nowhere.
  std::vector<SampleColors> end_with(StepChange& change);

 private:
  [[nodiscard]] std::vector<NewSamples> lift(StepChange& change, StepResult& result, StopWatch& watch);
  void render_lifted(std::span<const NewSamples> without, StepResult& result, StopWatch& watch);
  void put_back_with(StepChange& change) const;

  ReplayParts& parts_;
  std::vector<ObjectId> lifted_;      // increasing
  std::vector<SampleColors> on_top_;  // by tile, while objects are lifted: where they are seen
};

}  // namespace relook
