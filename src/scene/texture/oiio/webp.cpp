#include "scene/texture/oiio/webp.h"

#include <webp/decode.h>

#include <cstring>
#include <vector>

namespace relook {
namespace {

constexpr std::size_t kTexelBytes = 4;

class WebpImage final : public ImageReader {
 public:
  explicit WebpImage(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool open(std::string& error) {
    const VP8StatusCode status = WebPGetFeatures(data(), bytes_.size(), &features_);
    if (status == VP8_STATUS_OK && features_.has_animation == 0) return true;
    error = status == VP8_STATUS_OK ? "an animated WebP image" : "its WebP header is damaged";
    return false;
  }

  [[nodiscard]] ImageSpec spec() const override {
    const bool has_alpha = features_.has_alpha != 0;
    return {features_.width, features_.height, 1, has_alpha ? 4 : 3, has_alpha ? 3 : -1, TexelType::byte, 0};
  }
  [[nodiscard]] bool read_rows(int begin, int end, int channels, TexelType type, void* texels,
                               std::size_t texel_bytes) override {
    if (type != TexelType::byte || !decode()) return false;
    const auto width = static_cast<std::size_t>(features_.width);
    auto* out = static_cast<unsigned char*>(texels);
    for (std::size_t i = static_cast<std::size_t>(begin) * width; i < static_cast<std::size_t>(end) * width; ++i) {
      std::memcpy(out, &decoded_[i * kTexelBytes], static_cast<std::size_t>(channels));
      out += texel_bytes;
    }
    return true;
  }
  [[nodiscard]] std::string error() const override { return "the WebP image is damaged or cut short"; }

 private:
  [[nodiscard]] const std::uint8_t* data() const { return reinterpret_cast<const std::uint8_t*>(bytes_.data()); }
  bool decode() {
    if (!decoded_.empty()) return true;
    const auto row = static_cast<std::size_t>(features_.width) * kTexelBytes;
    decoded_.resize(row * static_cast<std::size_t>(features_.height));
    if (WebPDecodeRGBAInto(data(), bytes_.size(), decoded_.data(), decoded_.size(), static_cast<int>(row)) != nullptr)
      return true;
    decoded_.clear();
    return false;
  }

  std::span<const std::byte> bytes_;
  WebPBitstreamFeatures features_{};
  std::vector<std::uint8_t> decoded_;  // RGBA
};

}  // namespace

std::unique_ptr<ImageReader> open_webp(std::span<const std::byte> bytes, std::string& error) {
  auto image = std::make_unique<WebpImage>(bytes);
  if (!image->open(error)) return nullptr;
  return image;
}

}  // namespace relook
