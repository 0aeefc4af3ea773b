// The tiles of an image, the unit of work, of storage and of EXR files: squares, row by row, the last ones clipped.
// Their pixels are numbered row by row inside the tile; their samples pixel by pixel, all samples of a pixel together.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace relook {

/// Side of a tile in pixels.
inline constexpr std::uint32_t kTileSize = 64;

/// A tile's pixels: [x0, x1) x [y0, y1).
struct TileRect {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] constexpr std::uint32_t width() const { return x1 - x0; }
  [[nodiscard]] constexpr std::uint32_t height() const { return y1 - y0; }
  [[nodiscard]] constexpr std::uint32_t pixels() const { return width() * height(); }
};

/// Tiles of a row, or of a column, of an image that is `size` pixels wide, or high.
[[nodiscard]] constexpr std::uint32_t tiles_along(std::uint32_t size) { return (size + kTileSize - 1) / kTileSize; }

[[nodiscard]] constexpr std::size_t tile_count(std::uint32_t width, std::uint32_t height) {
  return std::size_t{tiles_along(width)} * tiles_along(height);
}

[[nodiscard]] constexpr TileRect tile_rect(std::size_t tile, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t columns = tiles_along(width);
  const auto x = static_cast<std::uint32_t>(tile % columns) * kTileSize;
  const auto y = static_cast<std::uint32_t>(tile / columns) * kTileSize;
  return {x, y, std::min(x + kTileSize, width), std::min(y + kTileSize, height)};
}

/// The tile of a pixel of an image that is `width` pixels wide.
[[nodiscard]] constexpr std::size_t tile_of(std::uint32_t x, std::uint32_t y, std::uint32_t width) {
  return std::size_t{y / kTileSize} * tiles_along(width) + x / kTileSize;
}

/// Number of samples of a tile. `samples`: of a pixel.
[[nodiscard]] constexpr std::uint32_t sample_count(const TileRect& rect, std::uint32_t samples) {
  return rect.pixels() * samples;
}

}  // namespace relook
