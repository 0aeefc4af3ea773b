// What a ray of the path integrator carries beside its way: what its sample is known by, and what scattered it last.
#pragma once
#include <cstdint>

#include "base/id.h"
#include "light/point_set.h"

namespace relook {

/// All as it is at the eye, unless said otherwise. Under Integrator::whitted nothing reads it.
struct PathState {
  SampleKey key;
  std::uint64_t history = 0;  // of the vertex that this ray leads to (child_history)
  ObjectId from;              // the surface that scattered it last; none: it comes straight from the eye
  float density = 0;          // per steradian, times the share of the lobe that sent it; 0: of no lobe, or bent since
  float alpha_floor = 0;      // least alpha of reflecting lobes from here on
  std::uint8_t glossy = 0;    // reflections so far
  std::uint8_t straight = 0;  // straight rays by coverage so far: of the eye, or since the first scattering
  bool is_first = true;       // it is the first lobe's, or none has scattered it yet
  bool is_eye = true;         // nothing has turned it
  bool gathers = false;       // where it ends, emission counts and nothing is scattered
  bool is_shut = false;       // from a wide lobe, through what turns rays alone: lights with a size reach it by segments
  bool is_wide = false;       // of a wide lobe whose lights have samples, as long as it runs straight
  bool is_alone = false;      // no sample of a light stands for its way
  bool has_lamps = false;     // by straight segments lamps without size reach what sent it through all that transmits
  std::uint8_t diffuse = 0, transmission = 0;  // bounces of these kinds so far
};

/// Straight rays by coverage that follow each other, at most.
inline constexpr std::uint8_t kMostStraight = 16;
/// What is counted of them behind a vertex that scatters: the eye's do not count there.
[[nodiscard]] inline std::uint8_t straight_behind(const PathState& from) {
  return from.from.is_none() ? std::uint8_t{0} : from.straight;
}

}  // namespace relook
