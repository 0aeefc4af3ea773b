// A file without a name for what is evicted from memory: gone when the process is, however that ends. Extents are
// reused; nothing in it outlives a run, so it is neither synced nor hashed.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

#include "base/files.h"

namespace relook {

class SpillFile {
 public:
  struct Extent {
    std::uint64_t offset = 0, bytes = 0, room = 0;
  };

  /// Creates a file in `folder`, of at most `limit_bytes`. Throws IoError if the folder cannot hold a file.
  SpillFile(const std::filesystem::path& folder, std::uint64_t limit_bytes);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// Stores a copy; none if the limit or the disk does not allow it. One call at a time.
  [[nodiscard]] std::optional<Extent> write(BytesView bytes);
  /// Reads a copy back. Throws IoError. May be called from several threads, also while another one writes.
  [[nodiscard]] Bytes read(const Extent& extent) const;
  /// It will be read soon: the system may fetch it meanwhile. From any thread.
  void expect(const Extent& extent) const;
  void free(const Extent& extent);
  [[nodiscard]] std::uint64_t bytes() const { return used_; }

 private:
  std::filesystem::path folder_;
  std::uint64_t limit_, used_ = 0, end_ = 0;
  std::multimap<std::uint64_t, std::uint64_t> free_;  // offsets of free extents by their sizes
  int descriptor_ = -1;
};

}  // namespace relook
