// How colours part in glass: the index of refraction of the middle of the spectrum and the strength of
// KHR_materials_dispersion (20 over the Abbe number) in, the index of each channel out. Green takes the middle's.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// How far the indices of blue and of red lie from the middle's.
template <class S>
[[nodiscard]] S half_spread(S ior, S dispersion) {
  return (max(ior, 1.0F) - 1.0F) * (dispersion * 0.025F);
}
/// At least 1, unless the middle's is less.
template <class S>
[[nodiscard]] S red_ior(S ior, S dispersion) {
  const S spread = half_spread(ior, dispersion);
  return max(ior - spread, min(ior, 1.0F));
}
template <class S>
[[nodiscard]] S blue_ior(S ior, S dispersion) {
  return ior + half_spread(ior, dispersion);
}

}  // namespace relook
