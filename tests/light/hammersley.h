// Points that fill the unit square evenly, for integrals over what a light's points are drawn by.
#pragma once
#include <cstdint>

#include "base/math.h"

namespace relook {

/// The i-th of n of Hammersley's points.
inline Uv hammersley_point(std::uint32_t i, std::uint32_t n) {
  std::uint32_t reversed = 0;
  for (std::uint32_t bit = 0; bit < 24; ++bit) reversed |= (i >> bit & 1U) << (23 - bit);
  return {(static_cast<float>(i) + 0.5F) / static_cast<float>(n), static_cast<float>(reversed) * 0x1p-24F};
}

}  // namespace relook
