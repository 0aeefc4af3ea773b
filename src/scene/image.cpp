#include "scene/image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "scene/image_library.h"
#include "scene/image_stream.h"

namespace relook {
namespace {

/// Bound of one decoded image, without its pyramid.
constexpr std::uint64_t kMostDecodedBytes = std::uint64_t{1} << 30;
/// Bound of an HDR texel: sums of many stay finite.
constexpr float kLargestTexel = 1e9F;

/// OpenImageIO's name for what the first bytes say, "" for anything relook does not read.
std::string format_name(BytesView encoded) {
  const std::string_view text = text_of(encoded);
  if (text.starts_with("\x89PNG\r\n\x1a\n")) return "png";
  if (text.starts_with("\xFF\xD8\xFF")) return "jpeg";
  if (text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")) return "hdr";
  if (text.starts_with("\x76\x2F\x31\x01")) return "openexr";
  return "";
}

/// More pixels than this cannot be in one byte of a format: deflate shrinks 1032 to 1 at most, and a PNG byte may hold
/// eight pixels; Radiance runs hold 127 of a channel in two bytes; a JPEG needs a bit for each block of 64.
std::uint64_t most_pixels_per_byte(std::string_view format) {
  if (format == "png") return 8256;
  return format == "hdr" ? 64 : 1032;
}

/// An image opened in memory, its header checked.
class OpenImage {
 public:
  OpenImage(BytesView encoded, std::string_view file, std::string_view where) : file_(file), where_(where) {
    const std::string format = format_name(encoded);
    if (format.empty()) fail("it is not a PNG, JPEG, Radiance HDR or OpenEXR image");
    const BytesView stream = reduced(format, encoded);
    std::string error;
    image_ = open_image(format.c_str(), stream, error);
    if (!image_) fail(error);
    spec_ = image_->spec();
    check_header(stream.size() * most_pixels_per_byte(format));
  }

  [[nodiscard]] ImageHeader header() const {
    return {static_cast<std::uint32_t>(spec_.width), static_cast<std::uint32_t>(spec_.height),
            spec_.type != TexelType::byte};
  }
  [[nodiscard]] bool is_16_bit() const { return spec_.type == TexelType::word; }
  [[nodiscard]] std::size_t texel_count() const {
    return static_cast<std::size_t>(spec_.width) * static_cast<std::size_t>(spec_.height);
  }

  /// RGBA texels of a number type; grey spread over RGB, missing alpha `opaque`.
  template <class Number>
  [[nodiscard]] std::vector<Number> texels(TexelType type, Number opaque) {
    std::vector<Number> values;
    values.reserve(pyramid_texel_bound() * 4);  // build_pyramid() appends the smaller levels
    values.resize(texel_count() * 4, Number{0});
    const int channels = color_channels() + (has_alpha() ? 1 : 0);
    if (!image_->read(channels, type, values.data(), 4 * sizeof(Number))) fail(image_->error());
    for (std::size_t i = 0; i < values.size(); i += 4) {
      if (!has_alpha()) values[i + 3] = opaque;
      if (color_channels() > 1) continue;
      if (has_alpha()) values[i + 3] = values[i + 1];
      values[i + 1] = values[i + 2] = values[i];
    }
    return values;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_, where_, "cannot decode the image: " + what.substr(0, what.find('\n')));
  }

 private:
  [[nodiscard]] std::size_t pyramid_texel_bound() const {
    const auto sides = static_cast<std::size_t>(spec_.width) + static_cast<std::size_t>(spec_.height);
    return texel_count() + texel_count() / 3 + 2 * sides;
  }
  [[nodiscard]] int color_channels() const { return spec_.channels >= 3 ? 3 : 1; }
  [[nodiscard]] bool has_alpha() const {
    return spec_.channels > color_channels() && spec_.alpha_channel == color_channels();
  }
  /// Leaves out of PNG and JPEG files what makes no pixels.
  BytesView reduced(const std::string& format, BytesView encoded) {
    if (format != "png" && format != "jpeg") return encoded;
    ImageStream stream = format == "png" ? png_pixels(encoded) : jpeg_pixels(encoded);
    if (!stream.fault.empty()) fail(stream.fault);
    reduced_ = std::move(stream.bytes);
    return reduced_;
  }
  void check_header(std::uint64_t most_encoded_pixels) const {
    if (spec_.width < 1 || spec_.height < 1 || spec_.depth > 1 || spec_.channels < 1)
      fail("it has no pixels, or is no plain image");
    const std::uint64_t count = std::uint64_t{static_cast<std::uint32_t>(spec_.width)} *
                                std::uint64_t{static_cast<std::uint32_t>(spec_.height)};
    const std::uint64_t texel_bytes = spec_.type == TexelType::byte ? 4 : 16;
    if (count > kMostImagePixels || count * texel_bytes > kMostDecodedBytes)
      fail(std::to_string(spec_.width) + "x" + std::to_string(spec_.height) + " pixels are too many");
    if (count > most_encoded_pixels)
      fail("the file is too short for " + std::to_string(spec_.width) + "x" + std::to_string(spec_.height) + " pixels");
  }

  std::string_view file_, where_;
  Bytes reduced_;
  std::unique_ptr<ImageReader> image_;
  ImageSpec spec_;
};

/// 16-bit values as linear floats; `color`: sRGB-encoded, but for alpha.
std::vector<float> linear_of_16_bit(const std::vector<std::uint16_t>& texels, bool color) {
  std::vector<float> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 65535.0;
    const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    table[i] = static_cast<float>(color ? linear : value);
  }
  std::vector<float> values(texels.size());
  for (std::size_t i = 0; i < texels.size(); ++i)
    values[i] = i % 4 == 3 ? static_cast<float>(texels[i]) / 65535.0F : table[texels[i]];
  return values;
}

}  // namespace

ImageHeader read_image_header(BytesView encoded, std::string_view file, std::string_view where) {
  return OpenImage(encoded, file, where).header();
}

std::shared_ptr<const TexturePyramid> decode_pyramid(BytesView encoded, bool color, std::string_view file,
                                                     std::string_view where) {
  OpenImage image(encoded, file, where);
  const ImageHeader header = image.header();
  if (!header.is_float) {
    const TexelFormat format = color ? TexelFormat::srgb8 : TexelFormat::linear8;
    return std::make_shared<const TexturePyramid>(
        build_pyramid(format, header.width, header.height, image.texels<std::uint8_t>(TexelType::byte, 255)));
  }
  std::vector<float> texels = image.is_16_bit()
                                  ? linear_of_16_bit(image.texels<std::uint16_t>(TexelType::word, 65535), color)
                                  : image.texels<float>(TexelType::real, 1.0F);
  for (float& value : texels) value = std::isfinite(value) ? std::clamp(value, 0.0F, kLargestTexel) : 0.0F;
  return std::make_shared<const TexturePyramid>(build_pyramid(header.width, header.height, std::move(texels)));
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
