// A text file line by line, with the place of each, for files that are larger than what should be in memory. Nothing
// here blocks on a FIFO or a device.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/files.h"

namespace relook {

class LineReader {
 public:
  /// Throws InputError when there is no such regular file.
  explicit LineReader(std::filesystem::path path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The next line without its end; false at the end of the file, where a line that has none does not count. Throws
  /// InputError (unreadable, or a line of more than 64 MiB).
  bool next(std::string& line);
  /// Byte offset of the line that next() gave.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }
  /// `bytes` bytes from `offset` on. Throws InputError when the file ends before.
  [[nodiscard]] std::string read_at(std::uint64_t offset, std::size_t bytes) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string waiting_;  // read, from the end of the last line on
  std::size_t taken_ = 0;
  std::uint64_t offset_ = 0, next_offset_ = 0;
};

}  // namespace relook
