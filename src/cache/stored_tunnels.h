// The tunnels of a cache, read tile by tile when a replay first needs them. A file that is damaged, or of other ray
// trees than the cache's, is as good as none: its tiles' tunnels are worked out anew. Safe to use from several threads.
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

class StoredTunnels {
 public:
  /// Null if the cache has none. `path_count`: of its path table.
  [[nodiscard]] static std::shared_ptr<StoredTunnels> of_cache(const std::filesystem::path& path,
                                                               std::size_t path_count);
  StoredTunnels(std::filesystem::path path, Manifest manifest, std::size_t path_count);
  ~StoredTunnels();

  [[nodiscard]] const StorageOptions& shape() const;
  /// Around all tunnels of a tile; none if they cannot be read.
  [[nodiscard]] std::optional<Sections> around(std::size_t tile);
  /// Bytes of a tile's tunnels, about; 0: they are not stored.
  [[nodiscard]] std::uint64_t bytes(std::size_t tile);
  [[nodiscard]] std::optional<TileTunnels> read(std::size_t tile);
  /// What could not be read since the last call, one a file.
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
  std::unique_ptr<Manifest> manifest_;
  std::size_t path_count_;
  std::vector<Group> groups_;
  std::mutex mutex_;  // of the faults
  std::vector<CacheAnswer> faults_;
};

}  // namespace relook
