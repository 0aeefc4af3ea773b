// Numbers on one fixed grid, so that sums of light are exact: they have no order, and what has been added can be taken
// away again. Two's complement in 128 bits, a step is 2^-80. Terms are at most 2^30, so a sum of 2^17 of them holds;
// beyond that it wraps, and still comes back.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace relook {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;

struct Fixed {
  Uint128 bits = 0;  // two's complement, in steps

  [[nodiscard]] Int128 steps() const { return static_cast<Int128>(bits); }
  Fixed& operator+=(Fixed other) {
    bits += other.bits;
    return *this;
  }
  Fixed& operator-=(Fixed other) {
    bits -= other.bits;
    return *this;
  }
  bool operator==(const Fixed&) const = default;
};

inline constexpr int kFixedStep = -80;          // its power of two
inline constexpr float kLargestTerm = 0x1p30F;  // of either sign

/// Is a term beyond the largest one, or no number?
[[nodiscard]] inline bool is_clamped(float term) { return !(std::fabs(term) <= kLargestTerm); }

namespace fixed_bits {
/// The exponent bits of the first floats that are multiples of the step, and of the largest term.
inline constexpr std::uint32_t kFirstWhole = 127 + 23 + kFixedStep, kLargest = 127 + 30;
static_assert(kFirstWhole == 70);

[[nodiscard]] inline Fixed with_sign(Uint128 magnitude, std::uint32_t float_bits) {
  const Uint128 sign = -Uint128{float_bits >> 31};  // all ones for a negative one
  return {(magnitude ^ sign) - sign};
}

/// Bits up to the highest that is 1.
[[nodiscard]] inline int bit_width(Uint128 bits) {
  const auto high = static_cast<std::uint64_t>(bits >> 64);
  return high != 0 ? 64 + static_cast<int>(std::bit_width(high))
                   : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(bits)));
}

/// Of terms below the first whole ones and of those from the largest on.
[[nodiscard]] Fixed fixed_of_odd(float term);
}  // namespace fixed_bits

/// The term, clamped to the largest one of its sign and rounded to the nearest step, ties to even; 0 for a NaN.
[[nodiscard]] inline Fixed fixed_of(float term) {
  const auto bits = std::bit_cast<std::uint32_t>(term);
  const std::uint32_t exponent = bits >> 23 & 0xFFU;
  if (exponent - fixed_bits::kFirstWhole >= fixed_bits::kLargest - fixed_bits::kFirstWhole)
    return (bits << 1) == 0 ? Fixed() : fixed_bits::fixed_of_odd(term);
  const std::uint32_t mantissa = (bits & 0x7FFFFFU) | 0x800000U;
  return fixed_bits::with_sign(Uint128{mantissa} << (exponent - fixed_bits::kFirstWhole), bits);
}

/// The nearest double, ties to even.
[[nodiscard]] double value_of(Fixed sum);

}  // namespace relook
