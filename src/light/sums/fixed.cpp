#include "light/sums/fixed.h"

#include <cmath>

namespace relook {
namespace {

Fixed with_sign(Uint128 magnitude, bool is_negative) { return {is_negative ? -magnitude : magnitude}; }

}  // namespace

Fixed fixed_bits::fixed_of_any(float term, std::uint64_t& clamped) {
  const bool is_within = std::fabs(term) <= kLargestTerm;
  if (!is_within) ++clamped;
  if (std::isnan(term)) return {};
  const auto bits = std::bit_cast<std::uint32_t>(term);
  const std::uint32_t exponent = bits >> 23 & 0xFFU;
  const bool is_negative = std::signbit(term);
  if (!is_within) return with_sign(Uint128{1} << (30 - kFixedStep), is_negative);
  if (exponent >= kFirstWhole) return with_sign(Uint128{mantissa(bits)} << (exponent - kFirstWhole), is_negative);
  const std::uint32_t dropped = kFirstWhole - exponent;
  constexpr std::uint32_t kMantissaBits = 24;
  if (dropped > kMantissaBits) return {};  // less than half a step; denormal numbers as well
  const std::uint32_t whole = mantissa(bits) >> dropped, rest = mantissa(bits) - (whole << dropped);
  const std::uint32_t half = 1U << (dropped - 1);
  return with_sign(whole + (rest > half || (rest == half && (whole & 1U) != 0) ? 1U : 0U), is_negative);
}

}  // namespace relook
