// Tunnels of a group of tiles as a file of a cache: a section for each column of each tile, so that one tile is read
// without the others. What follows from the cells is not stored.
#pragma once
#include <string>

#include "cache/cache.h"
#include "cache/container.h"
#include "cache/stored_tunnels.h"

namespace relook {

/// `bound_to`: 32 digits of the file of the group's ray trees and 32 of that of the paths: their hashes.
[[nodiscard]] Bytes encode_tunnels(const CacheContent& content, std::size_t group, const CacheIdentity& identity,
                                   const std::string& bound_to);

/// The tunnels of a group, tile by tile. Throws CacheDamage for what cannot be tunnels.
class TunnelReader {
 public:
  /// `shape`, `camera`, `samples`, `paths`: of the cache. What is in memory must outlive the reader.
  TunnelReader(const ByteSource& file, const CacheIdentity& identity, const StorageOptions& shape, const Camera& camera,
               std::uint32_t samples, std::size_t group, const PathBounds& paths);
  [[nodiscard]] const std::string& bound_to() const { return bound_to_; }
  /// The next three are for a tile of the image that is in the group.
  [[nodiscard]] const Sections& around(std::size_t tile) const { return around_[tile - first_]; }
  [[nodiscard]] bool has(std::size_t tile) const { return kept_[tile - first_] == 1; }
  /// Of its columns, before compression. Requires: has(tile).
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
  std::vector<std::uint8_t> levels_;  // of the cells of the group's tiles
  std::string bound_to_;
  std::vector<std::uint8_t> kept_;
  std::vector<Sections> around_;
};

}  // namespace relook
