// The lobe of brushed surfaces (KHR_materials_anisotropy; Burley 2012, equation 13; Heitz 2014, section 5.4): ggx.h
// with an alpha along the brush, the wider, and one across it.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// The frame of a brushed surface: zero vectors where the mesh gives none.
template <class V>
struct BrushAxes {
  V along, across;
};
/// The axes of a map turned by an angle of cosine x and sine y.
template <class V>
[[nodiscard]] BrushAxes<V> brush_axes(const V& tangent, const V& bitangent, ScalarOf<V> x, ScalarOf<V> y) {
  const V along = tangent * x + bitangent * y;
  return {along, bitangent * x - tangent * y};
}

/// The alpha along the brush; `strength2`: the strength of the anisotropy, squared.
template <class S>
[[nodiscard]] S widened(S alpha, S strength2) {
  return alpha + (1.0F - alpha) * strength2;
}

/// A direction by its cosines with the axes and the normal.
template <class S>
struct Brushed {
  S along, across, up;
};

/// D
template <class S>
[[nodiscard]] S brushed_distribution(S alpha_along, S alpha_across, const Brushed<S>& half) {
  const S both = alpha_along * alpha_across;
  const S stretched = square(alpha_across * half.along) + square(alpha_along * half.across) + square(both * half.up);
  const S share = both / max(stretched, 1e-12F);
  return both * share * share * kInversePi;
}
/// V
template <class S>
[[nodiscard]] S brushed_visibility(S alpha_along, S alpha_across, const Brushed<S>& light, const Brushed<S>& view) {
  const auto length = [&](const Brushed<S>& w) {
    return sqrt(square(alpha_along * w.along) + square(alpha_across * w.across) + square(w.up));
  };
  return 0.5F / max(light.up * length(view) + view.up * length(light), 1e-7F);
}
template <class S>
[[nodiscard]] S brushed_ggx(S alpha_along, S alpha_across, const Brushed<S>& half, const Brushed<S>& light,
                            const Brushed<S>& view) {
  const S distribution = brushed_distribution(alpha_along, alpha_across, half);
  return distribution * brushed_visibility(alpha_along, alpha_across, light, view);
}

}  // namespace relook
