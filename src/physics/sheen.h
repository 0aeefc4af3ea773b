// The lobe of cloth (KHR_materials_sheen): Charlie's distribution (Estevez and Kulla 2017, equation 2) with Ashikhmin's
// visibility (Ashikhmin and Premoze 2007), and what it leaves of the light from below (KHR_materials_sheen, "albedo
// scaling").
#pragma once
#include "physics/scalar.h"

namespace relook {

/// 1 over the alpha of a sheen's roughness.
template <class S>
[[nodiscard]] S inverse_sheen_alpha(S roughness) {
  const S rough = max(roughness, 0.07F);
  return 1.0F / (rough * rough);
}

/// D
template <class S>
[[nodiscard]] S charlie_distribution(S inverse_alpha, S nh) {
  const S sin2 = max(1.0F - nh * nh, 1e-7F);
  const S power = exp2(log2(sin2) * (inverse_alpha * 0.5F));
  return (inverse_alpha + 2.0F) * power * (0.5F * kInversePi);
}
/// V
template <class S>
[[nodiscard]] S ashikhmin_visibility(S nl, S nv) {
  return 1.0F / (max(nl + nv - nl * nv, 1e-4F) * 4.0F);
}
/// D V
template <class S>
[[nodiscard]] S sheen(S inverse_alpha, S nh, S nl, S nv) {
  const S distribution = charlie_distribution(inverse_alpha, nh);
  return distribution * ashikhmin_visibility(nl, nv);
}

/// The directional albedo of the lobe: the share of the light from a hemisphere that a white sheen layer sends towards
/// a viewer at cosine `cosine`; at most 1. Bilinear in a 10 x 10 table over (roughness, sqrt(cosine)).
[[nodiscard]] float sheen_albedo(float cosine, float roughness);

/// What a layer of this colour leaves of the light from below.
template <class C>
[[nodiscard]] ScalarOf<C> below_sheen(const C& color, ScalarOf<C> nv, ScalarOf<C> roughness) {
  const ScalarOf<C> albedo = sheen_albedo(min(nv, 1.0F), roughness);
  return max(1.0F - largest(color) * albedo, 0.0F);
}

}  // namespace relook
