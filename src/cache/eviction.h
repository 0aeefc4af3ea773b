// Which pieces of information leave memory first (paper 4.3): policies as one function from what is known of a piece to
// its weight; the lowest leaves. The paper's is the default, the others are there to compare.
#pragma once
#include <cstdint>
#include <string_view>

namespace relook {

enum class EvictionPolicy : std::uint8_t { weight, lru, size, gdsf };
inline constexpr EvictionPolicy kEvictionPolicies[] = {EvictionPolicy::weight, EvictionPolicy::lru,
                                                       EvictionPolicy::size, EvictionPolicy::gdsf};
/// "weight", "lru", "size", "gdsf".
[[nodiscard]] std::string_view policy_name(EvictionPolicy policy);

/// What a policy may look at.
struct PieceFacts {
  std::uint64_t bytes = 1;
  double return_seconds = 0;   // to have it back: from disk, or worked out again
  std::uint64_t last_use = 0;  // the change that used it last
  std::uint64_t uses = 0;      // number of changes that used it
  double surface_area = 1;     // of a tunnel, relative to the largest: how likely an object meets it; otherwise 1
  double gdsf_inflation = 0;   // of the whole cache when it was used last (Cherkasova 1998)
};

/// `change`: the number of changes so far.
[[nodiscard]] double eviction_weight(EvictionPolicy policy, const PieceFacts& piece, std::uint64_t change);

}  // namespace relook
