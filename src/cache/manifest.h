// MANIFEST.json: what a cache's folder must consist of, written last. It carries its own hash and is compared with its
// canonical text, so that no byte of it can change unnoticed. Read before anything else of a cache: nothing below it is
// believed that it does not name.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "cache/arithmetic.h"
#include "cache/cache.h"
#include "cache/cache_names.h"
#include "cache/container.h"

namespace relook {

struct CacheFile {
  std::string name;  // relative: "look.json", "trees/00000-<hash>.rlk"
  std::uint64_t bytes = 0;
  std::string hash;  // XXH3-128
};

struct Manifest {
  Arithmetic arithmetic = own_arithmetic();
  StorageOptions storage;
  PieceNumbers pieces;
  CacheIdentity identity;
  Camera camera;
  ViewOptions view;
  std::uint32_t objects = 0, lights = 0, shared = 0;
  std::optional<double> noise;   // as CacheContent has it
  std::vector<CacheFile> files;  // by name
};

[[nodiscard]] std::string manifest_text(const Manifest& manifest);

/// Reads and checks MANIFEST.json of a cache. `document`: null, or gets its JSON. Throws CacheDamage.
[[nodiscard]] Manifest load_manifest(const std::filesystem::path& cache, Json* document = nullptr);

/// Reads one file of a cache. Throws CacheDamage unless it has as many bytes as its entry says; to compare its hash is
/// left to the caller.
[[nodiscard]] Bytes load_file(const std::filesystem::path& cache, const CacheFile& file);

/// The manifest of a cache with this content, still without `files`.
[[nodiscard]] Manifest manifest_of(const CacheContent& content);

/// Does a file say that it is the manifest of a cache, whatever its version and however damaged the rest?
[[nodiscard]] bool is_manifest_of_cache(const std::filesystem::path& path);

/// Is errno that of a file that may be sound but was not opened (permissions, too many open files)?
[[nodiscard]] bool is_refusal(int error);
[[nodiscard]] std::string refusal_text(int error);

}  // namespace relook
