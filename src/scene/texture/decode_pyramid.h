// Decoding of PNG, JPEG, Radiance HDR, OpenEXR and WebP bytes to mip pyramids: the format is told by the first bytes,
// and size, framing and memory are checked before anything is decoded (by image_library.h). PyramidStore has what a
// scene has decoded so far: filled by the compiler (compile/) and from a cache.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "base/files.h"
#include "scene/mesh.h"
#include "scene/texture/texture.h"

namespace relook {

/// What a message says of an image of KHR_texture_basisu.
inline constexpr std::string_view kNoKtxImages =
    "KTX2 images (KHR_texture_basisu) are not supported; `gltf-transform ktxdecompress IN.glb OUT.glb` makes PNG "
    "images "
    "of them";

/// Largest image accepted, in pixels.
inline constexpr std::uint64_t kMostImagePixels = std::uint64_t{1} << 28;

struct ImageHeader {
  std::uint32_t width = 0, height = 0;
  bool is_float = false;  // HDR, EXR, 16-bit PNG: becomes TexelFormat::float32
};
/// What the header says, without decoding. Throws InputError{file, where, ...} for an unknown format, a damaged header
/// or too many pixels.
[[nodiscard]] ImageHeader read_image_header(BytesView encoded, std::string_view file, std::string_view where);

/// Decodes to a pyramid. `color`: PNG, JPEG and WebP values are sRGB-encoded (base colour, emissive, ...), otherwise
/// linear (normal, roughness, ...); HDR and OpenEXR always are. Throws InputError, ResourceError.
[[nodiscard]] std::shared_ptr<const TexturePyramid> decode_pyramid(BytesView encoded, bool color, std::string_view file,
                                                                   std::string_view where);

/// Decoded pyramids by image name and whether its values are colours, made on first use. Thread-safe.
class PyramidStore {
 public:
  /// The pyramid of `assets.images[name]`. Throws InputError{file, where, ...} when the image does not decode.
  [[nodiscard]] std::shared_ptr<const TexturePyramid> get(const Assets& assets, const std::string& name, bool color,
                                                          std::string_view file, std::string_view where);
  /// Adds a pyramid, or puts it in the place of the one that is there.
  void put(const std::string& name, bool color, std::shared_ptr<const TexturePyramid> pyramid);
  /// All pyramids made so far, for the cache.
  [[nodiscard]] std::map<std::pair<std::string, bool>, std::shared_ptr<const TexturePyramid>> all() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, bool>, std::shared_ptr<const TexturePyramid>> pyramids_;
};

}  // namespace relook
