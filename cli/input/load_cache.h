// Opening a cache for a verb: its faults become errors with their sentence and exit code.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cache/cache.h"
#include "image/cached_image.h"
#include "report/report.h"

namespace relook {

/// 0 without a fault; 2 missing or not a cache; 3 it does not fit; 5 damaged; 6 it cannot be read.
[[nodiscard]] ExitCode exit_code(CacheFault fault);
/// Throws Error unless the answer is `none`.
void require_sound(const CacheAnswer& answer, const std::string& cache);
/// `manifest`, here and below: of read_manifest().
[[nodiscard]] Integrator integrator_of(const Json& manifest);
[[nodiscard]] CacheSizes cache_sizes(const Json& manifest);
/// Of its frame, where it is known.
[[nodiscard]] std::optional<double> noise_of(const Json& manifest);
/// Refuses any damage.
[[nodiscard]] CacheContent load_cache(const std::string& cache);

/// The cache with what was damaged or missing traced again; refuses only damage that cannot be made good.
[[nodiscard]] CacheContent load_mended_cache(const std::string& cache);
/// The cache as a replay starts from it. `mends`, `residency`: see image/cached_image.h.
[[nodiscard]] OpenedCache open_cache(const std::string& cache, bool mends, Residency* residency = nullptr);
/// One sentence a file.
[[nodiscard]] std::vector<std::string> sentences(const CacheLosses& losses);

}  // namespace relook
