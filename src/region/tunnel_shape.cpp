#include "region/tunnel_shape.h"

#include <algorithm>

namespace relook {
namespace {

std::uint64_t divided(std::uint64_t length, std::uint64_t by) { return (length + by - 1) / by; }

/// How many regions a tile of this size, in pixels, has from the level of `cells` up to itself.
std::uint64_t regions_of(std::uint32_t width, std::uint32_t height, std::uint32_t cells) {
  std::uint64_t sum = 0;
  for (std::uint32_t level = cells; level <= kTileLevel; ++level)
    sum += divided(width, 1U << level) * divided(height, 1U << level);
  return sum;
}

/// The sizes of all tiles.
struct TileSizes {
  std::uint32_t width, height, columns, rows;
  TileSizes(std::uint32_t w, std::uint32_t h) : width(w), height(h), columns(tiles_along(w)), rows(tiles_along(h)) {}
  [[nodiscard]] std::size_t count() const { return std::size_t{columns} * rows; }
  [[nodiscard]] std::uint64_t regions(std::size_t tile, std::uint32_t cells) const {
    const TileRect rect = tile_rect(tile, width, height);
    return regions_of(rect.width(), rect.height(), cells);
  }
};

}  // namespace

std::uint64_t regions_above_tiles(std::uint32_t width, std::uint32_t height) {
  const TileSizes tiles(width, height);
  std::uint64_t columns = tiles.columns, rows = tiles.rows, sum = 0;
  do {
    columns = divided(columns, 2);
    rows = divided(rows, 2);
    sum += columns * rows;
  } while (columns > 1 || rows > 1);
  return sum;
}

std::vector<std::uint8_t> cell_levels(const TunnelShape& shape, std::uint32_t width, std::uint32_t height) {
  const TileSizes tiles(width, height);
  if (shape.of_region == 0) return {};
  std::vector<std::uint8_t> levels(tiles.count(), static_cast<std::uint8_t>(shape.dropped_levels));
  if (!shape.of_image) return levels;
  const std::uint64_t least = tiles.count() + regions_above_tiles(width, height);
  if (*shape.of_image < least) return {};
  std::uint64_t left = *shape.of_image - least;
  // With one tunnel a region, the tile's is the one around all of it, which `least` counts already.
  const std::uint64_t of_tile = shape.of_region - (shape.of_region == 1 ? 1 : 0);
  const auto price = [&](std::size_t tile, std::uint32_t level) {
    return level == kTileLevel ? of_tile
                               : shape.of_region * (tiles.regions(tile, level) - tiles.regions(tile, level + 1));
  };
  std::uint32_t cells = kTileLevel + 1;  // of all tiles
  std::uint64_t more = 0;                // what one level further down takes
  for (; cells > shape.dropped_levels; --cells) {
    more = 0;
    for (std::size_t tile = 0; tile < tiles.count(); ++tile) more += price(tile, cells - 1);
    if (more > left) break;
    left -= more;
  }
  std::ranges::fill(levels, static_cast<std::uint8_t>(cells));
  if (cells == shape.dropped_levels) return levels;
  // What is left goes to tiles in even steps.
  std::uint64_t passed = 0, spent = 0;
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    passed += price(tile, cells - 1);
    const double earned = static_cast<double>(left) * static_cast<double>(passed) / static_cast<double>(more);
    if (static_cast<double>(spent + price(tile, cells - 1)) > earned) continue;
    spent += price(tile, cells - 1);
    levels[tile] = static_cast<std::uint8_t>(cells - 1);
  }
  return levels;
}

}  // namespace relook
