// A ray of a ray tree on its way: what a hit, or the camera, sends out and what is traced.
#pragma once
#include <cstdint>
#include <limits>

#include "trace/tracer.h"
#include "trace/tree/branch.h"
#include "trace/tree/path_state.h"

namespace relook {

/// A ray on its way: the primary ray of a sample, or one spawned by a hit. One that goes straight on has no origin of
/// its own: it is the ray that it comes from, behind that hit.
struct SpawnedRay {
  Point origin{0, 0, 0};
  Direction direction{0, 0, -1};  // unit
  float cone_width = 0;           // metres, at the origin
  float cone_spread = 0;          // metres per metre
  float fresnel_product = 1;      // of the dielectric terms so far: the cut-off
  std::uint8_t generation = 1;    // 1: primary
  Branch branch = Branch::primary;
  Channel channel = Channel::all;                      // follows from the branches that lead here
  float start = 0;                                     // metres: nothing is met before
  float end = std::numeric_limits<float>::infinity();  // nor after
  Meeting behind{};           // the hit that it goes straight on from; t NaN: not known; object none: no such hit
  float travelled = 0;        // metres from the origin to that hit
  float travelled_slack = 0;  // distance_slack() there
  PathState path{};

  [[nodiscard]] bool goes_on() const { return !behind.object.is_none(); }
  /// Does it meet the same, and spawn the same there?
  [[nodiscard]] bool is_same_way(const SpawnedRay& other) const {
    return origin == other.origin && direction == other.direction && goes_on() == other.goes_on() &&
           cone_spread == other.cone_spread && path.alpha_floor == other.path.alpha_floor &&
           path.gathers == other.path.gathers && generation == other.generation;
  }
};

/// The ray as it is traced.
[[nodiscard]] inline Ray ray_of(const SpawnedRay& spawned) {
  return {spawned.origin, spawned.direction, spawned.end, spawned.start, spawned.behind};
}

}  // namespace relook
