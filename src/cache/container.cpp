#include "cache/container.h"

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <memory>
#include <new>

#include "base/error.h"
#include "base/hash.h"
#include "base/import_memory.h"
#include "cache/manifest.h"

namespace relook {
namespace {

static_assert(std::endian::native == std::endian::little, "cache files are little-endian");

constexpr std::string_view kMagic = kContainerMagic;
constexpr std::size_t kHashDigits = 32, kNameBytes = 24;
constexpr std::size_t kHeaderBytes = 16 + 2 * kHashDigits, kEntryBytes = kNameBytes + 2 * 4 + 4 * 8;
constexpr std::uint32_t kLargestStride = 64;
constexpr int kCompressionLevel = 1;
enum Codec : std::uint32_t { kRaw = 0, kZstd = 1 };

template <class T>
void append(Bytes& out, T value) {
  const auto bytes = std::as_bytes(std::span<const T>(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class T>
T value_at(BytesView bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Can `stored_bytes` of zstd unpack to `raw_bytes`, as a table entry says? Their frame says to how many they do, and 4
/// bytes make no more than a block of 128 KiB. `start`: their first bytes, up to kFrameHeaderBytes.
bool can_unpack_to(BytesView start, std::uint64_t stored_bytes, std::uint64_t raw_bytes) {
  constexpr std::uint64_t kBlockBytes = 128 << 10, kSmallestBlock = 4;
  return ZSTD_getFrameContentSize(start.data(), start.size()) == raw_bytes &&
         raw_bytes / kBlockBytes <= stored_bytes / kSmallestBlock;
}
constexpr std::uint64_t kFrameHeaderBytes = 18;

void require_memory(const std::string& section, std::uint64_t raw_bytes) {
  require_import_memory(raw_bytes, "", "section " + printable(section) + " of the cache");
}

/// Puts byte k of every value together: high bytes of floats and indices repeat, low ones do not.
void group_bytes(BytesView in, std::uint32_t stride, std::byte* out) {
  const std::size_t count = in.size() / stride;
  for (std::size_t k = 0; k < stride; ++k)
    for (std::size_t i = 0; i < count; ++i) *out++ = in[i * stride + k];
}

constexpr std::size_t kWord = sizeof(std::uint32_t);

/// Word i of `out`, every `Stride` bytes, from the four groups of its bytes, `group_bytes` apart.
template <std::size_t Stride>
void ungroup_words(const std::byte* in, std::size_t group_bytes, std::size_t count, std::byte* out) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(in);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t value = static_cast<std::uint32_t>(bytes[i]) |
                                static_cast<std::uint32_t>(bytes[group_bytes + i]) << 8 |
                                static_cast<std::uint32_t>(bytes[2 * group_bytes + i]) << 16 |
                                static_cast<std::uint32_t>(bytes[3 * group_bytes + i]) << 24;
    std::memcpy(out + i * Stride, &value, sizeof value);
  }
}

void ungroup_bytes(BytesView in, std::uint32_t stride, std::byte* out) {
  const std::size_t count = in.size() / stride;
  const std::byte* next = in.data();
  // Most columns have values of one word: one loop, which the compiler vectorises.
  if (stride == kWord) return ungroup_words<kWord>(next, count, count, out);
  constexpr std::size_t kColor = 4 * kWord, kBlock = 256;  // of values, whose bytes stay in the processor's cache
  if (stride == kColor) {
    for (std::size_t i = 0; i < count; i += kBlock)
      for (std::size_t word = 0; word < kColor; word += kWord)
        ungroup_words<kColor>(next + word * count + i, count, std::min(kBlock, count - i), out + i * kColor + word);
    return;
  }
  for (std::size_t k = 0; k < stride; ++k)
    for (std::size_t i = 0; i < count; ++i) out[i * stride + k] = *next++;
}

/// Unpacks a section of values wider than a byte block by block, so that there is no second copy of all of it. False:
/// it does not unpack to as many bytes as `out` has.
bool unpack_grouped(BytesView stored, std::uint32_t stride, std::span<std::byte> out) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (context == nullptr) throw std::bad_alloc();
  Bytes block(ZSTD_DStreamOutSize());
  ZSTD_inBuffer in{stored.data(), stored.size(), 0};
  const std::size_t count = out.size() / stride;
  std::size_t done = 0, value = 0, byte = 0, open = 1;
  while (open != 0) {
    ZSTD_outBuffer next{block.data(), block.size(), 0};
    const std::size_t read_before = in.pos;
    open = ZSTD_decompressStream(context.get(), &next, &in);
    if (ZSTD_isError(open) != 0 || next.pos > out.size() - done) return false;
    if (next.pos == 0 && in.pos == read_before) return false;
    done += next.pos;
    for (std::size_t i = 0; i < next.pos; ++i) {
      out[value * stride + byte] = block[i];
      if (++value < count) continue;
      value = 0;
      ++byte;
    }
  }
  return done == out.size() && in.pos == in.size;
}

}  // namespace

void ContainerWriter::add(std::string_view name, BytesView raw, std::uint32_t stride) {
  require(name.size() < kNameBytes && stride >= 1 && stride <= kLargestStride && raw.size() % stride == 0,
          "a section has a short name and whole values");
  Section section{std::string(name), kRaw, stride, raw.size(), Bytes(raw.begin(), raw.end())};
  if (stride > 1) group_bytes(raw, stride, section.stored.data());
  Bytes packed(ZSTD_compressBound(raw.size()));
  const std::size_t packed_size =
      ZSTD_compress(packed.data(), packed.size(), section.stored.data(), section.stored.size(), kCompressionLevel);
  if (ZSTD_isError(packed_size) != 0) throw std::bad_alloc();
  if (packed_size < raw.size()) {
    packed.resize(packed_size);
    section.stored = std::move(packed);
    section.codec = kZstd;
  }
  sections_.push_back(std::move(section));
}

Bytes ContainerWriter::finish(const CacheIdentity& identity) const {
  require(identity.scene_hash.size() == kHashDigits && identity.options_hash.size() == kHashDigits,
          "hashes are 32 digits");
  Bytes file;
  std::uint64_t offset = kHeaderBytes + sections_.size() * kEntryBytes + sizeof(std::uint64_t);
  std::uint64_t file_bytes = offset;
  for (const Section& section : sections_) file_bytes += section.stored.size();
  file.reserve(file_bytes);

  const auto append_text = [&](std::string_view text, std::size_t bytes) {
    const BytesView view = bytes_of(text);
    file.insert(file.end(), view.begin(), view.end());
    file.insert(file.end(), bytes - view.size(), std::byte{0});
  };
  append_text(kMagic, kMagic.size());
  append(file, kCacheFormat);
  append(file, static_cast<std::uint32_t>(sections_.size()));
  append_text(identity.scene_hash, kHashDigits);
  append_text(identity.options_hash, kHashDigits);
  for (const Section& section : sections_) {
    append_text(section.name, kNameBytes);
    append(file, section.codec);
    append(file, section.stride);
    append(file, section.raw_bytes);
    append(file, std::uint64_t{section.stored.size()});
    append(file, offset);
    append(file, hash64(section.stored));
    offset += section.stored.size();
  }
  append(file, hash64(file));
  for (const Section& section : sections_) file.insert(file.end(), section.stored.begin(), section.stored.end());
  return file;
}

BytesView ByteSource::bytes(std::uint64_t offset, std::uint64_t count, Bytes& copy) const {
  require(offset <= size_ && count <= size_ - offset, "only what is in a file is read");
  if (const auto* memory = std::get_if<BytesView>(&source_)) return memory->subspan(offset, count);
  const auto& path = std::get<std::filesystem::path>(source_);
  copy.resize(count);
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (file < 0 && is_refusal(errno)) throw CacheDamage(CacheFault::unreadable, refusal_text(errno));
  if (file < 0) throw CacheDamage(CacheFault::damaged, "the file is missing");
  std::uint64_t done = 0;
  int error = 0;
  while (done < count) {
    const ssize_t got = ::pread(file, copy.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    error = got < 0 ? errno : 0;
    if (got <= 0) break;
    done += static_cast<std::uint64_t>(got);
  }
  ::close(file);
  if (error != 0) throw CacheDamage(CacheFault::damaged, std::string("cannot be read: ") + std::strerror(error));
  if (done < count) throw CacheDamage(CacheFault::truncated, "the file is cut short");
  return copy;
}

ContainerReader::ContainerReader(ByteSource file, const CacheIdentity& identity) : file_(std::move(file)) {
  if (file_.size() < kHeaderBytes + sizeof(std::uint64_t))
    throw CacheDamage(CacheFault::truncated, "the header is cut short");
  Bytes copy;
  const BytesView header = file_.bytes(0, kHeaderBytes, copy);
  check_sound(text_of(header.first(kMagic.size())) == kMagic, "the first bytes are not RLKCACHE");
  const auto version = value_at<std::uint32_t>(header, 8);
  if (version != kCacheFormat)
    throw CacheDamage(CacheFault::other_version,
                      "format " + std::to_string(version) + ", this program reads " + std::to_string(kCacheFormat));
  const std::uint64_t table_end = kHeaderBytes + std::uint64_t{value_at<std::uint32_t>(header, 12)} * kEntryBytes;
  if (file_.size() < table_end + sizeof(std::uint64_t))
    throw CacheDamage(CacheFault::truncated, "the section table is cut short");
  read_header(file_.bytes(0, table_end + sizeof(std::uint64_t), copy), identity);
}

void ContainerReader::read_header(BytesView start, const CacheIdentity& identity) {
  const std::size_t table_end = start.size() - sizeof(std::uint64_t);
  check_sound(value_at<std::uint64_t>(start, table_end) == hash64(start.first(table_end)), "header hash mismatch");
  if (text_of(start.subspan(16, kHashDigits)) != identity.scene_hash)
    throw CacheDamage(CacheFault::other_scene, "the header has the hash of another scene");
  if (text_of(start.subspan(16 + kHashDigits, kHashDigits)) != identity.options_hash)
    throw CacheDamage(CacheFault::other_options, "the header has the hash of other options");
  read_table(start, value_at<std::uint32_t>(start, 12));
}

void ContainerReader::read_table(BytesView start, std::uint32_t count) {
  std::uint64_t expected_offset = kHeaderBytes + std::size_t{count} * kEntryBytes + sizeof(std::uint64_t);
  for (std::uint32_t i = 0; i < count; ++i) {
    const BytesView entry = start.subspan(kHeaderBytes + std::size_t{i} * kEntryBytes, kEntryBytes);
    const std::string_view padded = text_of(entry.first(kNameBytes));
    Section section;
    section.name = padded.substr(0, padded.find('\0'));
    section.codec = value_at<std::uint32_t>(entry, 24);
    section.stride = value_at<std::uint32_t>(entry, 28);
    section.raw_bytes = value_at<std::uint64_t>(entry, 32);
    section.stored_bytes = value_at<std::uint64_t>(entry, 40);
    section.offset = value_at<std::uint64_t>(entry, 48);
    section.hash = value_at<std::uint64_t>(entry, 56);
    check_sound(section.codec <= kZstd && section.stride >= 1 && section.stride <= kLargestStride &&
                    section.raw_bytes % section.stride == 0 && section.offset == expected_offset &&
                    (section.codec != kRaw || section.raw_bytes == section.stored_bytes),
                "the table entry of section " + printable(section.name) + " makes no sense");
    if (section.stored_bytes > file_.size() - section.offset)
      throw CacheDamage(CacheFault::truncated, "section " + printable(section.name) + " is cut short");
    Bytes copy;
    const BytesView first = file_.bytes(section.offset, std::min(section.stored_bytes, kFrameHeaderBytes), copy);
    check_sound(section.codec != kZstd || can_unpack_to(first, section.stored_bytes, section.raw_bytes),
                "the bytes of section " + printable(section.name) + " cannot unpack to the size that the table says");
    expected_offset += section.stored_bytes;
    sections_.push_back(std::move(section));
  }
  check_sound(expected_offset == file_.size(), "bytes after the last section");
}

bool ContainerReader::has(std::string_view name) const {
  return std::any_of(sections_.begin(), sections_.end(), [&](const Section& section) { return section.name == name; });
}

const ContainerReader::Section& ContainerReader::find(std::string_view name) const {
  const auto found =
      std::find_if(sections_.begin(), sections_.end(), [&](const Section& section) { return section.name == name; });
  check_sound(found != sections_.end(), "no section " + std::string(name));
  return *found;
}

std::uint64_t ContainerReader::raw_bytes(std::string_view name) const { return find(name).raw_bytes; }

const ContainerReader::Section& ContainerReader::checked(std::string_view name, std::uint64_t count,
                                                         std::size_t value_bytes) const {
  const Section& section = find(name);
  check_sound(section.raw_bytes % value_bytes == 0 && section.raw_bytes / value_bytes == count,
              "section " + section.name + " does not hold " + std::to_string(count) + " values");
  require_memory(section.name, section.raw_bytes);
  return section;
}

std::string ContainerReader::text(std::string_view name) const {
  constexpr std::uint64_t kParsed = 16;  // bytes of a parsed document for each of its text
  require_memory(std::string(name), bounded_product(raw_bytes(name), kParsed));
  std::string text(raw_bytes(name), '\0');
  read(find(name), std::as_writable_bytes(std::span<char>(text.data(), text.size())));
  return text;
}

void ContainerReader::read(const Section& section, std::span<std::byte> out) const {
  Bytes copy;
  const BytesView stored = file_.bytes(section.offset, section.stored_bytes, copy);
  check_sound(hash64(stored) == section.hash, "hash mismatch in section " + section.name);
  if (section.raw_bytes == 0) return;
  std::unique_ptr<std::byte[]> unpacked;  // not filled with zeros first
  BytesView grouped = stored;
  if (section.codec == kZstd) {
    constexpr std::uint64_t kLarge = std::uint64_t{64} << 20;
    const bool in_place = section.stride == 1;
    if (!in_place && section.raw_bytes > kLarge)
      return check_sound(unpack_grouped(stored, section.stride, out), "section " + section.name + " does not unpack");
    if (!in_place) unpacked = std::make_unique_for_overwrite<std::byte[]>(section.raw_bytes);
    std::byte* target = in_place ? out.data() : unpacked.get();
    const std::size_t size = ZSTD_decompress(target, section.raw_bytes, stored.data(), stored.size());
    check_sound(ZSTD_isError(size) == 0 && size == section.raw_bytes, "section " + section.name + " does not unpack");
    if (in_place) return;
    grouped = {unpacked.get(), section.raw_bytes};
  }
  if (section.stride == 1)
    std::memcpy(out.data(), grouped.data(), grouped.size());
  else
    ungroup_bytes(grouped, section.stride, out.data());
}

}  // namespace relook
