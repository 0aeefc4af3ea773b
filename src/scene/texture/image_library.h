// The image library behind an interface: OpenImageIO takes 0.35 s and 134 MB to load, so it stands in a module of its
// own (oiio/) that is loaded when the first image is decoded, by image.cpp alone. A replay from a cache decodes none.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace relook {

enum class TexelType : std::uint8_t { byte, word, real };  // unsigned 8 and 16 bits, float

struct ImageSpec {
  int width = 0, height = 0, depth = 0, channels = 0;
  int alpha_channel = -1;            // none: -1
  TexelType type = TexelType::real;  // as stored; anything else than byte and word reads as real
  int tile_height = 0;               // of an image in tiles: rows are read in multiples of it
};

/// An image in memory whose header has been read.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  [[nodiscard]] virtual ImageSpec spec() const = 0;
  /// Decodes the first `channels` channels of rows [begin, end) to `texels`, `texel_bytes` from one texel to the next.
  /// Rows are asked for from the top, in steps of whole tiles. False: see error().
  [[nodiscard]] virtual bool read_rows(int begin, int end, int channels, TexelType type, void* texels,
                                       std::size_t texel_bytes) = 0;
  [[nodiscard]] virtual std::string error() const = 0;
};

/// What the module exports, as relook_open_image: opens an image of the named format ("png", "jpeg", "hdr", "openexr",
/// "webp"). `bytes` outlives the reader. Null: `error` says why.
using OpenImageReader = std::unique_ptr<ImageReader>(const char* format, std::span<const std::byte> bytes,
                                                     std::string& error);

/// Keeps the module's libraries from starting threads of their own: images are decoded side by side already, and where
/// memory is short such threads would end the program. To be called before any thread starts.
void limit_image_library_threads();

/// As OpenImageReader. Loads the module on first use: from the program's folder or, installed, ../lib/relook. Throws
/// Error if it is missing.
[[nodiscard]] std::unique_ptr<ImageReader> open_image(const char* format, std::span<const std::byte> bytes,
                                                      std::string& error);

}  // namespace relook
