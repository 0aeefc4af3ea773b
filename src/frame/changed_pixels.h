// The pixels whose bits a step has changed: a mask for each tile that has any.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"

namespace relook {

/// Bit x of mask[y] stands for the pixel (x, y) of a tile.
using TileMask = std::array<std::uint64_t, kTileSize>;
static_assert(kTileSize == 64);

class ChangedPixels {
 public:
  struct Tile {
    std::uint32_t tile = 0;
    TileMask mask{};
  };

  ChangedPixels() = default;
  /// `pixels`: indices into a frame that is `width` pixels wide.
  ChangedPixels(std::span<const std::uint32_t> pixels, std::uint32_t width);
  /// Requires: the tile has not been added yet.
  void add(std::size_t tile, const TileMask& mask);

  void merge(const ChangedPixels& others);

  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool empty() const { return tiles_.empty(); }
  /// Indices into the pixels of a frame that is `width` pixels wide, increasing.
  [[nodiscard]] std::vector<std::uint32_t> indices(std::uint32_t width) const;

 private:
  std::vector<Tile> tiles_;  // none is empty; in no order
};

/// The pixels whose bits differ. Requires: frames of one size.
[[nodiscard]] ChangedPixels pixels_between(const Frame& before, const Frame& after);

[[nodiscard]] inline bool is_empty(const TileMask& mask) {
  std::uint64_t any = 0;
  for (const std::uint64_t row : mask) any |= row;
  return any == 0;
}

}  // namespace relook
