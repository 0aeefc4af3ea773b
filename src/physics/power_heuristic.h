// How much a sample counts that another technique might have found (Veach and Guibas 1995, the power heuristic of beta
// 2).
#pragma once
#include "physics/scalar.h"

namespace relook {

/// own^2 / (own^2 + other^2), of densities of at least 0 up to infinity; 0 if `own` is. The weights of both sum to 1.
[[nodiscard]] inline float weight_of(float own, float other) {
  if (!(own > 0.0F)) return 0.0F;
  if (own == other) return 0.5F;
  if (own > other) return 1.0F / (1.0F + square(other / own));
  const float ratio2 = square(own / other);
  return ratio2 / (1.0F + ratio2);
}

}  // namespace relook
