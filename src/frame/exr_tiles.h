// OpenEXR files of tiles, 64x64, ZIP, scene-linear Rec.709, laid out from tiles that are compressed already: our own
// compression, because tiles are kept from step to step, and OpenEXR's core for the layout. Encoded to memory, because
// OpenEXR's own writer loses the last write error.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "frame/deflate.h"

namespace relook {

enum class PixelFormat : std::uint8_t { half, float32 };

struct ExrChannel {
  std::string name;
  PixelFormat format = PixelFormat::float32;
};
/// String attributes, in the order of the file.
using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

/// A value as it comes back from a file.
[[nodiscard]] float stored_value(float value, PixelFormat format);

/// Compresses tiles; one per thread.
class TileCompressor {
 public:
  /// OpenEXR's ZIP; `raw` itself when that is not smaller, which readers tell by the size. `raw`: row by row, within a
  /// row channel by channel in the order of their names' bytes.
  [[nodiscard]] Bytes zip(std::span<const unsigned char> raw);

 private:
  Deflater deflater_;
  std::vector<unsigned char> split_;
};

/// The bytes of a file. `tiles`: compressed, row by row.
[[nodiscard]] Bytes tiled_exr(std::uint32_t width, std::uint32_t height, std::span<const ExrChannel> channels,
                              const ExrAttributes& attributes, std::span<const Bytes> tiles);

}  // namespace relook
