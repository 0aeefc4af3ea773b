// Half-precision numbers as frames store them, without branches, so that loops over pixels are vectorised.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace relook {

/// Whether half_bits() makes a finite value one of the largest halves because it lies beyond them.
[[nodiscard]] inline bool is_beyond_half(float value) {
  constexpr std::uint32_t kMagnitude = 0x7FFFFFFF, kInfinity = 0x7F800000;
  constexpr std::uint32_t kLargest = 0x477FE000;  // 65504
  const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & kMagnitude;
  return magnitude > kLargest && magnitude < kInfinity;
}

/// The nearest half, ties to even, as OpenEXR's `half` has it; finite values beyond its range become its largest ones.
[[nodiscard]] inline std::uint16_t half_bits(float value) {
  constexpr std::uint32_t kSign = 0x80000000, kInfinity = 0x7F800000;
  constexpr std::uint32_t kLargest = 0x477FE000;   // 65504
  constexpr std::uint32_t kSmallest = 0x38800000;  // 2^-14, of those with a whole mantissa
  constexpr std::uint32_t kBias = (127 - 15) << 23, kDropped = 23 - 10;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t magnitude = bits & ~kSign;
  const std::uint32_t finite = std::min(magnitude, kLargest);
  const std::uint32_t whole = (finite - kBias + 0xFFF + (finite >> kDropped & 1)) >> kDropped;
  // The last bit of 0.5 is the last bit of a half below 2^-14: the addition rounds.
  const std::uint32_t small = std::bit_cast<std::uint32_t>(std::bit_cast<float>(finite) + 0.5F) - 0x3F000000;
  const std::uint32_t payload = (magnitude & ~kInfinity) >> kDropped;  // of a NaN, which stays one
  const std::uint32_t special = 0x7C00 | payload | (magnitude > kInfinity && payload == 0 ? 1U : 0U);
  const std::uint32_t half = magnitude >= kInfinity ? special : finite < kSmallest ? small : whole;
  return static_cast<std::uint16_t>((bits & kSign) >> 16 | half);
}

}  // namespace relook
