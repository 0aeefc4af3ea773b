#include "scene/texture/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "base/import_memory.h"

namespace relook {
namespace {

constexpr std::size_t kLongestName = 255;     // with the flag for long names; 31 without
constexpr std::size_t kChannelBytes = 16;     // what an entry of a channel list has behind the name
constexpr std::uint32_t kMultiPart = 0x1000;  // a flag of the version field

/// Reads forward; none beyond the end.
class Cursor {
 public:
  explicit Cursor(BytesView bytes) : bytes_(bytes) {}
  [[nodiscard]] std::size_t offset() const { return at_; }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  /// A name of at most kLongestName bytes, without the zero behind it.
  std::optional<std::string_view> name() {
    const std::string_view rest = text_of(bytes_.subspan(at_)).substr(0, kLongestName + 1);
    const std::size_t end = rest.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    at_ += end + 1;
    return rest.substr(0, end);
  }
  std::optional<std::uint32_t> word() {
    const std::optional<BytesView> bytes = take(sizeof(std::uint32_t));
    if (!bytes) return std::nullopt;
    std::uint32_t value = 0;
    std::memcpy(&value, bytes->data(), sizeof value);  // little-endian
    return value;
  }
  std::optional<BytesView> take(std::size_t count) {
    if (count > bytes_.size() - at_) return std::nullopt;
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

 private:
  BytesView bytes_;
  std::size_t at_ = 0;
};

bool is_whole_preview(BytesView value) {
  Cursor cursor(value);
  const auto width = cursor.word(), height = cursor.word();
  return width && height && value.size() % 4 == 0 &&
         std::uint64_t{*width} * *height == (value.size() - cursor.offset()) / 4;
}

bool are_whole_strings(BytesView value) {
  Cursor cursor(value);
  while (!cursor.at_end())
    if (const auto length = cursor.word(); !length || !cursor.take(*length)) return false;
  return true;
}

/// Channels to the zero behind them, which must be the last byte.
bool are_whole_channels(BytesView value) {
  Cursor cursor(value);
  while (const auto name = cursor.name()) {
    if (name->empty()) return cursor.at_end();
    if (!cursor.take(kChannelBytes)) return false;
  }
  return false;
}

/// Types of which the library reads a fixed number of bytes, whatever size the attribute says.
constexpr std::array<std::pair<std::string_view, std::size_t>, 24> kFixedBytes{{{"box2f", 16},
                                                                                {"box2i", 16},
                                                                                {"chromaticities", 32},
                                                                                {"compression", 1},
                                                                                {"deepImageState", 1},
                                                                                {"double", 8},
                                                                                {"envmap", 1},
                                                                                {"float", 4},
                                                                                {"int", 4},
                                                                                {"keycode", 28},
                                                                                {"lineOrder", 1},
                                                                                {"m33d", 72},
                                                                                {"m33f", 36},
                                                                                {"m44d", 128},
                                                                                {"m44f", 64},
                                                                                {"rational", 8},
                                                                                {"tiledesc", 9},
                                                                                {"timecode", 8},
                                                                                {"v2d", 16},
                                                                                {"v2f", 8},
                                                                                {"v2i", 8},
                                                                                {"v3d", 24},
                                                                                {"v3f", 12},
                                                                                {"v3i", 12}}};

/// Does a value take the bytes that its attribute says? Otherwise the library looks for the next attribute in a wrong
/// place.
bool is_whole(std::string_view type, BytesView value) {
  if (type == "preview") return is_whole_preview(value);
  if (type == "stringvector") return are_whole_strings(value);
  if (type == "chlist") return are_whole_channels(value);
  if (type == "floatvector") return value.size() % sizeof(float) == 0;
  if (type == "idmanifest") return value.size() >= sizeof(std::uint32_t);
  const auto fixed = std::ranges::find(kFixedBytes, type, &std::pair<std::string_view, std::size_t>::first);
  return fixed == kFixedBytes.end() || fixed->second == value.size();
}

/// What a part's header says of how much of it is unpacked at once.
struct Part {
  std::uint64_t pixel_bytes = 0, width = 0, height = 0, tile_texels = 0;

  /// Notes an attribute. Requires: is_whole(type, value).
  void take(std::string_view type, std::string_view name, BytesView value) {
    Cursor cursor(value);
    if (type == "chlist") add_channels(cursor);
    if (type == "tiledesc") tile_texels = word(cursor) * word(cursor);
    if (type != "box2i" || name != "dataWindow") return;
    const std::int64_t x0 = corner(cursor), y0 = corner(cursor), x1 = corner(cursor), y1 = corner(cursor);
    width = static_cast<std::uint64_t>(std::max<std::int64_t>(x1 - x0 + 1, 0));
    height = static_cast<std::uint64_t>(std::max<std::int64_t>(y1 - y0 + 1, 0));
  }
  [[nodiscard]] std::uint64_t block_bytes() const {
    constexpr std::uint64_t kMostRows = 256;  // of DWAB; others pack fewer together
    const std::uint64_t rows = bounded_product(width, std::min(height, kMostRows));
    return bounded_product(tile_texels > 0 ? tile_texels : rows, pixel_bytes);
  }

 private:
  static std::uint64_t word(Cursor& cursor) { return cursor.word().value_or(0); }
  static std::int64_t corner(Cursor& cursor) { return static_cast<std::int32_t>(cursor.word().value_or(0)); }
  void add_channels(Cursor& cursor) {
    constexpr std::uint32_t kHalf = 1;
    while (const auto channel = cursor.name()) {
      if (channel->empty()) return;
      pixel_bytes += word(cursor) == kHalf ? 2 : 4;
      static_cast<void>(cursor.take(kChannelBytes - sizeof kHalf));
    }
  }
};

/// Reads the attributes of one part, up to the empty name behind them. Returns what is wrong, or "".
std::string read_part(Cursor& cursor, Part& part) {
  while (true) {
    const std::size_t place = cursor.offset();
    const auto name = cursor.name();
    if (name && name->empty()) return "";
    const auto type = name ? cursor.name() : std::nullopt;
    const auto size = type ? cursor.word() : std::nullopt;
    const auto value = size ? cursor.take(*size) : std::nullopt;
    if (!value || !is_whole(*type, *value))
      return "the OpenEXR header's attribute at byte " + std::to_string(place) + " is not of the size that it says";
    part.take(*type, *name, *value);
  }
}

}  // namespace

ExrHeader read_exr_header(BytesView exr) {
  ExrHeader header;
  Cursor cursor(exr);
  static_cast<void>(cursor.word());
  const auto version = cursor.word();
  if (!version) header.fault = "the OpenEXR file is cut short at byte " + std::to_string(exr.size());
  for (bool is_first = true; header.fault.empty(); is_first = false) {
    const std::size_t start = cursor.offset();
    Part part;
    header.fault = read_part(cursor, part);
    header.block_bytes = std::max(header.block_bytes, part.block_bytes());
    const bool is_end = cursor.offset() == start + 1;  // an empty header ends the list of headers
    if ((*version & kMultiPart) == 0 || (is_end && !is_first)) break;
  }
  return header;
}

}  // namespace relook
