// Which pieces of information leave memory first (paper 4.3): policies as one function from what is known of a piece to
// its weight; the lowest leaves. The paper's is the default, the others are there to compare.
#pragma once
#include <cstdint>
#include <string_view>

namespace relook {

/// `plain_weight`: the weight without the surface area of tunnels.
enum class EvictionPolicy : std::uint8_t { weight, plain_weight, lru, size, gdsf };
inline constexpr EvictionPolicy kEvictionPolicies[] = {EvictionPolicy::weight, EvictionPolicy::plain_weight,
                                                       EvictionPolicy::lru, EvictionPolicy::size, EvictionPolicy::gdsf};
/// "weight", "plain-weight", "lru", "size", "gdsf".
[[nodiscard]] std::string_view policy_name(EvictionPolicy policy);

/// Estimates until a time has been measured: to find one hit again, by a ray against one object, and to build the
/// tunnels around one hit.
inline constexpr double kHitSeconds = 5e-7, kTunnelSeconds = 3e-7;

/// What a policy may look at.
struct PieceFacts {
  std::uint64_t bytes = 1;
  double return_seconds = 0;   // what it takes to have it back: from disk, or worked out again
  std::uint64_t last_use = 0;  // the change that used it last
  std::uint64_t uses = 0;      // number of changes that used it
  double surface_area = 1;     // of tunnels, relative to the mean: how likely an object meets them; otherwise 1
  double gdsf_inflation = 0;   // of the whole cache when it was used last (Cherkasova 1998)
};

/// `change`: the number of changes so far.
[[nodiscard]] double eviction_weight(EvictionPolicy policy, const PieceFacts& piece, std::uint64_t change);

}  // namespace relook
