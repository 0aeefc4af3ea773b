#include "frame/sums/fixed.h"

namespace relook {

Fixed fixed_bits::fixed_of_odd(float term) {
  if (std::isnan(term)) return {};
  const auto bits = std::bit_cast<std::uint32_t>(term);
  const std::uint32_t exponent = bits >> 23 & 0xFFU;
  if (exponent >= kLargest) return with_sign(Uint128{1} << (30 - kFixedStep), bits);
  const std::uint32_t dropped = kFirstWhole - exponent;
  constexpr std::uint32_t kMantissaBits = 24;
  if (dropped > kMantissaBits) return {};  // less than half a step; denormal numbers as well
  const std::uint32_t mantissa = (bits & 0x7FFFFFU) | 0x800000U;
  const std::uint32_t whole = mantissa >> dropped, rest = mantissa - (whole << dropped), half = 1U << (dropped - 1);
  return with_sign(whole + (rest > half || (rest == half && (whole & 1U) != 0) ? 1U : 0U), bits);
}

double value_of(Fixed sum) {
  if (sum.bits == 0) return 0;
  const bool is_negative = sum.steps() < 0;
  Uint128 magnitude = is_negative ? -sum.bits : sum.bits;
  const int bits = fixed_bits::bit_width(magnitude);
  constexpr int kMantissaBits = 53;
  const int dropped = bits > kMantissaBits ? bits - kMantissaBits : 0;
  if (dropped > 0) {
    const Uint128 rest = magnitude & ((Uint128{1} << dropped) - 1), half = Uint128{1} << (dropped - 1);
    magnitude >>= dropped;
    if (rest > half || (rest == half && (magnitude & 1U) != 0)) ++magnitude;
  }
  // A power of two between 2^-80 and 2^-5: the product is exact.
  const auto scale = std::bit_cast<double>(static_cast<std::uint64_t>(1023 + kFixedStep + dropped) << 52);
  const double value = static_cast<double>(static_cast<std::uint64_t>(magnitude)) * scale;
  return is_negative ? -value : value;
}

}  // namespace relook
