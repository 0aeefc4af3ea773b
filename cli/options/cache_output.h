// Where preprocess is to write: what may be there already. A cache is never replaced unasked, and nothing else ever.
#pragma once
#include <optional>

#include "base/json.h"
#include "cache/cache.h"
#include "options/arguments.h"
#include "terminal/console.h"

namespace relook {

/// What the cache is to hold beside what always is there.
[[nodiscard]] StorageOptions storage_options(const StructureOptions& structures);

/// The manifest of a cache that is at the output already and is the one asked for, with every file of the right hash.
/// None if the output is free, or may be replaced. Throws UsageError for all else that is there, IoError where it
/// cannot be looked at.
[[nodiscard]] std::optional<Json> finished_cache(const Arguments& arguments, Console& console);

}  // namespace relook
