// Layers that sum to a value bit for bit in float32, added from first to last, whether the adding processor keeps
// denormal numbers or not.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace relook {

/// Makes the sum of `terms`, the last of which is set here, `total`: usually to what rounding left. Where no last term
/// does it (an infinite, very small or cancelling value) the last is the whole and the others are -0, which adds to
/// anything without a trace. Terms below 2^-100 become 0.
inline void settle_sum(std::span<float> terms, float total) {
  constexpr float kSmallest = 0x1p-100F;
  float sum = 0;
  for (std::size_t i = 0; i + 1 < terms.size(); ++i) {
    if (std::fabs(terms[i]) < kSmallest) terms[i] = 0;
    sum = i == 0 ? terms[i] : sum + terms[i];
  }
  terms.back() = total - sum;
  const bool is_small = total != 0 && std::fabs(total) < kSmallest;
  if (!is_small && std::bit_cast<std::uint32_t>(sum + terms.back()) == std::bit_cast<std::uint32_t>(total)) return;
  for (float& term : terms) term = -0.0F;
  terms.back() = total;
}

}  // namespace relook
