// The image side of a cache as files: the base frame, ray paths, and ray trees in groups of tiles. Each encode_ has its
// decode_, which checks every index and count and throws CacheDamage, so that loops over them need no checks.
#pragma once
#include <cstdint>
#include <span>

#include "cache/cache.h"
#include "cache/container.h"

namespace relook {

/// Tiles [first, last) of one file: up to 131,072 samples, at least one tile.
struct TileGroup {
  std::size_t first = 0, last = 0;
};
[[nodiscard]] std::size_t cache_group_count(const Camera& camera, std::uint32_t samples);
[[nodiscard]] std::size_t cache_group_of(std::uint32_t samples, std::size_t tile);
[[nodiscard]] TileGroup cache_group(const Camera& camera, std::uint32_t samples, std::size_t group);
[[nodiscard]] TileGroup cache_group(const Image& image, std::size_t group);

[[nodiscard]] Bytes encode_frame(const Image& image, const CacheIdentity& identity);
[[nodiscard]] Bytes encode_paths(const Image& image, const CacheIdentity& identity);
[[nodiscard]] Bytes encode_trees(const Image& image, std::size_t group, const CacheIdentity& identity);

/// Of the three, the view and the size of the frame are known.
void decode_frame(BytesView file, const CacheIdentity& identity, Image& image);
void decode_paths(BytesView file, const CacheIdentity& identity, CacheContent& content);
/// `hits_of_path`: hit_count() of every path. content.image.trees has a slot for every tile, as have its sample_colors
/// or light_sums.
void decode_trees(BytesView file, const CacheIdentity& identity, std::size_t group,
                  std::span<const std::size_t> hits_of_path, CacheContent& content);

/// Sections of the sums of light of neighbouring tiles. Requires: as many sums in each.
void add_sums(ContainerWriter& writer, std::span<const PackedSums> tiles);
/// Reads them into `tiles`, of which the first is tile `first` of the frame. `sums`: of each.
void read_sums(const ContainerReader& reader, std::size_t sums, const Frame& frame, std::size_t first,
               std::span<PackedSums> tiles);

}  // namespace relook
