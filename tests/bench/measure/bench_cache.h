// Caches of the benchmark's scene, written and read as the program does.
#pragma once
#include <memory>

#include "image/cached_image.h"
#include "scratch.h"
#include "setup.h"

namespace relook {

/// What a cache takes on disk and how many pieces it holds, as `relook inspect --json` tells.
struct CacheSize {
  PieceNumbers pieces;
  std::uint64_t paths = 0, trees = 0, tunnels = 0, total = 0;  // bytes of files
};

/// Writes one by `relook preprocess` of the scene of `options`. `extra`: further words of the command. Throws IoError.
void write_bench_cache(const BenchOptions& options, const std::filesystem::path& cache,
                       const std::vector<std::string>& extra = {});
[[nodiscard]] CacheSize inspect_bench_cache(const std::filesystem::path& cache, const ScratchFolder& scratch);
/// Throws IoError.
[[nodiscard]] OpenedCache open_bench_cache(const std::filesystem::path& cache, Residency* residency = nullptr);

}  // namespace relook
