// The tunnels of a group of tiles as a file of a cache: a section for each column of each tile, so that one tile is
// read without the others. Of tunnels that follow from the cells, only those around whole tiles are stored. Written by
// write_cache.cpp; read whole by cache.cpp, tile by tile by stored_tunnels.h.
#pragma once
#include <string>

#include "cache/cache.h"
#include "cache/container.h"
#include "cache/stored_tunnels.h"

namespace relook {

/// `bound_to`: the hashes of the files of the group's ray trees and of the paths, 64 digits, see hashes_bound_to().
[[nodiscard]] Bytes encode_tunnels(const CacheContent& content, std::size_t group, const CacheIdentity& identity,
                                   const std::string& bound_to);

/// The tunnels of a group, tile by tile. Throws CacheDamage for what cannot be tunnels.
class TunnelReader {
 public:
  /// `shape`, `camera`, `samples`, `paths`: the cache's. A file that is in memory must outlive the reader.
  TunnelReader(const ByteSource& file, const CacheIdentity& identity, const StorageOptions& shape, const Camera& camera,
               std::uint32_t samples, std::size_t group, const PathBounds& paths);
  [[nodiscard]] const std::string& bound_to() const { return bound_to_; }
  /// The next three are for a tile of the image that is in the group.
  [[nodiscard]] const Sections& around(std::size_t tile) const { return around_[tile - first_]; }
  [[nodiscard]] bool has(std::size_t tile) const { return kept_[tile - first_] == 1; }
  /// Bytes of the tile's columns before compression. Requires: has(tile).
  [[nodiscard]] std::uint64_t raw_bytes(std::size_t tile) const;
  /// Requires: has(tile).
  [[nodiscard]] TileTunnels tunnels(std::size_t tile) const;

 private:
  void check_sections(std::uint64_t sections, std::uint64_t tunnels, std::size_t first, std::size_t last) const;
  ContainerReader reader_;
  std::size_t first_ = 0, of_region_ = 1;
  Camera camera_;
  std::uint32_t samples_;
  PathBounds paths_;
  std::vector<std::uint8_t> levels_;  // [tiles of the group]: see cell_levels()
  std::string bound_to_;
  std::vector<std::uint8_t> kept_;
  std::vector<Sections> around_;
};

}  // namespace relook
