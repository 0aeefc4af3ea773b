// The module behind scene/texture/image_library.h: decoding through OpenImageIO, which this file alone sees.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "scene/texture/image_library.h"
#include "scene/texture/oiio/webp.h"

namespace {

/// A file in memory. OpenImageIO 2.4's own reads outside of the memory when a file asks for a place beyond its end.
class Memory final : public OIIO::Filesystem::IOMemReader {
 public:
  using IOMemReader::IOMemReader;
  std::size_t read(void* out, std::size_t count) override {
    const std::size_t done = pread(out, count, m_pos);
    m_pos += static_cast<std::int64_t>(done);
    return done;
  }
  std::size_t pread(void* out, std::size_t count, std::int64_t offset) override {
    if (offset < 0 || static_cast<std::uint64_t>(offset) >= size()) return 0;
    const std::size_t here = std::min(count, size() - static_cast<std::size_t>(offset));
    std::memcpy(out, buffer().data() + offset, here);
    return here;
  }
};

class OiioImage final : public relook::ImageReader {
 public:
  explicit OiioImage(std::span<const std::byte> bytes) : memory_(bytes.data(), bytes.size()) {}
  ~OiioImage() override {
    if (input_) input_->close();
  }

  bool open(const std::string& format, std::string& error) {
    input_ = OIIO::ImageInput::create(format);
    if (!input_) {
      error = "this OpenImageIO cannot read " + format;
      return false;
    }
    OIIO::ImageSpec options;
    options.attribute("oiio:UnassociatedAlpha", 1);
    input_->set_ioproxy(&memory_);
    if (input_->open("memory." + format, spec_, options)) return true;
    error = input_->geterror();
    return false;
  }

  [[nodiscard]] relook::ImageSpec spec() const override {
    const relook::TexelType type = spec_.format == OIIO::TypeDesc::UINT8    ? relook::TexelType::byte
                                   : spec_.format == OIIO::TypeDesc::UINT16 ? relook::TexelType::word
                                                                            : relook::TexelType::real;
    return {spec_.width,
            spec_.height,
            spec_.depth,
            spec_.nchannels,
            spec_.alpha_channel,
            type,
            spec_.tile_width > 0 ? spec_.tile_height : 0};
  }
  [[nodiscard]] bool read_rows(int begin, int end, int channels, relook::TexelType type, void* texels,
                               std::size_t texel_bytes) override {
    const OIIO::TypeDesc format = type == relook::TexelType::byte   ? OIIO::TypeDesc::UINT8
                                  : type == relook::TexelType::word ? OIIO::TypeDesc::UINT16
                                                                    : OIIO::TypeDesc::FLOAT;
    const auto stride = static_cast<OIIO::stride_t>(texel_bytes);
    const int first = spec_.y + begin, last = spec_.y + end;
    if (spec_.tile_width == 0)
      return input_->read_scanlines(0, 0, first, last, spec_.z, 0, channels, format, texels, stride);
    return input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, first, last, spec_.z, spec_.z + 1, 0, channels,
                              format, texels, stride);
  }
  [[nodiscard]] std::string error() const override { return input_->geterror(); }

 private:
  Memory memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
};

}  // namespace

extern "C" std::unique_ptr<relook::ImageReader> relook_open_image(const char* format, std::span<const std::byte> bytes,
                                                                  std::string& error) {
  if (format == std::string_view("webp")) return relook::open_webp(bytes, error);
  auto image = std::make_unique<OiioImage>(bytes);
  if (!image->open(format, error)) return nullptr;
  return image;
}
