// A text file line by line, with the place of each, for files that are larger than what should be in memory:
// report.json and progress.jsonl. A FIFO or a device is refused, and never blocks.
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

  /// The next line without its line feed; false at the end of the file. What follows the last line feed is no line.
  /// Throws InputError (unreadable, or a line of more than 64 MiB).
  bool next(std::string& line);
  /// Byte offset of the line that next() gave.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }
  /// `bytes` bytes from `offset` on. Throws InputError when the file ends before.
  [[nodiscard]] std::string read_at(std::uint64_t offset, std::size_t bytes) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string waiting_;    // bytes that have been read
  std::size_t taken_ = 0;  // how many of these belong to lines that were given
  std::uint64_t offset_ = 0, next_offset_ = 0;
};

}  // namespace relook
