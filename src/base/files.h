// Checked files: what is read is a regular file of bounded size; what is written appears under its final name whole and
// synced, or not at all.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace relook {

using Bytes = std::vector<std::byte>;
using BytesView = std::span<const std::byte>;

[[nodiscard]] inline BytesView bytes_of(std::string_view text) {
  return std::as_bytes(std::span<const char>(text.data(), text.size()));
}
[[nodiscard]] inline std::string_view text_of(BytesView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Default upper bound of read_file: larger inputs are refused.
inline constexpr std::size_t kLargestInputBytes = std::size_t{8} << 30;

/// The whole of a regular file. Never blocks on a FIFO or device. Throws InputError (missing, not a regular file,
/// larger than `limit_bytes`, unreadable).
[[nodiscard]] Bytes read_file(const std::filesystem::path& path, std::size_t limit_bytes = kLargestInputBytes);

/// A file that is named where it may lie, and is not there.
struct MissingFileError : InputError {
  using InputError::InputError;
};

/// Resolves a file name (a URI, already percent-decoded; "a/../b" is "b", RFC 3986 section 5.2.4) to a file below
/// `folder` or one of `roots`, followed through symbolic links: no name and no link leads elsewhere. An absolute name
/// must lie below a root. Throws InputError{file, where, ...}, MissingFileError.
[[nodiscard]] std::filesystem::path contained_path(const std::filesystem::path& folder,
                                                   std::span<const std::filesystem::path> roots, std::string_view uri,
                                                   std::string_view file, std::string_view where);

/// Writes to a temporary file beside `path`, checks every write, fsync and close, renames, syncs the folder. On failure
/// the temporary is gone, `path` is as before, and IoError or ResourceError (disk full) is thrown.
void write_file(const std::filesystem::path& path, BytesView bytes);
inline void write_file(const std::filesystem::path& path, std::string_view text) { write_file(path, bytes_of(text)); }

/// The same for a file that is not in memory as a whole: written piece by piece, there once publish() has returned.
class FileWriter {
 public:
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  void append(BytesView bytes);
  void append(std::string_view text) { append(bytes_of(text)); }
  [[nodiscard]] std::uint64_t size() const { return written_bytes_; }
  void publish();

 private:
  struct Temporary;
  void write_out();

  std::filesystem::path path_;
  std::unique_ptr<Temporary> temporary_;
  Bytes waiting_;  // not yet handed to the system
  std::uint64_t written_bytes_ = 0;
};

/// Throws ResourceError for a lack of space or memory, else IoError: "PATH: cannot ACTION: reason of `error`".
[[noreturn]] void fail_to_write(const std::filesystem::path& path, std::string_view action, int error);
/// Writes at the place of an open descriptor and syncs it; `path` is for messages. Throws IoError, ResourceError.
void append_synced(int descriptor, BytesView bytes, const std::filesystem::path& path);

/// Syncs a folder's entries to disk. Throws IoError.
void sync_folder(const std::filesystem::path& folder);
/// Creates a folder and its parents. Throws IoError or ResourceError.
void make_folders(const std::filesystem::path& folder);

}  // namespace relook
