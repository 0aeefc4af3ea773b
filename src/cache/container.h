// One .rlk file of a cache: a header, a table of sections, the sections (FORMAT.md). Every section has its hash and its
// size before compression in the table; a file whose header says another version, scene or options is told apart from a
// damaged one. Columns of values in, bytes out, and back; what the sections are, the *_parts files know. The only file
// pair that sees zstd.
#pragma once
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/files.h"
#include "cache/cache.h"

namespace relook {

/// Layout of a cache directory; a change of any byte's meaning raises it.
inline constexpr std::uint32_t kCacheFormat = 6;
inline constexpr std::string_view kContainerMagic = "RLKCACHE";  // how every .rlk file begins

/// Which cache a file belongs to: the XXH3-128, in hexadecimal, of its scene and of its options.
struct CacheIdentity {
  std::string scene_hash, options_hash;
};

/// Thrown while a cache is read, turned into a CacheAnswer by read_cache(): never seen outside of cache/.
struct CacheDamage : std::runtime_error {
  CacheDamage(CacheFault kind, const std::string& detail) : std::runtime_error(detail), fault(kind) {}
  CacheFault fault;
};
/// Throws CacheDamage{damaged, detail} unless `sound`.
inline void check_sound(bool sound, std::string_view detail, std::string_view of_what = "") {
  if (!sound) throw CacheDamage(CacheFault::damaged, std::string(detail).append(of_what));
}

/// Types whose bytes are their value (Imath's types are, without being trivially copyable).
template <class T>
inline constexpr bool is_plain = std::is_standard_layout_v<T>&& std::is_trivially_destructible_v<T>;

class ContainerWriter {
 public:
  /// Adds a section. `stride`: bytes of one value, 1 to 64; before compression byte k of all values is put together.
  void add(std::string_view name, BytesView raw, std::uint32_t stride = 1);
  template <class T>
  void add_column(std::string_view name, const std::vector<T>& values, std::uint32_t stride) {
    static_assert(is_plain<T>);
    add(name, std::as_bytes(std::span<const T>(values)), stride);
  }
  [[nodiscard]] Bytes finish(const CacheIdentity& identity) const;

 private:
  struct Section {
    std::string name;
    std::uint32_t codec, stride;
    std::uint64_t raw_bytes;
    Bytes stored;
  };
  std::vector<Section> sections_;
};

/// The bytes of a file: in memory, or on disk, from where they are read as they are asked for.
class ByteSource {
 public:
  explicit ByteSource(BytesView bytes) : size_(bytes.size()), source_(bytes) {}
  ByteSource(std::filesystem::path file, std::uint64_t size) : size_(size), source_(std::move(file)) {}
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Bytes [offset, offset + count). `copy`: holds them if they come from disk. Requires: they are within size().
  /// Throws CacheDamage.
  [[nodiscard]] BytesView bytes(std::uint64_t offset, std::uint64_t count, Bytes& copy) const;

 private:
  std::uint64_t size_;
  std::variant<BytesView, std::filesystem::path> source_;
};

/// A .rlk file, its header and table checked. Every function throws CacheDamage; ResourceError where a section takes
/// more than --import-memory.
class ContainerReader {
 public:
  /// A file that is in memory must outlive the reader.
  ContainerReader(ByteSource file, const CacheIdentity& identity);
  ContainerReader(BytesView file, const CacheIdentity& identity) : ContainerReader(ByteSource(file), identity) {}

  [[nodiscard]] bool has(std::string_view name) const;
  [[nodiscard]] std::uint64_t raw_bytes(std::string_view name) const;
  /// Number of values of T in a section.
  template <class T>
  [[nodiscard]] std::uint64_t count(std::string_view name) const {
    check_sound(raw_bytes(name) % sizeof(T) == 0, "section " + std::string(name) + " holds a part of a value");
    return raw_bytes(name) / sizeof(T);
  }
  /// The values of a section, which must be exactly `count`.
  template <class T>
  [[nodiscard]] std::vector<T> column(std::string_view name, std::uint64_t count) const {
    static_assert(is_plain<T>);
    const Section& section = checked(name, count, sizeof(T));
    std::vector<T> values(count);
    read(section, std::as_writable_bytes(std::span<T>(values)));
    return values;
  }
  [[nodiscard]] std::string text(std::string_view name) const;

 private:
  struct Section {
    std::string name;
    std::uint32_t codec = 0, stride = 1;
    std::uint64_t raw_bytes = 0, stored_bytes = 0, offset = 0, hash = 0;
  };
  /// `start`: the file up to the hash behind the section table.
  void read_header(BytesView start, const CacheIdentity& identity);
  void read_table(BytesView start, std::uint32_t count);
  [[nodiscard]] const Section& find(std::string_view name) const;
  [[nodiscard]] const Section& checked(std::string_view name, std::uint64_t count, std::size_t value_bytes) const;
  void read(const Section& section, std::span<std::byte> out) const;

  ByteSource file_;
  std::vector<Section> sections_;
};

}  // namespace relook
