#include "engine/preview.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <new>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {
namespace {

/// boundary[k]: the smallest linear value that is encoded as k + 1 (IEC 61966-2-1, rounded to the nearest code).
std::array<float, 255> srgb_boundaries() {
  std::array<float, 255> boundary{};
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    const double encoded = (static_cast<double>(k) + 0.5) / 255;
    boundary[k] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return boundary;
}

/// Codes of linear values: by the first bits of the number, then by the few boundaries among numbers with these bits.
class SrgbCodes {
 public:
  SrgbCodes() : boundary_(srgb_boundaries()) {
    for (std::uint32_t k = 0; k < first_.size(); ++k)
      first_[k] = slow_code(std::bit_cast<float>((k + kLowest) << kShift));
  }
  [[nodiscard]] unsigned char of(float linear) const {
    if (!(linear > 0x1p-13F)) return 0;  // NaN, too
    if (linear >= 1.0F) return 255;
    unsigned char code = first_[(std::bit_cast<std::uint32_t>(linear) >> kShift) - kLowest];
    while (code < 255 && linear >= boundary_[code]) ++code;
    return code;
  }

 private:
  static constexpr unsigned kShift = 16;  // 128 steps an octave
  static constexpr std::uint32_t kLowest = (127U - 13U) << (23 - kShift), kEnd = 127U << (23 - kShift);
  [[nodiscard]] unsigned char slow_code(float linear) const {
    return static_cast<unsigned char>(std::upper_bound(boundary_.begin(), boundary_.end(), linear) - boundary_.begin());
  }

  std::array<float, 255> boundary_;
  std::array<unsigned char, kEnd - kLowest> first_{};  // code of the smallest number with these bits
};

void append(Bytes& out, BytesView data) {
  const std::size_t start = out.size();
  out.resize(start + data.size());
  std::copy(data.begin(), data.end(), out.data() + start);
}

void append_number(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}

void append_chunk(Bytes& out, std::string_view type, BytesView data) {
  append_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  append(out, bytes_of(type));
  append(out, data);
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(out.data() + start), static_cast<uInt>(out.size() - start));
  append_number(out, static_cast<std::uint32_t>(sum));
}

constexpr std::uint32_t kBandRows = 64;

/// Rows of 3 bytes a pixel, each led by its filter (1: differences to the left neighbour).
std::vector<unsigned char> filtered_rows(const Frame& frame, std::uint32_t first_row, std::uint32_t last_row) {
  static const SrgbCodes codes_of;
  std::vector<unsigned char> rows((1 + std::size_t{frame.width} * 3) * (last_row - first_row));
  unsigned char* out = rows.data();
  for (std::uint32_t y = first_row; y < last_row; ++y) {
    *out++ = 1;
    std::array<unsigned char, 3> left{};
    for (std::size_t x = 0; x < frame.width; ++x) {
      const Rgba& pixel = frame.pixels[std::size_t{y} * frame.width + x];
      const std::array<unsigned char, 3> codes{codes_of.of(pixel.r), codes_of.of(pixel.g), codes_of.of(pixel.b)};
      for (std::size_t c = 0; c < 3; ++c) *out++ = static_cast<unsigned char>(codes[c] - left[c]);
      left = codes;
    }
  }
  return rows;
}

/// Deflate blocks that end on a byte and are not the last of their stream.
Bytes deflate_blocks(std::vector<unsigned char>& rows) {
  constexpr int kFastest = 1, kRawDeflate = -15, kMemoryLevel = 8;
  constexpr std::size_t kFlushBytes = 16;
  Bytes packed(compressBound(static_cast<uLong>(rows.size())) + kFlushBytes);
  z_stream stream{};
  const int started = deflateInit2(&stream, kFastest, Z_DEFLATED, kRawDeflate, kMemoryLevel, Z_RLE);
  if (started == Z_MEM_ERROR) throw std::bad_alloc();
  require(started == Z_OK, "zlib starts with these settings");
  stream.next_in = rows.data();
  stream.avail_in = static_cast<uInt>(rows.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FULL_FLUSH);
  const std::size_t packed_size = packed.size() - stream.avail_out;
  const bool is_whole = result == Z_OK && stream.avail_in == 0 && stream.avail_out > 0;
  deflateEnd(&stream);
  require(is_whole, "deflate into a buffer of its own bound succeeds");
  return {packed.data(), packed.data() + packed_size};
}

}  // namespace

PreviewEncoder::PreviewEncoder(std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), bands_((height + kBandRows - 1) / kBandRows) {}

std::size_t PreviewEncoder::band_bytes(std::size_t band) const {
  const std::size_t first_row = band * kBandRows;
  return (1 + std::size_t{width_} * 3) * (std::min<std::size_t>(first_row + kBandRows, height_) - first_row);
}

void PreviewEncoder::compress(const Frame& frame, std::span<const std::uint32_t> bands) {
  require(frame.width == width_ && frame.height == height_, "a preview encoder keeps one size");
  parallel_for(bands.size(), [&](std::size_t i) {
    const std::uint32_t first_row = bands[i] * kBandRows;
    std::vector<unsigned char> rows = filtered_rows(frame, first_row, std::min(first_row + kBandRows, height_));
    const uLong checksum = adler32(1, rows.data(), static_cast<uInt>(rows.size()));
    bands_[bands[i]] = {deflate_blocks(rows), static_cast<std::uint32_t>(checksum)};
  });
}

void PreviewEncoder::update(const Frame& frame) {
  std::vector<std::uint32_t> all(bands_.size());
  std::iota(all.begin(), all.end(), 0U);
  compress(frame, all);
}

void PreviewEncoder::update(const Frame& frame, const ChangedPixels& changed_pixels) {
  const std::uint32_t tiles_across = (width_ + kTileSize - 1) / kTileSize;
  std::vector<bool> touched(bands_.size());
  for (const ChangedPixels::Tile& tile : changed_pixels.tiles())
    for (std::uint32_t y = 0; y < kTileSize; ++y)
      if (tile.mask[y] != 0) touched[(tile.tile / tiles_across * kTileSize + y) / kBandRows] = true;
  std::vector<std::uint32_t> bands;
  for (std::uint32_t band = 0; band < touched.size(); ++band)
    if (touched[band]) bands.push_back(band);
  compress(frame, bands);
}

Bytes PreviewEncoder::png() const {
  Bytes stream;
  for (const int value : {0x78, 0x01}) stream.push_back(static_cast<std::byte>(value));  // zlib: 32 KB window, fastest
  uLong checksum = 1;
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    append(stream, bands_[band].deflated);
    checksum = adler32_combine(checksum, bands_[band].checksum, static_cast<z_off_t>(band_bytes(band)));
  }
  for (const int value : {0x03, 0x00}) stream.push_back(static_cast<std::byte>(value));  // an empty last block
  append_number(stream, static_cast<std::uint32_t>(checksum));

  Bytes png;
  append(png, bytes_of("\x89PNG\r\n\x1A\n"));
  Bytes header;
  append_number(header, width_);
  append_number(header, height_);
  for (const int value : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));  // 8 bits, RGB
  append_chunk(png, "IHDR", header);
  constexpr std::byte kPerceptual{0};
  append_chunk(png, "sRGB", BytesView(&kPerceptual, 1));
  append_chunk(png, "IDAT", stream);
  append_chunk(png, "IEND", {});
  return png;
}

Bytes encode_png(const Frame& frame) {
  PreviewEncoder encoder(frame.width, frame.height);
  encoder.update(frame);
  return encoder.png();
}

}  // namespace relook
