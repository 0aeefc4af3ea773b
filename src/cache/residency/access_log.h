// The access log of a replay (`replay --access-log`) and trials of it: what an eviction policy would have cost under a
// budget. Text, a line an access:
//   relook-access/1
//   CHANGE KIND TILE BYTES SECONDS SURFACE_AREA
// SECONDS: to have the piece back once it has left. A piece comes once a change. Of color_trees TILE counts on from one
// set of parameters to the next.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "cache/residency/eviction.h"

namespace relook {

inline constexpr std::string_view kAccessLogHeader = "relook-access/1\n";

struct Access {
  std::uint64_t change = 0;
  std::uint32_t piece = 0;  // dense numbers
  PieceFacts facts;         // bytes, return_seconds, surface_area
};

struct AccessLog {
  std::vector<Access> accesses;  // in order
  std::uint32_t pieces = 0;
  [[nodiscard]] std::uint64_t largest_bytes() const;
  /// All pieces at their largest.
  [[nodiscard]] std::uint64_t total_bytes() const;
};

/// Throws InputError with the line.
[[nodiscard]] AccessLog parse_access_log(std::string_view text, std::string_view file);

/// What pieces that had left would have cost to have back. The first use of a piece costs nothing: it has to come from
/// the cache in any case.
struct TrialCost {
  std::uint64_t returns = 0, bytes = 0;
  double seconds = 0;
};

[[nodiscard]] TrialCost try_policy(const AccessLog& log, EvictionPolicy policy, std::uint64_t memory_bytes);
/// A policy that knows the future: what leaves is cheap to have back for its size and is used again last, or never.
/// With pieces of different sizes and prices the true optimum is not to be had in reasonable time; this comes near.
[[nodiscard]] TrialCost try_clairvoyant(const AccessLog& log, std::uint64_t memory_bytes);

}  // namespace relook
