// How far a point on a surface may be off it, inside src/trace.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace relook {

/// Metres that clear rounding errors, which follow the largest numbers added up on the way from object space to the
/// world, anywhere on the surface: near the origin of a large triangle they are as large as at its corners. `largest`:
/// the largest coordinates of it by magnitude, axis by axis.
[[nodiscard]] inline float rounding_offset(const Transform& to_world, const Point& largest) {
  constexpr float kUlps = 0x1p-19F;  // 32 units in the last place
  float most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    float sum = std::fabs(to_world[3][axis]);
    for (int i = 0; i < 3; ++i) sum += largest[i] * std::fabs(to_world[i][axis]);
    most = std::max(most, sum);
  }
  return most * kUlps;
}

}  // namespace relook
