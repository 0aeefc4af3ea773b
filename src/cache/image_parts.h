// The image side of a cache as files: the base frame, ray paths, and ray trees in groups of tiles. Each encode_ has its
// decode_, which checks every index and count and throws CacheDamage, so that loops over them need no checks.
#pragma once
#include <cstdint>
#include <span>

#include "cache/cache.h"
#include "cache/container.h"

namespace relook {

[[nodiscard]] std::size_t cache_tile_count(const Camera& camera);
/// Tiles [first, last) of one file: up to 131,072 samples, at least one tile.
struct TileGroup {
  std::size_t first = 0, last = 0;
};
[[nodiscard]] std::size_t cache_group_count(const Camera& camera, std::uint32_t samples);
[[nodiscard]] std::size_t cache_group_of(std::uint32_t samples, std::size_t tile);
[[nodiscard]] TileGroup cache_group(const Camera& camera, std::uint32_t samples, std::size_t group);
/// Pixels of one row of a tile of the image.
[[nodiscard]] std::uint32_t cache_tile_width(const Camera& camera, std::size_t tile);
/// Samples of a tile of the image.
[[nodiscard]] std::size_t cache_tile_samples(const Camera& camera, std::uint32_t samples, std::size_t tile);

[[nodiscard]] Bytes encode_frame(const CacheContent& content, const CacheIdentity& identity);
[[nodiscard]] Bytes encode_paths(const CacheContent& content, const CacheIdentity& identity);
[[nodiscard]] Bytes encode_trees(const CacheContent& content, std::size_t group, const CacheIdentity& identity);

void decode_frame(BytesView file, const CacheIdentity& identity, CacheContent& content);
void decode_paths(BytesView file, const CacheIdentity& identity, CacheContent& content);
/// `hits_of_path`: hit_count() of every path. content.trees and content.sample_colors have a slot for every tile.
void decode_trees(BytesView file, const CacheIdentity& identity, std::size_t group,
                  std::span<const std::size_t> hits_of_path, CacheContent& content);

}  // namespace relook
