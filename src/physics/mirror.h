// Mirror rays (Whitted 1980): where they go, and how much of them a roughness leaves.
#pragma once
#include "physics/scalar.h"

namespace relook {

[[nodiscard]] inline Direction unit(const Direction& v) { return v / std::sqrt(v.dot(v)); }

/// The way of the ray that a surface of normal `n` reflects from the way `d`, kept on the side of the geometric surface
/// to which `geometric` points: that of the incoming ray.
[[nodiscard]] inline Direction mirrored(const Direction& d, const Normal& n, const Normal& geometric) {
  Direction r = d - n * (2.0F * d.dot(n));
  const float height = r.dot(geometric);
  if (height < 0) r = r - geometric * (2.0F * height);
  return unit(r);
}

/// The share of a mirror ray that a roughness leaves: 1 at 0, 0 from `threshold` on.
template <class S>
[[nodiscard]] S mirror_fade(S roughness, float threshold) {
  const S t = max(1.0F - roughness / threshold, 0.0F);
  return t * t * (3.0F - t * 2.0F);
}

}  // namespace relook
