// What lobes are functions of: a shading normal and the directions to the eye and to the light in, half vector and
// cosines out.
#pragma once
#include "physics/scalar.h"

namespace relook {

template <class V>
struct LobeAngles {
  V half;              // between light and view, of length 1
  ScalarOf<V> nl, nh;  // of the normal with the light and with `half`, at least 0
  ScalarOf<V> vh;      // of the view with `half`, at least 0
};

/// All of length 1.
template <class V>
[[nodiscard]] LobeAngles<V> lobe_angles(const V& normal, const V& view, const V& light) {
  const V half = normalized(light + view);
  return {half, max(dot(normal, light), 0.0F), min(max(dot(normal, half), 0.0F), 1.0F), max(dot(view, half), 0.0F)};
}

/// The squared sine of `half` with the normal: of what is left of it along the surface, as 1 - nh^2 would be rounding
/// alone where lobes are narrow.
template <class V>
[[nodiscard]] ScalarOf<V> half_sine2(const V& normal, const LobeAngles<V>& at) {
  const V flat = at.half - normal * at.nh;
  return dot(flat, flat);
}

}  // namespace relook
