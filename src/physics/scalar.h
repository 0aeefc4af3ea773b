// The arithmetic in which the formulas of this folder are written, as templates over a scalar S (and vectors V, colours
// C of three of them): float, for the rays of one hit, is defined here; expressions, for the colours of many hits at
// once, are defined in color/expression/expression.h. Beside these functions a formula uses + - * / alone, in the order
// in which it is written: what goes in as equal numbers comes out as equal bits, whichever scalar it takes.
#pragma once
#include <cmath>
#include <numbers>
#include <utility>

#include "base/math.h"
#include "base/portable_math.h"

namespace relook {

inline constexpr float kInversePi = std::numbers::inv_pi_v<float>;

/// The components of a vector or colour.
template <class V>
using ScalarOf = std::remove_cvref_t<decltype(std::declval<V>().x)>;

[[nodiscard]] inline float min(float a, float b) { return a < b ? a : b; }
[[nodiscard]] inline float max(float a, float b) { return a > b ? a : b; }
[[nodiscard]] inline float sqrt(float a) { return std::sqrt(a); }
[[nodiscard]] inline float exp2(float a) { return portable_exp2(a); }
[[nodiscard]] inline float log2(float a) { return portable_log2(a); }
/// cos(2 pi a)
[[nodiscard]] inline float cos_turns(float a) { return portable_cos_turns(a); }
/// condition > 0 ? a : b
[[nodiscard]] inline float if_positive(float condition, float a, float b) { return condition > 0 ? a : b; }
[[nodiscard]] inline Direction if_positive(float condition, const Direction& a, const Direction& b) {
  return condition > 0 ? a : b;
}
/// x as the scalar that `like` is.
[[nodiscard]] inline float number(float /*like*/, float x) { return x; }

[[nodiscard]] inline float dot(const Direction& a, const Direction& b) { return a.dot(b); }
[[nodiscard]] inline float largest(const Direction& a) { return max(max(a.x, a.y), a.z); }
/// Of length 1; short vectors are made no longer than 1.
[[nodiscard]] inline Direction normalized(const Direction& a) { return a * (1.0F / sqrt(max(dot(a, a), 1e-30F))); }

template <class S>
[[nodiscard]] S square(S x) {
  return x * x;
}

}  // namespace relook
