// The lobe of light that a rough boundary of a volume lets through (Walter, Marschner, Li and Torrance 2007, section 4):
// each microfacet of ggx.h's distribution refracts by Snell's law. The view and a direction on the other side in, value
// and density out; `eta`: index behind over index in front, not so
// near 1 that half vectors are rounding. Radiance is counted per square of the index, as along
// smooth refraction, so no factor of it is left.
#pragma once
#include <optional>

#include "physics/ggx.h"
#include "physics/ggx_sample.h"

namespace relook {

template <class V>
struct RefractedAngles {
  V half;                  // the microfacet's normal, of length 1, on the side of the view
  ScalarOf<V> nh, vh, lh;  // of `half` with the normal, the view and the way, turned up; at least 0
  ScalarOf<V> nl;          // of the normal with the way, turned up; at least 0
  ScalarOf<V> bend2;       // |view + eta way|^2
};
/// `normal`, `view`, `way`: of length 1; `is_denser`: eta > 1.
template <class V>
[[nodiscard]] RefractedAngles<V> refracted_angles(const V& normal, const V& view, const V& way, ScalarOf<V> eta,
                                                  bool is_denser) {
  const V sum = is_denser ? (view + way * eta) * number(eta, -1.0F) : view + way * eta;
  const V half = normalized(sum);
  return {half,
          min(max(dot(normal, half), 0.0F), 1.0F),
          min(max(dot(view, half), 0.0F), 1.0F),
          max(0.0F - dot(way, half), 0.0F),
          max(0.0F - dot(normal, way), 0.0F),
          dot(sum, sum)};
}

/// G1 of Smith over the cosine.
template <class S>
[[nodiscard]] S smith_over_cosine(S alpha2, S cosine) {
  return 2.0F / (cosine + sqrt(cosine * cosine * (1.0F - alpha2) + alpha2));
}

/// Without 1 - F of `vh`, times the cosine with the way. `sine2`: half_sine2 of the half vector.
template <class V>
[[nodiscard]] ScalarOf<V> rough_refraction(ScalarOf<V> alpha2, const RefractedAngles<V>& at, ScalarOf<V> sine2,
                                           ScalarOf<V> nv, ScalarOf<V> eta) {
  using S = ScalarOf<V>;
  const S d = max(at.nh * at.nh * alpha2 + sine2, 1e-9F);
  const S distribution = alpha2 * kInversePi / (d * d);
  const S seen = smith_over_cosine(alpha2, nv) * (smith_over_cosine(alpha2, at.nl) * at.nl);
  return distribution * seen * at.vh * (eta * eta * at.lh / max(at.bend2, 1e-9F));
}

/// The way behind the boundary of what comes along -view; none at total reflection. `view`: local and facing.
[[nodiscard]] inline std::optional<Direction> refracted_direction(const Direction& view, const Direction& half,
                                                                  float eta) {
  const float cosine = min(view.dot(half), 1.0F), sin2 = sin2_behind(cosine, eta);
  if (!(cosine > 0.0F) || sin2 >= 1.0F) return std::nullopt;
  return half * (cosine / eta - sqrt(1.0F - sin2)) - view / eta;
}

/// Of directions refracted at visible normals, per steradian. `view`: local and facing; `way`: local, of length 1.
[[nodiscard]] inline float ggx_refraction_density(float alpha, const Direction& view, const Direction& way, float eta) {
  if (!(way.z < 0.0F)) return 0.0F;
  const RefractedAngles<Direction> at = refracted_angles(Direction(0, 0, 1), view, way, eta, eta > 1.0F);
  if (!(at.nh > 0.0F && at.vh > 0.0F && at.lh > 0.0F)) return 0.0F;
  const float alpha2 = alpha * alpha, sine2 = square(at.half.x) + square(at.half.y);
  const float d = max(at.nh * at.nh * alpha2 + sine2, 1e-9F);
  const float distribution = alpha2 * kInversePi / (d * d);
  return distribution * smith_over_cosine(alpha2, view.z) * at.vh * (eta * eta * at.lh / max(at.bend2, 1e-9F));
}

}  // namespace relook
