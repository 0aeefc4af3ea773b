// Directions of Blinn and Phong's lobe (phong.h): half vectors as likely as the lobe, (n + 1) / (2 pi) (N.H)^n (Blinn
// 1977). Local directions (basis.h).
#pragma once
#include "physics/ggx_sample.h"
#include "physics/phong.h"

namespace relook {

[[nodiscard]] inline Direction phong_half(float shininess, const Uv& u) {
  const float power = log2(1.0F - u.y) / (shininess + 1.0F);  // of 2, at most 0
  const float up = exp2(power);
  const float out = sqrt(max((1.0F - up) * (1.0F + up), 0.0F));
  return {out * portable_cos_turns(u.x), out * portable_sin_turns(u.x), up};
}

/// Of reflected directions above the surface, per steradian. `view`: local and facing; `way`: local, of length 1.
[[nodiscard]] inline float phong_reflection_density(float shininess, const Direction& view, const Direction& way) {
  if (!(way.z > 0.0F)) return 0.0F;
  const Direction half = normalized(view + way);
  const float lobe = phong_lobe(shininess, max(half.z, 1e-7F));
  return (shininess + 1.0F) * lobe * (0.125F * kInversePi) / max(view.dot(half), 1e-7F);
}

}  // namespace relook
