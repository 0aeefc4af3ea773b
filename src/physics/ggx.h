// The lobe of rough surfaces: GGX's distribution (Walter et al. 2007, equation 33) and Smith's height-correlated
// visibility (Heitz 2014, equation 99; glTF 2.0, appendix B.3.2). Cosines and a roughness in, D V out: to be multiplied
// by the reflectance at V.H. brushed_ggx.h has the lobe of surfaces that are rougher one way than the other.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// Of a material's roughness; no lobe is narrower than that of 0.05.
template <class S>
[[nodiscard]] S alpha_of(S roughness) {
  const S rough = max(roughness, 0.05F);
  return rough * rough;
}

/// D. `alpha2`: alpha squared.
template <class S>
[[nodiscard]] S ggx_distribution(S alpha2, S nh) {
  const S d = nh * nh * (alpha2 - 1.0F) + 1.0F;
  return alpha2 * kInversePi / (d * d);
}
/// V: the share that shadowing and masking leave, over 4 NL NV.
template <class S>
[[nodiscard]] S ggx_visibility(S alpha2, S nl, S nv) {
  const S lambda_l = nv * sqrt(nl * nl * (1.0F - alpha2) + alpha2);
  const S lambda_v = nl * sqrt(nv * nv * (1.0F - alpha2) + alpha2);
  return 0.5F / max(lambda_l + lambda_v, 1e-7F);
}
template <class S>
[[nodiscard]] S ggx(S alpha2, S nh, S nl, S nv) {
  const S distribution = ggx_distribution(alpha2, nh);
  return distribution * ggx_visibility(alpha2, nl, nv);
}

/// The same as ggx, with the squared sine beside the cosine (half_sine2): ggx_distribution loses 1 to 3 % of the light
/// of the narrowest lobes in the rounding of nh^2.
template <class S>
[[nodiscard]] S precise_ggx(S alpha2, S nh, S sine2, S nl, S nv) {
  const S d = max(nh * nh * alpha2 + sine2, 1e-9F);  // no half vector lies between opposite directions
  const S distribution = alpha2 * kInversePi / (d * d);
  return distribution * ggx_visibility(alpha2, nl, nv);
}

}  // namespace relook
