// Directions of the lobes of ggx.h and brushed_ggx.h: a local view and a point of the unit square in, a visible normal,
// the direction that it reflects, and their densities out. Densities are written without differences of nearly equal
// numbers, so they hold for the narrowest lobes and at grazing angles.
#pragma once
#include "physics/fresnel.h"
#include "physics/scalar.h"

namespace relook {

/// The view that lobes are sampled for: of length 1, with a cosine of at least kLeastCosine, wherever a bent normal
/// puts it.
[[nodiscard]] inline Direction facing(const Direction& view) {
  if (view.z >= kLeastCosine) return view;
  return normalized(Direction(view.x, view.y, kLeastCosine));
}

/// A normal of the microfacets, as likely as the view sees it: on the hemisphere of stretched views such normals lie
/// halfway between the view and a point of a spherical cap (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
/// Spherical Caps", listing 3). `view`: local and facing. `alpha_x`, `alpha_y`: along the axes.
[[nodiscard]] inline Direction visible_normal(float alpha_x, float alpha_y, const Direction& view, const Uv& u) {
  const Direction seen = normalized(Direction(view.x * alpha_x, view.y * alpha_y, view.z));
  // The cap's height z lies in (-seen.z, 1]: `low` is z + seen.z, and 1 - z^2 is (1 - z) (1 + z).
  const float low = (1.0F - u.y) * (1.0F + seen.z);
  const float above = u.y * (1.0F + seen.z);
  const float below = low + (seen.x * seen.x + seen.y * seen.y) / (1.0F + seen.z);
  const float radius = sqrt(above * below);
  const Direction half(radius * portable_cos_turns(u.x) + seen.x, radius * portable_sin_turns(u.x) + seen.y, low);
  return normalized(Direction(half.x * alpha_x, half.y * alpha_y, half.z));
}

/// The direction from the surface into which a microfacet of this normal sends the light that comes along -view.
[[nodiscard]] inline Direction reflected_direction(const Direction& view, const Direction& half) {
  return half * (2.0F * view.dot(half)) - view;
}

/// Of reflected directions above the surface, per steradian: G1 D / (4 NV), with G1 of Smith (Heitz 2014, equation 43).
/// Its integral over these is the share of visible normals that reflect upwards. `view`: local and facing; `way`:
/// local, of length 1.
[[nodiscard]] inline float ggx_reflection_density(float alpha_x, float alpha_y, const Direction& view,
                                                  const Direction& way) {
  if (!(way.z > 0.0F)) return 0.0F;
  const Direction half = view + way;  // any length
  const float stretched = square(half.x / alpha_x) + square(half.y / alpha_y) + square(half.z);
  const float share = half.dot(half) / stretched;
  const float distribution = share * share * kInversePi / (alpha_x * alpha_y);
  const float length = sqrt(square(alpha_x * view.x) + square(alpha_y * view.y) + square(view.z));
  return distribution * 0.5F / (view.z + length);
}

}  // namespace relook
