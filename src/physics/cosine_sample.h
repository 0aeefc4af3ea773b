// Directions of the diffuse lobe (lambert.h, and the sheen above it): a point of the unit square in, a local direction
// and its density out.
#pragma once
#include <cmath>

#include "physics/fresnel.h"
#include "physics/scalar.h"

namespace relook {

/// A place on the unit disc, even in area, by Shirley and Chiu's concentric map (1997): neighbours in the square stay
/// neighbours.
struct DiscPlace {
  float radius, turns;  // [-1, 1]; radius below 0: on the other side

  explicit DiscPlace(const Uv& u) {
    const float a = 2.0F * u.x - 1.0F, b = 2.0F * u.y - 1.0F;
    const bool is_wide = std::fabs(a) > std::fabs(b);
    radius = is_wide ? a : b;
    const float ratio = radius == 0.0F ? 0.0F : (is_wide ? b : a) / radius;  // [-1, 1]
    turns = is_wide ? ratio * 0.125F : 0.25F - ratio * 0.125F;
  }
};

/// As likely as its cosine, which is at least kLeastCosine (Malley's method).
[[nodiscard]] inline Direction cosine_direction(const Uv& u) {
  const DiscPlace at(u);
  const float up2 = (1.0F - at.radius) * (1.0F + at.radius);
  return {at.radius * portable_cos_turns(at.turns), at.radius * portable_sin_turns(at.turns),
          sqrt(max(up2, kLeastCosine * kLeastCosine))};
}

/// Per steradian; 0 below the surface.
[[nodiscard]] inline float cosine_density(float cosine) { return max(cosine, 0.0F) * kInversePi; }

/// Even over the hemisphere, with a cosine of at least kLeastCosine.
[[nodiscard]] inline Direction even_direction(const Uv& u) {
  const DiscPlace at(u);
  const float up = (1.0F - at.radius) * (1.0F + at.radius), out = at.radius * sqrt(1.0F + up);
  return {out * portable_cos_turns(at.turns), out * portable_sin_turns(at.turns), max(up, kLeastCosine)};
}

/// How the diffuse lobe is sampled: by cosine; under a sheen, whose lobe is brightest at the horizon, half of it evenly.
struct DiffuseDirections {
  bool has_sheen = false;

  [[nodiscard]] Direction sample(const Uv& u) const {
    if (!has_sheen) return cosine_direction(u);
    return u.x < 0.5F ? cosine_direction({2.0F * u.x, u.y}) : even_direction({2.0F * u.x - 1.0F, u.y});
  }
  /// Per steradian; 0 below the surface.
  [[nodiscard]] float density(float cosine) const {
    if (!has_sheen) return cosine_density(cosine);
    return cosine > 0.0F ? (cosine + 0.5F) * (0.5F * kInversePi) : 0.0F;
  }
};

}  // namespace relook
