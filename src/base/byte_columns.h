// Vectors of plain values, one after the other in one block of bytes: for copies that the same process reads back, from
// a disk perhaps, which may have lost something.
#pragma once
#include <cstring>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/files.h"

namespace relook {

class ByteColumns {
 public:
  template <class T>
  void append(const std::vector<T>& column) {
    static_assert(std::is_trivially_destructible_v<T>);  // Imath's vectors are plain, but do not say so
    const std::uint64_t count = column.size();
    put(&count, sizeof count);
    put(column.data(), column.size() * sizeof(T));
  }
  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  void put(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t start = bytes_.size();
    bytes_.resize(start + size);
    std::memcpy(bytes_.data() + start, data, size);
  }
  Bytes bytes_;
};

class ByteColumnsReader {
 public:
  explicit ByteColumnsReader(BytesView bytes) : rest_(bytes) {}
  /// Requires: columns are read in the order, and with the types, in which they were appended. Throws IoError if the
  /// bytes are not those of such columns.
  template <class T>
  void next(std::vector<T>& column) {
    std::uint64_t count = 0;
    get(&count, sizeof count);
    check(count <= rest_.size() / sizeof(T));
    column.resize(count);
    get(column.data(), count * sizeof(T));
  }

 private:
  static void check(bool fits) {
    if (!fits) throw IoError("", "what was evicted to disk is not read back as it was written");
  }
  void get(void* data, std::size_t size) {
    check(size <= rest_.size());
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  BytesView rest_;
};

}  // namespace relook
