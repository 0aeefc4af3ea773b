#include "frame/preview.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.h"
#include "base/parallel.h"
#include "base/png_chunks.h"
#include "base/pool.h"
#include "frame/deflate.h"

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

/// Codes of linear values: by the first bits of the number, then by the one boundary among numbers with these bits.
class SrgbCodes {
 public:
  SrgbCodes() {
    std::ranges::copy(srgb_boundaries(), boundary_.begin());
    boundary_.back() = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = 0; k < first_.size(); ++k)
      first_[k] = slow_code(std::bit_cast<float>((k + kLowest) << kShift));
    for (std::size_t k = 1; k < first_.size(); ++k)
      require(first_[k] - first_[k - 1] <= 1, "the steps are finer than the codes");
  }
  [[nodiscard]] unsigned char of(float linear) const {
    constexpr float kDark = 0x1p-13F, kBright = 0x1.FFFFFEp-1F;              // of the codes 0 and 255
    const float shown = linear > kDark ? std::min(linear, kBright) : kDark;  // NaN is dark, too
    const unsigned char code = first_[(std::bit_cast<std::uint32_t>(shown) >> kShift) - kLowest];
    return static_cast<unsigned char>(code + (shown >= boundary_[code] ? 1 : 0));
  }

 private:
  static constexpr unsigned kShift = 16;  // 128 steps an octave
  static constexpr std::uint32_t kLowest = (127U - 13U) << (23 - kShift), kEnd = 127U << (23 - kShift);
  [[nodiscard]] unsigned char slow_code(float linear) const {
    return static_cast<unsigned char>(std::ranges::upper_bound(boundary_, linear) - boundary_.begin());
  }

  std::array<float, 256> boundary_;
  std::array<unsigned char, kEnd - kLowest> first_{};  // code of the smallest number with these bits
};

void append(Bytes& out, BytesView data) {
  const std::size_t start = out.size();
  out.resize(start + data.size());
  std::copy(data.begin(), data.end(), out.data() + start);
}

Rgba exposed(const Rgba& pixel, float gain) { return {pixel.r * gain, pixel.g * gain, pixel.b * gain, pixel.a}; }

/// The nearest code of a display value.
unsigned char display_code(float value) {
  return value > 0 ? static_cast<unsigned char>(std::min(value, 1.0F) * 255.0F + 0.5F) : std::uint8_t{0};  // NaN: 0
}

constexpr std::string_view kWriter("Software\0relook", 15);  // keyword and text of a tEXt chunk
constexpr std::size_t kWriterOffset = 8 + 25 + 8;            // behind the signature, IHDR, and the chunk's own head

constexpr std::uint32_t kBandRows = 16;

}  // namespace

float gain_of(double exposure) { return static_cast<float>(std::exp2(exposure)); }

void expose(Frame& frame, double exposure) {
  const float gain = gain_of(exposure);
  for (Rgba& pixel : frame.pixels) pixel = exposed(pixel, gain);
}

PreviewEncoder::PreviewEncoder(std::uint32_t width, std::uint32_t height, PreviewStyle style)
    : width_(width),
      height_(height),
      view_(std::move(style.view)),
      gain_(gain_of(style.exposure)),
      codes_(std::size_t{width} * height * 3),
      bands_((height + kBandRows - 1) / kBandRows) {}

std::uint32_t PreviewEncoder::end_row(std::size_t band) const {
  return std::min(static_cast<std::uint32_t>(band + 1) * kBandRows, height_);
}

void PreviewEncoder::take(const Frame& frame, std::uint32_t x, std::uint32_t y, std::uint32_t count) {
  static const SrgbCodes codes_of;
  const std::size_t index = std::size_t{y} * width_ + x;
  unsigned char* codes = &codes_[index * 3];
  for (const Rgba& linear : std::span(frame.pixels).subspan(index, count)) {
    const Rgba pixel = exposed(linear, gain_);
    if (view_) {
      const Rgba shown = view_->apply(pixel);
      for (int channel = 0; channel < 3; ++channel) codes[channel] = display_code(shown[channel]);
    } else {
      codes[0] = codes_of.of(pixel.r);
      codes[1] = codes_of.of(pixel.g);
      codes[2] = codes_of.of(pixel.b);
    }
    codes += 3;
  }
}

void PreviewEncoder::update(const Frame& frame) {
  require(frame.width == width_ && frame.height == height_, "a preview encoder keeps one size");
  parallel_for(bands_.size(), [&](std::size_t band) {
    for (auto y = static_cast<std::uint32_t>(band) * kBandRows; y < end_row(band); ++y) take(frame, 0, y, width_);
    bands_[band].is_stale = true;
  });
}

void PreviewEncoder::update(const Frame& frame, const ChangedPixels& changed_pixels) {
  require(frame.width == width_ && frame.height == height_, "a preview encoder keeps one size");
  for (const ChangedPixels::Tile& tile : changed_pixels.tiles()) {
    const TileRect rect = tile_rect(tile.tile, width_, height_);
    for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
      std::uint64_t row = tile.mask[y - rect.y0];
      if (row != 0) bands_[y / kBandRows].is_stale = true;
      for (; row != 0; row &= row - 1) take(frame, rect.x0 + static_cast<std::uint32_t>(std::countr_zero(row)), y, 1);
    }
  }
}

/// Rows of 3 bytes a pixel, each led by its filter (1: differences to the left neighbour).
std::vector<unsigned char> PreviewEncoder::filtered_rows(std::size_t band) const {
  constexpr std::size_t kCodes = 3;
  const std::size_t row_bytes = std::size_t{width_} * kCodes;
  const std::size_t first_row = band * kBandRows;
  std::vector<unsigned char> rows((1 + row_bytes) * (end_row(band) - first_row));
  unsigned char* out = rows.data();
  for (std::size_t y = first_row; y < end_row(band); ++y, out += row_bytes) {
    const unsigned char* codes = &codes_[y * row_bytes];
    *out++ = 1;
    std::copy_n(codes, kCodes, out);
    for (std::size_t i = kCodes; i < row_bytes; ++i)
      out[i] = static_cast<unsigned char>(codes[i] - codes[i - kCodes]);
  }
  return rows;
}

Bytes PreviewEncoder::png() {
  Pool<Deflater> deflaters;
  parallel_for(bands_.size(), [&](std::size_t i) {
    if (!bands_[i].is_stale) return;
    const std::vector<unsigned char> rows = filtered_rows(i);
    const uLong checksum = adler32(1, rows.data(), static_cast<uInt>(rows.size()));
    const auto deflater = deflaters.take([] { return std::make_unique<Deflater>(); });
    bands_[i] = {false, deflater->blocks(rows), static_cast<std::uint32_t>(checksum)};
  });
  Bytes stream;
  for (const int value : {0x78, 0x01}) stream.push_back(static_cast<std::byte>(value));  // zlib: 32 KB window, fastest
  uLong checksum = 1;
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    append(stream, bands_[band].deflated);
    const std::size_t band_bytes = (1 + std::size_t{width_} * 3) * (end_row(band) - band * kBandRows);
    checksum = adler32_combine(checksum, bands_[band].checksum, static_cast<z_off_t>(band_bytes));
  }
  for (const int value : {0x03, 0x00}) stream.push_back(static_cast<std::byte>(value));  // an empty last block
  append_png_number(stream, static_cast<std::uint32_t>(checksum));

  Bytes png;
  append(png, bytes_of(kPngSignature));
  Bytes header;
  append_png_number(header, width_);
  append_png_number(header, height_);
  for (const int value : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));  // 8 bits, RGB
  append_png_chunk(png, "IHDR", header);
  append_png_chunk(png, "tEXt", bytes_of(kWriter));
  constexpr std::byte kPerceptual{0};
  if (!view_) append_png_chunk(png, "sRGB", BytesView(&kPerceptual, 1));
  append_png_chunk(png, "IDAT", stream);
  append_png_chunk(png, "IEND", {});
  return png;
}

bool is_own_preview(std::string_view start) {
  return start.starts_with("\x89PNG") && start.size() > kWriterOffset &&
         start.substr(kWriterOffset).starts_with(kWriter);
}

Bytes encode_png(const Frame& frame, PreviewStyle style) {
  PreviewEncoder encoder(frame.width, frame.height, std::move(style));
  encoder.update(frame);
  return encoder.png();
}

}  // namespace relook
