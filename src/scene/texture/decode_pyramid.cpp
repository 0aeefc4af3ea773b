#include "scene/texture/decode_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/import_memory.h"
#include "scene/texture/exr_header.h"
#include "scene/texture/image_library.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

/// Bytes of the rows that are decoded at once, in the format of the pyramid.
constexpr std::size_t kRowBytes = std::size_t{4} << 20;
/// Bytes that a decoder may hold beside the result without being counted.
constexpr std::uint64_t kFewBytes = std::uint64_t{64} << 20;
/// Bound of an HDR texel: sums of many stay finite.
constexpr float kLargestTexel = 1e9F;

/// OpenImageIO's name for what the first bytes say, "" for anything relook does not read.
std::string format_name(BytesView encoded) {
  const std::string_view text = text_of(encoded);
  if (text.starts_with("\x89PNG\r\n\x1a\n")) return "png";
  if (text.starts_with("\xFF\xD8\xFF")) return "jpeg";
  if (text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")) return "hdr";
  if (text.starts_with("\x76\x2F\x31\x01")) return "openexr";
  if (is_webp(encoded)) return "webp";
  return "";
}

/// The most pixels that so many bytes of a format can hold: deflate shrinks 1032 to 1 at most, and a PNG byte may hold
/// eight pixels; Radiance runs hold 127 values of a channel in two bytes; a JPEG needs a bit for each block of 64
/// pixels. A WebP image of one colour needs no bits for its pixels: 2^24 are always allowed, more need as many bytes as
/// in a PNG.
std::uint64_t most_pixels(std::string_view format, std::uint64_t bytes) {
  constexpr std::uint64_t kAlwaysFine = std::uint64_t{1} << 24;
  if (format == "webp") return bounded_sum(kAlwaysFine, bounded_product(bytes, 8256));
  return bounded_product(bytes, format == "png" ? 8256 : format == "hdr" ? 64 : 1032);
}

std::uint64_t texels_of_pyramid(std::uint32_t width, std::uint32_t height) {
  std::uint64_t texels = std::uint64_t{width} * height;
  while (width > 1 || height > 1) {
    width = std::max(width / 2, 1U);
    height = std::max(height / 2, 1U);
    texels += std::uint64_t{width} * height;
  }
  return texels;
}

/// An image opened in memory, its header checked.
class OpenImage {
 public:
  OpenImage(BytesView encoded, std::string_view file, std::string_view where)
      : file_(file), where_(where), format_(format_name(encoded)) {
    if (is_ktx2(encoded)) fail(std::string(kNoKtxImages));
    if (format_.empty()) fail("it is not a PNG, JPEG, WebP, Radiance HDR or OpenEXR image");
    const BytesView stream = reduced(encoded);
    std::string error;
    image_ = open_image(format_.c_str(), stream, error);
    if (!image_) fail(error);
    spec_ = image_->spec();
    check_header(most_pixels(format_, stream.size()));
    if (format_ == "webp") hold_whole();
  }

  [[nodiscard]] ImageHeader header() const {
    return {static_cast<std::uint32_t>(spec_.width), static_cast<std::uint32_t>(spec_.height),
            spec_.type != TexelType::byte};
  }
  [[nodiscard]] bool is_16_bit() const { return spec_.type == TexelType::word; }

  /// A share of the import memory for the pyramid, once there is room for what the decoder needs beside it. Throws
  /// ResourceError.
  [[nodiscard]] ImportShare share() const {
    const std::string what =
        place() + "the image of " + std::to_string(spec_.width) + "x" + std::to_string(spec_.height) + " pixels";
    ImportShare share(texels_of_pyramid(header().width, header().height) * texel_bytes(), file_, what);
    take_working_memory(block_bytes(), file_, what);
    return share;
  }

  /// Decodes the image, a few rows at a time, to RGBA texels with room for the pyramid's smaller levels. Grey is spread
  /// over RGB, missing alpha is `opaque`. `convert` appends rows of `Stored` texels to the numbers. To be called once.
  template <class Stored, class Number, class Convert>
  [[nodiscard]] std::vector<Number> texels(TexelType type, Stored opaque, const Convert& convert) {
    std::vector<Number> values;
    values.reserve(texels_of_pyramid(header().width, header().height) * 4);
    const auto height = static_cast<std::size_t>(spec_.height), row = static_cast<std::size_t>(spec_.width) * 4;
    const auto tile = static_cast<std::size_t>(std::max(spec_.tile_height, 1));
    const std::size_t step = std::max<std::size_t>(kRowBytes / (row * sizeof(Number)) / tile, 1) * tile;
    std::vector<Stored> rows;
    for (std::size_t y = 0; y < height; y += step) {
      const std::size_t end = std::min(y + step, height);
      rows.assign((end - y) * row, Stored{0});
      read_rows(static_cast<int>(y), static_cast<int>(end), type, opaque, rows);
      convert(rows, values);
    }
    // Given back before any parallel loop, which may decode another image on this thread.
    image_.reset();
    turn_ = {};
    return values;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_, where_, "cannot decode the image: " + what.substr(0, what.find('\n')));
  }

 private:
  [[nodiscard]] std::string place() const { return where_.empty() ? "" : std::string(where_) + ": "; }
  template <class Stored>
  void read_rows(int begin, int end, TexelType type, Stored opaque, std::vector<Stored>& rows) {
    const int channels = color_channels() + (has_alpha() ? 1 : 0);
    if (!image_->read_rows(begin, end, channels, type, rows.data(), 4 * sizeof(Stored))) fail(image_->error());
    for (std::size_t i = 0; i < rows.size(); i += 4) {
      if (!has_alpha()) rows[i + 3] = opaque;
      if (color_channels() > 1) continue;
      if (has_alpha()) rows[i + 3] = rows[i + 1];
      rows[i + 1] = rows[i + 2] = rows[i];
    }
  }
  [[nodiscard]] std::uint64_t texel_bytes() const { return spec_.type == TexelType::byte ? 4 : 16; }
  /// Bytes of the rows that are decoded at once, with all channels that the file has; 0 if no more than kFewBytes.
  [[nodiscard]] std::uint64_t block_bytes() const {
    constexpr int kBlockRows = 256;       // the most that OpenEXR packs together
    constexpr std::uint64_t kCopies = 8;  // numbers a texel in the buffers of the rows
    const int rows = std::min(std::max(format_ == "openexr" ? kBlockRows : 1, spec_.tile_height), spec_.height);
    const std::uint64_t texel = (static_cast<std::uint64_t>(spec_.channels) + kCopies) * sizeof(float);
    const std::uint64_t block =
        bounded_product(static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(spec_.width), texel);
    return block > kFewBytes ? block : 0;
  }
  [[nodiscard]] int color_channels() const { return spec_.channels >= 3 ? 3 : 1; }
  [[nodiscard]] bool has_alpha() const {
    return spec_.channels > color_channels() && spec_.alpha_channel == color_channels();
  }
  /// Leaves out of PNG and JPEG files what makes no pixels; checks the framing of all but Radiance HDR.
  BytesView reduced(BytesView encoded) {
    if (format_ == "openexr") {
      const ExrHeader header = read_exr_header(encoded);
      if (!header.fault.empty()) fail(header.fault);
      if (header.block_bytes > kFewBytes) hold(header.block_bytes);
    }
    if (format_ != "png" && format_ != "jpeg") return encoded;
    ImageStream stream = format_ == "png" ? png_pixels(encoded) : jpeg_pixels(encoded);
    if (!stream.fault.empty()) fail(stream.fault);
    if (stream.held_bytes > 0) hold(stream.held_bytes);
    reduced_ = std::move(stream.bytes);
    return reduced_;
  }
  /// Counts what libwebp holds, which decodes an image as a whole: its pixels, our copy of them, and its planes.
  void hold_whole() {
    constexpr std::uint64_t kPixelBytes = 12;
    const std::uint64_t bytes = std::uint64_t{header().width} * header().height * kPixelBytes;
    if (bytes > kFewBytes) hold(bytes);
  }
  /// Waits until no other image is decoded whose decoder holds much, so that the memory need not be there twice.
  void hold(std::uint64_t bytes) {
    static std::mutex turn;
    turn_ = std::unique_lock(turn);
    take_working_memory(bytes, file_, place() + "the image, while it is decoded,");
  }
  void check_header(std::uint64_t most_encoded_pixels) const {
    if (spec_.width < 1 || spec_.height < 1 || spec_.depth > 1 || spec_.channels < 1)
      fail("it has no pixels, or is no plain image");
    const std::uint64_t count = std::uint64_t{static_cast<std::uint32_t>(spec_.width)} *
                                std::uint64_t{static_cast<std::uint32_t>(spec_.height)};
    if (count > kMostImagePixels)
      fail(std::to_string(spec_.width) + "x" + std::to_string(spec_.height) + " pixels are too many");
    if (count > most_encoded_pixels)
      fail("the file is too short for " + std::to_string(spec_.width) + "x" + std::to_string(spec_.height) + " pixels");
  }

  std::string_view file_, where_;
  std::string format_;
  Bytes reduced_;
  std::unique_lock<std::mutex> turn_;
  std::unique_ptr<ImageReader> image_;
  ImageSpec spec_;
};

/// [65536]: the linear values of 16-bit ones. `color`: these are sRGB-encoded.
std::vector<float> linear_of_16_bit(bool color) {
  std::vector<float> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 65535.0;
    const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    table[i] = static_cast<float>(color ? linear : value);
  }
  return table;
}

std::vector<std::uint8_t> byte_texels(OpenImage& image) {
  return image.texels<std::uint8_t, std::uint8_t>(TexelType::byte, 255, [](const auto& rows, auto& values) {
    values.insert(values.end(), rows.begin(), rows.end());
  });
}

/// Alpha is linear, whatever colours are.
std::vector<float> texels_of_16_bit(OpenImage& image, bool color) {
  const std::vector<float> table = linear_of_16_bit(color);
  return image.texels<std::uint16_t, float>(TexelType::word, 65535, [&](const auto& rows, auto& values) {
    const std::size_t first = values.size();
    values.resize(first + rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      values[first + i] = i % 4 == 3 ? static_cast<float>(rows[i]) / 65535.0F : table[rows[i]];
  });
}

/// The values of an image, at least 0. `negative_share`: of the light of a lat-long image, what was below.
std::vector<float> float_texels(OpenImage& image, float& negative_share) {
  const ImageHeader header = image.header();
  const std::size_t row_values = std::size_t{header.width} * 4;
  double negative = 0, positive = 0;
  std::vector<float> texels =
      image.texels<float, float>(TexelType::real, 1.0F, [&](const auto& rows, auto& values) {
        const std::size_t first = values.size();
        values.resize(first + rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
          values[first + i] = std::isfinite(rows[i]) ? std::clamp(rows[i], 0.0F, kLargestTexel) : 0.0F;
          if (i % 4 == 3 || !std::isfinite(rows[i])) continue;  // coverage
          const double row = static_cast<double>((first + i) / row_values) + 0.5;
          const double solid_angle = std::sin(std::numbers::pi * row / header.height);
          (rows[i] < 0 ? negative : positive) += std::fabs(static_cast<double>(rows[i])) * solid_angle;
        }
      });
  negative_share = negative > 0 ? static_cast<float>(negative / (negative + positive)) : 0.0F;
  return texels;
}

TexturePyramid pyramid_of(OpenImage& image, bool color) {
  const ImageHeader header = image.header();
  if (!header.is_float)
    return build_pyramid(color ? TexelFormat::srgb8 : TexelFormat::linear8, header.width, header.height,
                         byte_texels(image));
  if (image.is_16_bit()) return build_pyramid(header.width, header.height, texels_of_16_bit(image, color));
  float negative_share = 0;
  TexturePyramid pyramid = build_pyramid(header.width, header.height, float_texels(image, negative_share));
  pyramid.negative_share = negative_share;
  return pyramid;
}

}  // namespace

ImageHeader read_image_header(BytesView encoded, std::string_view file, std::string_view where) {
  return OpenImage(encoded, file, where).header();
}

std::shared_ptr<const TexturePyramid> decode_pyramid(BytesView encoded, bool color, std::string_view file,
                                                     std::string_view where) {
  OpenImage image(encoded, file, where);
  ImportShare share = image.share();
  return kept_with(std::move(share), pyramid_of(image, color));
}

std::shared_ptr<const TexturePyramid> PyramidStore::get(const Assets& assets, const std::string& name, bool color,
                                                        std::string_view file, std::string_view where) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = pyramids_.find({name, color}); found != pyramids_.end()) return found->second;
  }
  // Decoded without the lock: two threads may do the same work, neither waits for the other's.
  const auto image = assets.images.find(name);
  if (image == assets.images.end()) throw InputError(file, where, "there is no image \"" + printable(name) + "\"");
  if (!image->second.bytes) throw InputError(file, where, "image \"" + printable(name) + "\" has no data");
  auto pyramid = decode_pyramid(*image->second.bytes, color, file, where);
  const std::lock_guard lock(mutex_);
  return pyramids_.try_emplace({name, color}, std::move(pyramid)).first->second;
}

void PyramidStore::put(const std::string& name, bool color, std::shared_ptr<const TexturePyramid> pyramid) {
  const std::lock_guard lock(mutex_);
  pyramids_[{name, color}] = std::move(pyramid);
}

std::map<std::pair<std::string, bool>, std::shared_ptr<const TexturePyramid>> PyramidStore::all() const {
  const std::lock_guard lock(mutex_);
  return pyramids_;
}

}  // namespace relook
