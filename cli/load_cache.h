// Opening a cache for a verb: its faults become errors with their sentence and exit code.
#pragma once
#include <string>

#include "base/error.h"
#include "cache/cache.h"

namespace relook {

/// 2 missing or not a cache; 3 it does not fit; 5 damaged.
[[nodiscard]] ExitCode exit_code(CacheFault fault);
/// Throws Error unless the answer is `none`.
void require_sound(const CacheAnswer& answer, const std::string& cache);
[[nodiscard]] CacheContent load_cache(const std::string& cache);

}  // namespace relook
