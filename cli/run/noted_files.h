// Whether the files of a run are those that were noted. A note may have been changed by anybody, and so may a file's
// time of change: bytes are what is believed. They are read once a command; then the system's own word for a file that
// has not been touched since (its inode, size, and the time of its last change of any kind, which nobody can set) is
// enough.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "base/json.h"
#include "report/report.h"

namespace relook {

class NotedFiles {
 public:
  explicit NotedFiles(std::filesystem::path run) : run_(std::move(run)) {}

  /// Whether each of an entry's files is a regular file, no link, with the bytes that were noted. From many threads.
  /// Requires: an entry that check_entry() has passed.
  [[nodiscard]] bool hold(const Json& entry);
  /// The same, but a size and time as noted are taken for the bytes: for frames that a command does not answer for.
  [[nodiscard]] bool seem_to_hold(const Json& entry);

 private:
  struct Seen {
    std::uint64_t bytes = 0;
    std::int64_t modified = 0, changed = 0;  // nanoseconds since the epoch
    std::string hash;
  };
  [[nodiscard]] bool has_bytes(const std::string& name, const Json& stamp, bool trusts_time);

  std::filesystem::path run_;
  std::mutex mutex_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Seen> seen_;  // by device and inode
};

/// A file as it is now, whose bytes have this hash. Throws IoError.
[[nodiscard]] FileStamp stamp_of(const std::filesystem::path& path, std::string hash);

}  // namespace relook
