// The tunnels of a cache, read tile by tile when a replay first needs them. A file that is damaged, or of other ray
// trees than the cache's, is as good as none: its tiles' tunnels are worked out anew. Safe to use from several threads.
// Used by ImageRegions (image/regions.h).
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "cache/cache.h"

namespace relook {

class TunnelReader;
struct Manifest;

/// What tunnels around trees with the paths of a table can be: for the checks of stored ones.
struct PathBounds {
  std::size_t count = 0;       // how many paths there are
  std::size_t most_words = 0;  // of the longest path; no tree has more nodes
};
[[nodiscard]] PathBounds bounds_of(const PathTable& paths);

class StoredTunnels {
 public:
  /// Null if the cache has no tunnels. `manifest`, `paths`: those of the image that has been read.
  [[nodiscard]] static std::shared_ptr<StoredTunnels> of_cache(const std::filesystem::path& path,
                                                               std::shared_ptr<const Manifest> manifest,
                                                               const PathTable& paths);
  StoredTunnels(std::filesystem::path path, std::shared_ptr<const Manifest> manifest, const PathBounds& paths);
  ~StoredTunnels();

  [[nodiscard]] const StorageOptions& shape() const;
  /// The next three throw IoError where a file may not be opened.
  /// Around all tunnels of a tile; none if they cannot be read.
  [[nodiscard]] std::optional<Sections> around(std::size_t tile);
  /// Bytes of a tile's tunnels before compression, 0 if they are damaged; none: they are not stored.
  [[nodiscard]] std::optional<std::uint64_t> bytes(std::size_t tile);
  /// A tile's tunnels; none if they are not stored or cannot be read.
  [[nodiscard]] std::optional<TileTunnels> read(std::size_t tile);
  /// What could not be read since the last call, one answer a file; each file is reported once.
  [[nodiscard]] std::vector<CacheAnswer> take_faults();

 private:
  struct Group {
    std::once_flag is_opened;
    std::unique_ptr<TunnelReader> reader;  // null: nothing of it can be used
    std::string file;
    bool is_faulty = false;
  };
  Group& group_of(std::size_t tile);
  void open(std::size_t number, Group& group);
  void note_fault(Group& group, const CacheAnswer& answer);

  std::filesystem::path path_;
  std::shared_ptr<const Manifest> manifest_;
  PathBounds paths_;
  std::vector<Group> groups_;
  std::mutex mutex_;  // of the faults
  std::vector<CacheAnswer> faults_;
};

}  // namespace relook
