#include "engine/preview.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {
namespace {

/// boundary[k]: the smallest linear value that is encoded as k + 1 (IEC 61966-2-1, rounded to the nearest code).
std::array<float, 255> srgb_boundaries() {
  std::array<float, 255> boundary{};
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    const double encoded = (static_cast<double>(k) + 0.5) / 255;
    boundary[k] =
        static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return boundary;
}

unsigned char srgb_code(const std::array<float, 255>& boundary, float linear) {
  if (std::isnan(linear)) return 0;
  return static_cast<unsigned char>(std::upper_bound(boundary.begin(), boundary.end(), linear) - boundary.begin());
}

void append_number(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}

void append_chunk(Bytes& out, std::string_view type, BytesView data) {
  append_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  const BytesView name = bytes_of(type);
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(out.data() + start), static_cast<uInt>(out.size() - start));
  append_number(out, static_cast<std::uint32_t>(sum));
}

/// Rows of 3 bytes a pixel, each led by its filter (1: differences to the left neighbour).
std::vector<unsigned char> filtered_rows(const Frame& frame) {
  const std::array<float, 255> boundary = srgb_boundaries();
  const std::size_t row_bytes = 1 + std::size_t{frame.width} * 3;
  std::vector<unsigned char> rows(row_bytes * frame.height);
  parallel_for(
      frame.height,
      [&](std::size_t y) {
        unsigned char* out = rows.data() + y * row_bytes;
        *out++ = 1;
        std::array<unsigned char, 3> left{};
        for (std::size_t x = 0; x < frame.width; ++x) {
          const Rgba& pixel = frame.pixels[y * frame.width + x];
          const std::array<unsigned char, 3> codes{srgb_code(boundary, pixel.r), srgb_code(boundary, pixel.g),
                                                   srgb_code(boundary, pixel.b)};
          for (std::size_t c = 0; c < 3; ++c) *out++ = static_cast<unsigned char>(codes[c] - left[c]);
          left = codes;
        }
      },
      16);
  return rows;
}

}  // namespace

Bytes encode_png(const Frame& frame) {
  constexpr int kFastest = 1;
  const std::vector<unsigned char> rows = filtered_rows(frame);
  uLongf packed_size = compressBound(static_cast<uLong>(rows.size()));
  Bytes packed(packed_size);
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, rows.data(),
                               static_cast<uLong>(rows.size()), kFastest);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  require(result == Z_OK, "deflate into a buffer of its own bound succeeds");
  packed.resize(packed_size);

  Bytes png;
  const BytesView signature = bytes_of("\x89PNG\r\n\x1A\n");
  png.insert(png.end(), signature.begin(), signature.end());
  Bytes header;
  append_number(header, frame.width);
  append_number(header, frame.height);
  for (const int value : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));  // 8 bits, RGB
  append_chunk(png, "IHDR", header);
  constexpr std::byte kPerceptual{0};
  append_chunk(png, "sRGB", BytesView(&kPerceptual, 1));
  append_chunk(png, "IDAT", packed);
  append_chunk(png, "IEND", {});
  return png;
}

}  // namespace relook
