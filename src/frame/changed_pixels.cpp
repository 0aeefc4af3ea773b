#include "frame/changed_pixels.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "base/error.h"

namespace relook {

ChangedPixels::ChangedPixels(std::span<const std::uint32_t> pixels, std::uint32_t width) {
  std::map<std::size_t, TileMask> masks;
  for (const std::uint32_t pixel : pixels) {
    const std::uint32_t x = pixel % width, y = pixel / width;
    masks[tile_of(x, y, width)][y % kTileSize] |= std::uint64_t{1} << (x % kTileSize);
  }
  for (const auto& [tile, mask] : masks) add(tile, mask);
}

void ChangedPixels::add(std::size_t tile, const TileMask& mask) {
  if (!is_empty(mask)) tiles_.push_back({static_cast<std::uint32_t>(tile), mask});
}

void ChangedPixels::merge(const ChangedPixels& others) {
  std::map<std::uint32_t, TileMask> masks;
  for (const Tile& tile : tiles_) masks[tile.tile] = tile.mask;
  for (const Tile& tile : others.tiles_)
    for (std::size_t y = 0; y < tile.mask.size(); ++y) masks[tile.tile][y] |= tile.mask[y];
  tiles_.clear();
  for (const auto& [tile, mask] : masks) add(tile, mask);
}

std::size_t ChangedPixels::size() const {
  std::size_t count = 0;
  for (const Tile& tile : tiles_)
    for (const std::uint64_t row : tile.mask) count += static_cast<std::size_t>(std::popcount(row));
  return count;
}

std::vector<std::uint32_t> ChangedPixels::indices(std::uint32_t width) const {
  std::vector<std::uint32_t> pixels;
  const std::uint32_t across = tiles_along(width);
  for (const Tile& tile : tiles_) {
    const std::uint32_t x0 = tile.tile % across * kTileSize, y0 = tile.tile / across * kTileSize;
    for (std::uint32_t y = 0; y < kTileSize; ++y)
      for (std::uint64_t row = tile.mask[y]; row != 0; row &= row - 1)
        pixels.push_back((y0 + y) * width + x0 + static_cast<std::uint32_t>(std::countr_zero(row)));
  }
  std::ranges::sort(pixels);
  return pixels;
}

ChangedPixels pixels_between(const Frame& before, const Frame& after) {
  require(before.pixels.size() == after.pixels.size() && before.width == after.width, "frames of one size");
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < after.pixels.size(); ++i)
    if (std::memcmp(&before.pixels[i], &after.pixels[i], sizeof(Rgba)) != 0)
      pixels.push_back(static_cast<std::uint32_t>(i));
  return ChangedPixels(pixels, after.width);
}

}  // namespace relook
