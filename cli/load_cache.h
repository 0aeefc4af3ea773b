// Opening a cache for a verb: its faults become errors with their sentence and exit code.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "cache/cache.h"
#include "engine/report.h"

namespace relook {

/// 2 missing or not a cache; 3 it does not fit; 5 damaged.
[[nodiscard]] ExitCode exit_code(CacheFault fault);
/// Throws Error unless the answer is `none`.
void require_sound(const CacheAnswer& answer, const std::string& cache);
/// `manifest`: of read_manifest().
[[nodiscard]] CacheSizes cache_sizes(const Json& manifest);
/// Refuses any damage.
[[nodiscard]] CacheContent load_cache(const std::string& cache);

/// A cache with what was damaged or missing traced again.
struct MendedCache {
  CacheContent content;
  std::vector<std::string> damage;      // one sentence a file
  std::uint64_t ray_trees_rebuilt = 0;  // one a sample
};
/// Refuses only damage that cannot be made good.
[[nodiscard]] MendedCache load_mended_cache(const std::string& cache);

}  // namespace relook
