#include "cache/residency/eviction.h"

namespace relook {

std::string_view policy_name(EvictionPolicy policy) {
  switch (policy) {
    case EvictionPolicy::weight:
      return "weight";
    case EvictionPolicy::plain_weight:
      return "plain-weight";
    case EvictionPolicy::lru:
      return "lru";
    case EvictionPolicy::size:
      return "size";
    case EvictionPolicy::gdsf:
      return "gdsf";
  }
  return "";
}

double eviction_weight(EvictionPolicy policy, const PieceFacts& piece, std::uint64_t change) {
  const auto bytes = static_cast<double>(piece.bytes);
  switch (policy) {
    case EvictionPolicy::weight:
    case EvictionPolicy::plain_weight: {
      const auto age = static_cast<double>(1 + change - piece.last_use);
      const double meets = policy == EvictionPolicy::weight ? piece.surface_area : 1;
      return piece.return_seconds * meets / (bytes * age);
    }
    case EvictionPolicy::lru:
      return static_cast<double>(piece.last_use);
    case EvictionPolicy::size:
      return 1 / bytes;
    case EvictionPolicy::gdsf:
      return piece.gdsf_inflation + static_cast<double>(piece.uses) * piece.return_seconds / bytes;
  }
  return 0;
}

}  // namespace relook
