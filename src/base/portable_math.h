// Elementary functions with the same bits on every machine: libm picks other code (with fused operations) on other
// processors. Plain float arithmetic in a fixed order, so loops over them vectorise. Errors are a few 1e-7, relative
// for exp2, absolute for log2 near 1 and the trigonometric functions; of the functions of doubles a few 1e-16, relative
// for small angles.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace relook {

/// Largest integer not above x, for |x| < 2^31.
[[nodiscard, gnu::always_inline]] inline float portable_floor(float x) {
  const float truncated = static_cast<float>(static_cast<std::int32_t>(x));
  return truncated > x ? truncated - 1.0F : truncated;
}

/// 2^x; 0 below -126, 2^127 above 127.
[[nodiscard, gnu::always_inline]] inline float portable_exp2(float x) {
  const float clamped = x < -126.0F ? -126.0F : (x > 127.0F ? 127.0F : x);
  const float whole = portable_floor(clamped);
  const float f = clamped - whole;
  // Taylor series of 2^f = exp(f ln 2) up to f^7: error below 2e-7 on [0, 1).
  float p = 1.5252734e-5F;
  p = p * f + 1.5403530e-4F;
  p = p * f + 1.3333558e-3F;
  p = p * f + 9.6181291e-3F;
  p = p * f + 5.5504109e-2F;
  p = p * f + 2.4022651e-1F;
  p = p * f + 6.9314718e-1F;
  p = p * f + 1.0F;
  const float scale = std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
  return x < -126.0F ? 0.0F : p * scale;
}

/// log2(x) for finite x > 0; -127 for x <= 0 and subnormal x.
[[nodiscard, gnu::always_inline]] inline float portable_log2(float x) {
  const float safe = x < 1.17549435e-38F ? 1.17549435e-38F : x;
  const std::int32_t bits = std::bit_cast<std::int32_t>(safe);
  const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;  // mantissa in [sqrt(1/2), sqrt(2))
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  // log((1 + s) / (1 - s)) = 2 (s + s^3/3 + s^5/5 + ...), |s| < 0.172.
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  float p = 0.22222222F;
  p = p * s2 + 0.28571429F;
  p = p * s2 + 0.4F;
  p = p * s2 + 0.66666667F;
  p = p * s2 + 2.0F;
  const float log2_m = p * s * 1.44269504F;
  return x < 1.17549435e-38F ? -127.0F : static_cast<float>(exponent) + log2_m;
}

/// sin(2 pi x), for |x| < 2^31.
[[nodiscard, gnu::always_inline]] inline float portable_sin_turns(float x) {
  const float f = x - portable_floor(x + 0.5F);  // [-1/2, 1/2]
  const float folded = f > 0.25F ? 0.5F - f : (f < -0.25F ? -0.5F - f : f);
  const float a = folded * 6.28318531F;  // [-pi/2, pi/2]
  const float a2 = a * a;
  float p = -2.50521084e-8F;
  p = p * a2 + 2.75573192e-6F;
  p = p * a2 - 1.98412698e-4F;
  p = p * a2 + 8.33333333e-3F;
  p = p * a2 - 1.66666667e-1F;
  p = p * a2 + 1.0F;
  return p * a;
}

/// cos(2 pi x), for |x| < 2^31.
[[nodiscard, gnu::always_inline]] inline float portable_cos_turns(float x) {
  const float f = x - portable_floor(x + 0.5F);  // [-1/2, 1/2]
  return portable_sin_turns(0.25F - std::fabs(f));
}

/// atan(y / x) in the right quadrant, in turns: [-1/2, 1/2]; 0 for (0, 0).
[[nodiscard, gnu::always_inline]] inline float portable_atan2_turns(float y, float x) {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  const float ratio = large > 0.0F ? small / large : 0.0F;  // [0, 1]
  // atan(r) = atan(c) + atan((r - c) / (1 + r c)) with tan c = 1/2, so that the series converges quickly.
  const float z = ratio > 0.25F ? (ratio - 0.5F) / (1.0F + 0.5F * ratio) : ratio;  // |z| <= 1/3
  const float z2 = z * z;
  float p = 0.09090909F;
  p = p * z2 * -1.0F + 0.11111111F;
  p = p * z2 * -1.0F + 0.14285714F;
  p = p * z2 * -1.0F + 0.2F;
  p = p * z2 * -1.0F + 0.33333333F;
  p = p * z2 * -1.0F + 1.0F;
  float angle = p * z + (ratio > 0.25F ? 0.46364761F : 0.0F);
  angle = ay > ax ? 1.57079633F - angle : angle;
  angle = x < 0.0F ? 3.14159265F - angle : angle;
  angle = y < 0.0F ? -angle : angle;
  return angle * 0.15915494F;
}

/// asin(x) in turns, for |x| <= 1 (clamped): [-1/4, 1/4].
[[nodiscard, gnu::always_inline]] inline float portable_asin_turns(float x) {
  const float clamped = x < -1.0F ? -1.0F : (x > 1.0F ? 1.0F : x);
  return portable_atan2_turns(clamped, std::sqrt((1.0F - clamped) * (1.0F + clamped)));
}

struct SinCos {
  double sin, cos;
};
/// Of an angle in radians, of at most 1000.
[[nodiscard]] inline SinCos portable_sin_cos(double radians) {
  const double quarters = radians * (2 * std::numbers::inv_pi);
  const auto whole = static_cast<std::int32_t>(quarters < 0 ? quarters - 0.5 : quarters + 0.5);
  const double turned = static_cast<double>(whole);
  // [-pi/4, pi/4]; pi/2 in two parts, the first of 33 bits, so that its product is exact.
  const double a = (radians - turned * 1.5707963267341256) - turned * 6.077100506506192e-11;
  const double a2 = a * a;
  // Taylor series up to a^15 and a^16.
  double s = -1.0 / 1307674368000;
  s = s * a2 + 1.0 / 6227020800;
  s = s * a2 - 1.0 / 39916800;
  s = s * a2 + 1.0 / 362880;
  s = s * a2 - 1.0 / 5040;
  s = s * a2 + 1.0 / 120;
  s = s * a2 - 1.0 / 6;
  s = a + a * a2 * s;
  double c = 1.0 / 20922789888000;
  c = c * a2 - 1.0 / 87178291200;
  c = c * a2 + 1.0 / 479001600;
  c = c * a2 - 1.0 / 3628800;
  c = c * a2 + 1.0 / 40320;
  c = c * a2 - 1.0 / 720;
  c = c * a2 + 1.0 / 24;
  c = c * a2 - 0.5;
  c = 1 + a2 * c;
  switch (static_cast<std::uint32_t>(whole) & 3U) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

/// atan(y / x) in the right quadrant, in radians: [-pi, pi]; 0 for (0, 0).
[[nodiscard]] inline double portable_atan2(double y, double x) {
  // atan(r) = atan(c) + atan((r - c) / (1 + r c)) with c = k / 4, so that the series converges quickly.
  constexpr double kNodes[] = {0, 0.24497866312686415, 0.46364760900080612, 0.64350110879328439, 0.78539816339744831};
  const double ax = std::fabs(x), ay = std::fabs(y);
  const double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  const double ratio = large > 0 ? small / large : 0.0;  // [0, 1]
  const std::int32_t node = ratio < 1 ? static_cast<std::int32_t>(4 * ratio + 0.5) : 4;
  const double c = 0.25 * node;
  const double z = (ratio - c) / (1 + ratio * c);  // |z| <= 1/8
  const double z2 = z * z;
  double p = 1.0 / 17;
  p = p * z2 - 1.0 / 15;
  p = p * z2 + 1.0 / 13;
  p = p * z2 - 1.0 / 11;
  p = p * z2 + 1.0 / 9;
  p = p * z2 - 1.0 / 7;
  p = p * z2 + 1.0 / 5;
  p = p * z2 - 1.0 / 3;
  double angle = kNodes[node] + (z + z * z2 * p);
  angle = ay > ax ? 1.57079632679489662 - angle : angle;
  angle = x < 0 ? 3.14159265358979324 - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace relook
