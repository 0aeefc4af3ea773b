// The image quadtree inside one tile (paper 3.1): TileGrid numbers its square regions, from the cells of some level up
// to the tile of 64x64 pixels. Groups end at leaves of 4x4 pixels; where tunnels end is a choice (paper 4.1.3). Plain
// arithmetic, shared by region/, image/ and replay/.
#pragma once
#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>

#include "base/tiles.h"

namespace relook {

/// The levels of the quadtree within a tile, by the size of their squares: 2^level pixels.
inline constexpr std::uint32_t kTileLevel = 6;
static_assert(kTileSize == 1U << kTileLevel);

/// The upper left corner of a region in the tile, and its side, in pixels.
struct RegionSquare {
  std::uint32_t x = 0, y = 0, size = 0;
};

/// The regions of a tile from some level up. They are numbered level by level, the lowest first, row by row; the last
/// is the tile itself. Regions of the lowest level are called cells.
class TileGrid {
 public:
  /// `lowest`: the level of the cells, at most kTileLevel + 1: then there are no regions.
  constexpr explicit TileGrid(std::uint32_t lowest) : lowest_(lowest) {}
  [[nodiscard]] constexpr std::uint32_t lowest() const { return lowest_; }
  [[nodiscard]] constexpr std::uint32_t side() const { return kTileSize >> lowest_; }  // cells along the tile
  [[nodiscard]] constexpr std::uint32_t cells() const { return side() * side(); }
  [[nodiscard]] constexpr std::uint32_t regions() const { return (4 * cells() - (cells() > 0 ? 1 : 0)) / 3; }
  [[nodiscard]] constexpr std::uint32_t root() const { return regions() - 1; }
  [[nodiscard]] constexpr bool is_cell(std::uint32_t region) const { return region < cells(); }

  /// The four regions that a region above the cells consists of, row by row.
  [[nodiscard]] std::array<std::uint32_t, 4> children_of(std::uint32_t region) const {
    std::uint32_t first = cells(), across = side() / 2, below = 0;
    while (region >= first + across * across) {
      below = first;
      first += across * across;
      across /= 2;
    }
    const std::uint32_t x = (region - first) % across * 2, y = (region - first) / across * 2;
    const std::uint32_t corner = below + y * across * 2 + x;
    return {corner, corner + 1, corner + across * 2, corner + across * 2 + 1};
  }
  [[nodiscard]] RegionSquare square_of(std::uint32_t region) const {
    std::uint32_t first = 0, across = side(), size = 1U << lowest_;
    while (region >= first + across * across) {
      first += across * across;
      across /= 2;
      size *= 2;
    }
    return {(region - first) % across * size, (region - first) / across * size, size};
  }
  /// The cell of a pixel of a tile that is `width` pixels wide; pixels are numbered row by row.
  [[nodiscard]] std::uint32_t cell_of(std::uint32_t pixel, std::uint32_t width) const {
    return (pixel / width >> lowest_) * side() + (pixel % width >> lowest_);
  }
  constexpr bool operator==(const TileGrid&) const = default;

 private:
  std::uint32_t lowest_;
};

/// Leaves: the cells of groups, the smallest regions that a search selects.
inline constexpr TileGrid kLeafGrid(2);
inline constexpr std::uint32_t kLeafSize = 1U << kLeafGrid.lowest();  // pixels
inline constexpr std::uint32_t kLeafSide = kLeafGrid.side();          // leaves along a tile
inline constexpr std::uint32_t kLeaves = kLeafGrid.cells();
inline constexpr std::uint32_t kRegions = kLeafGrid.regions();
static_assert(kLeaves == 256 && kLeaves + 64 + 16 + 4 + 1 == kRegions);
inline constexpr std::uint32_t kRoot = kLeafGrid.root();

using Leaves = std::bitset<kLeaves>;

/// The leaf of a pixel of a tile that is `width` pixels wide; pixels are numbered row by row.
[[nodiscard]] inline std::uint32_t leaf_of(std::uint32_t pixel, std::uint32_t width) {
  return kLeafGrid.cell_of(pixel, width);
}
[[nodiscard]] inline bool is_leaf(std::uint32_t region) { return kLeafGrid.is_cell(region); }
[[nodiscard]] inline std::array<std::uint32_t, 4> children_of(std::uint32_t region) {
  return kLeafGrid.children_of(region);
}
[[nodiscard]] inline RegionSquare square_of(std::uint32_t region) { return kLeafGrid.square_of(region); }

/// Calls visit(leaf) for the leaves that have pixels of a cell of `grid`.
template <class Visit>
void for_each_leaf_of(const TileGrid& grid, std::uint32_t cell, const Visit& visit) {
  const RegionSquare square = grid.square_of(cell);
  for (std::uint32_t y = square.y / kLeafSize; y * kLeafSize < square.y + square.size; ++y)
    for (std::uint32_t x = square.x / kLeafSize; x * kLeafSize < square.x + square.size; ++x) visit(y * kLeafSide + x);
}

/// Calls visit(sample, leaf) for the samples of some leaves of a tile, in increasing order. `samples`: of a pixel.
template <class Visit>
void for_each_sample(const TileRect& rect, std::uint32_t samples, const Leaves& leaves, const Visit& visit) {
  const std::uint32_t width = rect.width();
  for (std::uint32_t y = 0; y < rect.height(); ++y)
    for (std::uint32_t column = 0; column * kLeafSize < width; ++column) {
      const std::uint32_t leaf = y / kLeafSize * kLeafSide + column;
      if (!leaves.test(leaf)) continue;
      const std::uint32_t x0 = column * kLeafSize, x1 = std::min(x0 + kLeafSize, width);
      const std::uint32_t first = (y * width + x0) * samples, last = (y * width + x1) * samples;
      for (std::uint32_t sample = first; sample < last; ++sample) visit(sample, leaf);
    }
}

/// How a search went down the quadtree: how many regions were asked, and how many of these were left out with all below
/// them.
struct RegionCounters {
  std::uint64_t visited = 0, culled = 0;
  RegionCounters& operator+=(const RegionCounters& other) {
    visited += other.visited;
    culled += other.culled;
    return *this;
  }
};

}  // namespace relook
