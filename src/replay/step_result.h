// What a step of a replay gives back, and the watch that times its phases.
#pragma once
#include <chrono>
#include <vector>

#include "edit/apply.h"
#include "frame/changed_pixels.h"
#include "image/counters.h"
#include "region/quadtree.h"

namespace relook {

struct StepResult {
  Classification classification;
  Counters counters;
  Seconds seconds;  // classify .. evaluate; write and total are the caller's
  ChangedPixels changed_pixels;
  std::vector<Leaves> dependent, touched;  // by tile: leaves whose paths the change reaches, whose tunnels it may touch
};

/// Adds the time since the last call to a field of Seconds.
class StopWatch {
 public:
  void lap(double& seconds) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace relook
