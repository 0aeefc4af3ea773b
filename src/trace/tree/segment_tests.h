// Which stored segments are tested against the selection, and which are ruled out before that, by what; inside
// src/trace. Each segment is asked about once and counted then.
#pragma once
#include <algorithm>

#include "trace/tree/grow.h"

namespace relook {

/// A stored ray that meets nothing, from where it was spawned on, as far as rounding tells.
[[nodiscard]] inline Ray stored_segment(const SpawnedRay& ray) {
  Ray segment = ray_of(ray);
  segment.behind = {};
  segment.t_min = std::max(ray.travelled - ray.travelled_slack, ray.start);
  return segment;
}
/// The ray of a completed hit. `slack`: distance_slack().
[[nodiscard]] inline Ray stored_segment(const RayNode& node, float slack) {
  Ray segment = stored_segment(node.ray);
  segment.t_max = std::min(node.length + slack, node.ray.end);
  return segment;
}

class SegmentTests {
 public:
  SegmentTests(const RayChange& change, std::uint32_t shadow_bits, GrowCounters& counters)
      : change_(change), counts_blockers_(shadow_bits > 0), counters_(counters) {}

  /// Is a ray to be tested? `touched`: its tunnel, if any, does not rule it out.
  [[nodiscard]] bool tests_ray(bool touched, const Ray& ray) {
    if (!touched) return culled(counters_.culled.tunnels);
    if (change_.moved_after.empty()) return culled(counters_.culled.by_class);
    if (!is_near(change_.bounds.moved, ray)) return culled(counters_.culled.boxes);
    ++counters_.ray_tests;
    return true;
  }

  /// Against what of the selection a shadow segment is to be tested: a blocked one can be opened by what stood there
  /// before, any other be blocked by what stands there now, and with counters a blocked one by more.
  struct Shadow {
    bool before = false, after = false;
    [[nodiscard]] bool any() const { return before || after; }
  };
  /// Requires: the state is not facing_away.
  Shadow tests_shadow(ShadowState state, bool touched, const Ray& ray) {
    const bool is_blocked = state == ShadowState::blocked;
    Shadow tests;
    if (!touched) {
      culled(counters_.culled.tunnels);
      return tests;
    }
    tests.before = is_blocked && !change_.shadows_before.empty();
    tests.after = (!is_blocked || counts_blockers_) && !change_.shadows_after.empty();
    if (!tests.any()) {
      culled(counters_.culled.by_class);
      return tests;
    }
    tests.before = tests.before && is_near(change_.bounds.shadows_before, ray);
    tests.after = tests.after && is_near(change_.bounds.shadows_after, ray);
    ++(tests.any() ? counters_.ray_tests : counters_.culled.boxes);
    return tests;
  }

 private:
  [[nodiscard]] bool is_near(const Box& box, const Ray& ray) const {
    return may_meet(box, change_.bounds.condition, ray.origin, ray.direction, ray.t_min, ray.t_max);
  }
  static bool culled(std::uint64_t& count) {
    ++count;
    return false;
  }

  const RayChange& change_;
  bool counts_blockers_;
  GrowCounters& counters_;
};

}  // namespace relook
