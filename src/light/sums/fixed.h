// Numbers on one fixed grid, so that sums of light are exact: they have no order, and what has been added can be taken
// away again. Two's complement in 128 bits, a step is 2^-80. Terms are at most 2^30, so a sum of fewer than 2^17 of
// them holds; beyond that it wraps, and still comes back.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
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

namespace fixed_bits {
/// The exponent bits of the first floats that are multiples of the step.
inline constexpr std::uint32_t kFirstWhole = 127 + 23 + kFixedStep;
static_assert(kFirstWhole == 70);

/// By what a mantissa is multiplied, by the sign and the exponent bits of a float: a power of two of either sign. 0 for
/// those that go another way, which are rounded or large, and for zeros.
inline constexpr std::array<std::int64_t, 512> kFactors = [] {
  std::array<std::int64_t, 512> factors{};
  for (std::uint32_t shift = 0; shift < 63; ++shift) {
    factors[kFirstWhole + shift] = std::int64_t{1} << shift;
    factors[256 + kFirstWhole + shift] = -(std::int64_t{1} << shift);
  }
  return factors;
}();

[[nodiscard]] inline std::uint32_t mantissa(std::uint32_t float_bits) { return (float_bits & 0x7FFFFFU) | 0x800000U; }

/// Of any term; `clamped` counts on if it is.
[[nodiscard]] Fixed fixed_of_any(float term, std::uint64_t& clamped);

/// Bits up to the highest that is 1.
[[nodiscard]] inline int bit_width(Uint128 bits) {
  const auto high = static_cast<std::uint64_t>(bits >> 64);
  return high != 0 ? 64 + static_cast<int>(std::bit_width(high))
                   : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(bits)));
}
}  // namespace fixed_bits

/// The term, clamped to the largest one of its sign and rounded to the nearest step, ties to even; 0 for a NaN.
/// `clamped` counts on if it was clamped or is no number.
[[nodiscard]] inline Fixed fixed_of(float term, std::uint64_t& clamped) {
  const auto bits = std::bit_cast<std::uint32_t>(term);
  const std::uint32_t head = bits >> 23;
  const std::int64_t factor = fixed_bits::kFactors[head];
  if (factor == 0 && (head & 0xFFU) != 0) return fixed_bits::fixed_of_any(term, clamped);
  return {static_cast<Uint128>(Int128{fixed_bits::mantissa(bits)} * factor)};
}
[[nodiscard]] inline Fixed fixed_of(float term) {
  std::uint64_t clamped = 0;
  return fixed_of(term, clamped);
}

/// The nearest double, ties to even.
[[nodiscard]] inline double nearest_double(Int128 number) {
  const Uint128 magnitude = number < 0 ? -static_cast<Uint128>(number) : static_cast<Uint128>(number);
  // The highest 62 bits, and one that says whether there are others below: as far as the nearest double can depend on.
  const int below = std::max(fixed_bits::bit_width(magnitude) - 62, 0);
  const Uint128 top = magnitude >> below;
  const auto kept = static_cast<std::int64_t>(top) | (top << below == magnitude ? 0 : 1);
  const auto scale = std::bit_cast<double>(static_cast<std::uint64_t>(1023 + below) << 52);
  return static_cast<double>(number < 0 ? -kept : kept) * scale;
}
[[nodiscard]] inline double value_of(Fixed sum) { return nearest_double(sum.steps()) * 0x1p-80; }
static_assert(kFixedStep == -80);

}  // namespace relook
