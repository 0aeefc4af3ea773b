#include "scene/texture/image_stream.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace relook {
namespace {

std::uint32_t big_endian(BytesView bytes, std::size_t offset, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

/// CRC-32 of ISO 3309, as PNG uses it.
class Crc {
 public:
  Crc() {
    for (std::uint32_t i = 0; i < table_.size(); ++i) {
      table_[i] = i;
      for (int bit = 0; bit < 8; ++bit)
        table_[i] = (table_[i] & 1U) != 0 ? 0xEDB88320U ^ table_[i] >> 1 : table_[i] >> 1;
    }
  }
  [[nodiscard]] std::uint32_t of(BytesView bytes) const {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::byte byte : bytes) crc = table_[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xFFU] ^ crc >> 8;
    return ~crc;
  }

 private:
  std::array<std::uint32_t, 256> table_;
};

/// What the header chunk of a PNG may say (PNG specification, 11.2.2).
bool is_png_header(BytesView data) {
  if (data.size() != 13) return false;
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(data[i]); };
  const std::uint32_t width = big_endian(data, 0, 4), height = big_endian(data, 4, 4);
  const unsigned depth = byte(8), color = byte(9);
  const bool is_grey = color == 0 && (depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16);
  const bool is_palette = color == 3 && (depth == 1 || depth == 2 || depth == 4 || depth == 8);
  const bool is_direct = (color == 2 || color == 4 || color == 6) && (depth == 8 || depth == 16);
  return width - 1 < INT32_MAX && height - 1 < INT32_MAX && (is_grey || is_palette || is_direct) && byte(10) == 0 &&
         byte(11) == 0 && byte(12) <= 1;
}

/// ImageStream::held_bytes of a PNG with this header. Requires: is_png_header(header).
std::uint64_t held_of_png(BytesView header) {
  constexpr std::array<std::uint64_t, 7> kChannels{1, 0, 3, 4, 2, 0, 4};  // by colour type; a palette may have alpha
  const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(header[i]); };
  if (byte(12) == 0) return 0;
  const std::uint64_t texel_bytes = kChannels[byte(9)] * (byte(8) == 16 ? 2 : 1);
  return std::uint64_t{big_endian(header, 0, 4)} * big_endian(header, 4, 4) * texel_bytes;
}

constexpr std::uint8_t kStartOfImage = 0xD8, kEndOfImage = 0xD9, kStartOfScan = 0xDA, kFill = 0xFF;

bool is_restart(std::uint8_t marker) { return marker >= 0xD0 && marker <= 0xD7; }

/// Markers without a length behind them.
bool stands_alone(std::uint8_t marker) {
  return marker == kStartOfImage || marker == kEndOfImage || marker == 0x01 || is_restart(marker);
}

constexpr std::uint8_t kProgressive = 0xC2, kProgressiveArithmetic = 0xCA;
constexpr std::size_t kMostScans = 100;  // encoders write up to 20; each is a pass over the image

/// Headers of a frame; C4, C8 and CC are tables and reserved.
bool is_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

bool makes_pixels(std::uint8_t marker) {
  constexpr std::uint8_t kJfif = 0xE0, kAdobe = 0xEE, kComment = 0xFE;
  const bool is_application = marker >= 0xE0 && marker <= 0xEF;
  return marker != kComment && (!is_application || marker == kJfif || marker == kAdobe);
}

/// Where the entropy-coded data that starts at `offset` meets the next marker.
std::size_t end_of_scan(BytesView jpeg, std::size_t offset) {
  for (; offset + 1 < jpeg.size(); ++offset) {
    const auto next = std::to_integer<std::uint8_t>(jpeg[offset + 1]);
    if (std::to_integer<int>(jpeg[offset]) == 0xFF && next != 0 && next != kFill && !is_restart(next)) return offset;
  }
  return jpeg.size();
}

}  // namespace

ImageStream png_pixels(BytesView png) {
  constexpr std::size_t kSignatureBytes = 8, kFrameBytes = 12;  // length, type, CRC
  constexpr std::array<std::string_view, 5> kKept = {"IHDR", "PLTE", "tRNS", "IDAT", "IEND"};
  const Crc crc;
  ImageStream pixels;
  const auto at = [](std::size_t offset) { return " at byte " + std::to_string(offset); };
  if (png.size() < kSignatureBytes) return {{}, "the PNG is cut short"};
  pixels.bytes.reserve(png.size());
  pixels.bytes.assign(png.begin(), png.begin() + kSignatureBytes);
  for (std::size_t offset = kSignatureBytes;;) {
    if (png.size() - offset < kFrameBytes) return {{}, "the PNG is cut short" + at(png.size())};
    const std::size_t length = big_endian(png, offset, 4);
    if (length > png.size() - offset - kFrameBytes) return {{}, "the PNG is cut short" + at(png.size())};
    const BytesView chunk = png.subspan(offset, length + kFrameBytes);
    const std::string_view type = text_of(chunk.subspan(4, 4));
    if (crc.of(chunk.subspan(4, length + 4)) != big_endian(chunk, length + 8, 4))
      return {{}, "the PNG is damaged: wrong CRC of the chunk" + at(offset)};
    if ((type == "IHDR") != (offset == kSignatureBytes)) return {{}, "the PNG does not start with one header"};
    if (type == "IHDR" && !is_png_header(chunk.subspan(8, length))) return {{}, "the header of the PNG is invalid"};
    if (type == "IHDR") pixels.held_bytes = held_of_png(chunk.subspan(8, length));
    if (std::ranges::find(kKept, type) != kKept.end())
      pixels.bytes.insert(pixels.bytes.end(), chunk.begin(), chunk.end());
    else if (type[0] >= 'A' && type[0] <= 'Z')
      return {{}, "the PNG has an unknown critical chunk" + at(offset)};
    if (type == "IEND") return pixels;
    offset += chunk.size();
  }
}

ImageStream jpeg_pixels(BytesView jpeg) {
  ImageStream pixels;
  pixels.bytes.reserve(jpeg.size());
  const auto keep = [&](std::size_t from, std::size_t to) {
    const BytesView part = jpeg.subspan(from, to - from);
    pixels.bytes.insert(pixels.bytes.end(), part.begin(), part.end());
  };
  const ImageStream cut_short{{}, "the JPEG is cut short at byte " + std::to_string(jpeg.size())};
  std::size_t offset = 0, scans = 0;
  unsigned components = 0;
  bool is_progressive = false;
  std::uint64_t coefficient_bytes = 0;
  while (offset + 2 <= jpeg.size()) {
    if (std::to_integer<int>(jpeg[offset]) != 0xFF)
      return {{}, "the JPEG is damaged: no marker at byte " + std::to_string(offset)};
    const auto marker = std::to_integer<std::uint8_t>(jpeg[offset + 1]);
    if (marker == kFill) {
      ++offset;
      continue;
    }
    std::size_t end = offset + 2;
    if (!stands_alone(marker)) {
      if (end + 2 > jpeg.size()) return cut_short;
      end += big_endian(jpeg, end, 2);
      if (end < offset + 4) return {{}, "the JPEG is damaged: an impossible length at byte " + std::to_string(offset)};
      if (end > jpeg.size()) return cut_short;
    }
    if (marker == kStartOfScan) {
      if (++scans > kMostScans) return {{}, "the JPEG has more than " + std::to_string(kMostScans) + " scans"};
      const unsigned in_scan = end > offset + 4 ? std::to_integer<unsigned>(jpeg[offset + 4]) : 0;
      if (scans > 1 || is_progressive || in_scan != components) pixels.held_bytes = coefficient_bytes;
      end = end_of_scan(jpeg, end);
    } else if (is_frame(marker)) {
      is_progressive = marker == kProgressive || marker == kProgressiveArithmetic;
      if (end > offset + 9) {
        components = std::to_integer<unsigned>(jpeg[offset + 9]);
        const std::uint64_t height = big_endian(jpeg, offset + 5, 2), width = big_endian(jpeg, offset + 7, 2);
        coefficient_bytes = 2 * components * width * height;
      }
    }
    if (makes_pixels(marker)) keep(offset, end);
    if (marker == kEndOfImage) return pixels;
    offset = end;
  }
  return cut_short;
}

bool is_webp(BytesView bytes) {
  const std::string_view text = text_of(bytes);
  return text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == "WEBP";
}

bool is_animated_webp(BytesView bytes) {
  constexpr std::size_t kFlags = 20;
  constexpr std::byte kAnimation{2};
  return is_webp(bytes) && bytes.size() > kFlags && text_of(bytes).substr(12, 4) == "VP8X" &&
         (bytes[kFlags] & kAnimation) != std::byte{0};
}

bool is_ktx2(BytesView bytes) { return text_of(bytes).starts_with("\xABKTX 20\xBB\r\n\x1A\n"); }

}  // namespace relook
