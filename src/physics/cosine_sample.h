// Directions of the diffuse lobe (lambert.h, and the sheen above it): a point of the unit square in, a local direction
// and its density out.
#pragma once
#include <cmath>

#include "physics/fresnel.h"
#include "physics/scalar.h"

namespace relook {

/// As likely as its cosine, which is at least kLeastCosine (Malley's method over Shirley and Chiu's concentric map,
/// 1997). Neighbours in the square stay neighbours.
[[nodiscard]] inline Direction cosine_direction(const Uv& u) {
  const float a = 2.0F * u.x - 1.0F, b = 2.0F * u.y - 1.0F;
  const bool is_wide = std::fabs(a) > std::fabs(b);
  const float radius = is_wide ? a : b;
  const float ratio = radius == 0.0F ? 0.0F : (is_wide ? b : a) / radius;  // [-1, 1]
  const float turns = is_wide ? ratio * 0.125F : 0.25F - ratio * 0.125F;
  const float up2 = (1.0F - radius) * (1.0F + radius);
  return {radius * portable_cos_turns(turns), radius * portable_sin_turns(turns),
          sqrt(max(up2, kLeastCosine * kLeastCosine))};
}

/// Per steradian; 0 below the surface.
[[nodiscard]] inline float cosine_density(float cosine) { return max(cosine, 0.0F) * kInversePi; }

}  // namespace relook
