// The image quadtree inside one tile (paper 3.1): square regions of pixels, from leaves of kLeafSize pixels to the
// tile. Leaves are the smallest regions that keep anything: the paper drops the two lowest levels, single pixels and
// squares of two (4.1.3).
#pragma once
#include <array>
#include <bitset>
#include <cstdint>

#include "trace/ray_tree.h"

namespace relook {

inline constexpr std::uint32_t kLeafSize = 4;                      // pixels
inline constexpr std::uint32_t kLeafSide = kTileSize / kLeafSize;  // leaves along a tile
inline constexpr std::uint32_t kLeaves = kLeafSide * kLeafSide;
/// Regions of a tile are numbered level by level, leaves first, row by row; the last is the tile itself.
inline constexpr std::uint32_t kRegions = 341;
static_assert(kLeaves == 256 && kLeaves + 64 + 16 + 4 + 1 == kRegions);
inline constexpr std::uint32_t kRoot = kRegions - 1;

using Leaves = std::bitset<kLeaves>;

/// The leaf of a pixel of a tile that is `width` pixels wide; pixels are numbered row by row.
[[nodiscard]] inline std::uint32_t leaf_of(std::uint32_t pixel, std::uint32_t width) {
  return pixel / width / kLeafSize * kLeafSide + pixel % width / kLeafSize;
}
[[nodiscard]] inline bool is_leaf(std::uint32_t region) { return region < kLeaves; }

/// The four regions that a region above the leaves consists of, row by row.
[[nodiscard]] inline std::array<std::uint32_t, 4> children_of(std::uint32_t region) {
  std::uint32_t first = kLeaves, side = kLeafSide / 2, below = 0;
  while (region >= first + side * side) {
    below = first;
    first += side * side;
    side /= 2;
  }
  const std::uint32_t x = (region - first) % side * 2, y = (region - first) / side * 2;
  const std::uint32_t corner = below + y * side * 2 + x;
  return {corner, corner + 1, corner + side * 2, corner + side * 2 + 1};
}

/// Side of a region in pixels, and its upper left corner in the tile.
struct RegionSquare {
  std::uint32_t x = 0, y = 0, size = 0;
};
[[nodiscard]] inline RegionSquare square_of(std::uint32_t region) {
  std::uint32_t first = 0, side = kLeafSide, size = kLeafSize;
  while (region >= first + side * side) {
    first += side * side;
    side /= 2;
    size *= 2;
  }
  return {(region - first) % side * size, (region - first) / side * size, size};
}

/// How a search went through regions: whose contents were looked at, and which were left out with all below them.
struct RegionCounters {
  std::uint64_t visited = 0, culled = 0;
  RegionCounters& operator+=(const RegionCounters& other) {
    visited += other.visited;
    culled += other.culled;
    return *this;
  }
};

}  // namespace relook
