// Blinn and Phong's lobe (Blinn 1977), with the scale that keeps its light about the same for any exponent
// (Akenine-Moeller, Haines and Hoffman 2008, 7.6: (n + 8) / (8 pi)). Its value: the scale times the lobe.
#pragma once
#include "physics/scalar.h"

namespace relook {

template <class S>
[[nodiscard]] S phong_scale(S shininess) {
  return (shininess + 8.0F) * (0.125F * kInversePi);
}
/// (N.H)^shininess. `nh`: more than 0.
template <class S>
[[nodiscard]] S phong_lobe(S shininess, S nh) {
  return exp2(log2(min(nh, 1.0F)) * shininess);
}

}  // namespace relook
