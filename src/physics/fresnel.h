// How much a boundary reflects: cosines of incidence and indices of refraction in, reflectances of unpolarised light
// out. Fresnel's equations (Born and Wolf 1999, 1.5.2), Schlick's approximation (1994, equation 15; glTF 2.0, appendix
// B.3.4) and KHR_materials_clearcoat's boundary of a coat.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// Cosines with the view are at least this, so that no lobe divides by 0.
inline constexpr float kLeastCosine = 1e-4F;

/// Snell's law: the squared sine of the refracted ray; total reflection from 1 on. `eta`: index behind over index in
/// front.
template <class S>
[[nodiscard]] S sin2_behind(S cosine, S eta) {
  return (1.0F - cosine * cosine) / (eta * eta);
}

/// At normal incidence, between two indices of refraction.
template <class S, class T>
[[nodiscard]] S normal_reflectance(S behind, T in_front) {
  const S root = (behind - in_front) / (behind + in_front);
  return square(root);
}

/// Where light is refracted. `cos_in`, `cos_behind`: of its ray on both sides; `eta` as above.
template <class S>
[[nodiscard]] S boundary_reflectance(S cos_in, S cos_behind, S eta) {
  const S s = (cos_in - eta * cos_behind) / (cos_in + eta * cos_behind);
  const S p = (cos_behind - eta * cos_in) / (cos_behind + eta * cos_in);
  return (s * s + p * p) * 0.5F;
}

/// Exact, 1 at total reflection.
[[nodiscard]] inline float dielectric_reflectance(float cosine, float eta) {
  const float sin2 = sin2_behind(cosine, eta);
  return sin2 >= 1.0F ? 1.0F : boundary_reflectance(cosine, sqrt(1.0F - sin2), eta);
}

/// From f0 at normal incidence to f90 at grazing incidence.
template <class F, class N, class S>
[[nodiscard]] F reflectance_between(const F& f0, const N& f90, S weight) {
  return f0 + (f90 - f0) * weight;
}

/// m^5, by squares.
template <class S>
[[nodiscard]] S fifth_power(S m) {
  const S m2 = m * m;
  return m2 * m2 * m;
}
/// Schlick's weight between f0 and f90, (1 - c)^5, for a cosine of at least 0.
template <class S>
[[nodiscard]] S schlick(S cosine) {
  return fifth_power(1.0F - min(cosine, 1.0F));
}
/// The weight of the exact reflectance R of a body of index `ior`, met from outside or inside: (R - r0) / (1 - r0).
template <class S>
[[nodiscard]] S exact_weight(S ior, bool is_inside, S cosine) {
  const S index = max(ior, 1.0F);
  const S eta = is_inside ? 1.0F / index : index;
  const S c = min(cosine, 1.0F);
  const S cos2_behind = 1.0F - sin2_behind(c, eta);
  const S reflectance = boundary_reflectance(c, sqrt(max(cos2_behind, 0.0F)), eta);
  const S r0 = normal_reflectance(index, 1.0F);
  const S weight = min(max((reflectance - r0) / (1.0F - r0), 0.0F), 1.0F);
  return if_positive(cos2_behind, weight, number(weight, 1));
}

/// A clearcoat, of index 1.5, by Schlick's weight.
template <class S>
[[nodiscard]] S coat_reflectance(S weight) {
  return weight * 0.96F + 0.04F;
}

}  // namespace relook
