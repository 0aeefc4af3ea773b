// The image quadtree above the tiles (paper 3.4.3): regions of 2x2 tiles, of 2x2 of these, and so on up to the whole
// image, each with one tunnel around those of its parts. Kept by ImageRegions (image/regions.h).
#pragma once
#include <functional>
#include <vector>

#include "region/quadtree.h"
#include "region/tunnel.h"

namespace relook {

class TunnelPyramid {
 public:
  /// Extends a tunnel by all of one tile's.
  using EncloseTile = std::function<void(std::size_t tile, Sections& tunnel)>;

  TunnelPyramid() = default;
  /// `columns`, `rows`: of tiles, numbered row by row.
  TunnelPyramid(std::size_t columns, std::size_t rows, const EncloseTile& enclose_tile);
  /// Brings the regions above `tiles` up to date after the tunnels of these have changed.
  void update(const std::vector<std::size_t>& tiles, const EncloseTile& enclose_tile);

  /// [tiles]: may the change touch the tile? Found from the whole image down to the level above the tiles.
  [[nodiscard]] std::vector<bool> find(const TunnelTest& test, RegionCounters& counters) const;
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const TunnelPyramid&) const = default;

 private:
  struct Level {
    std::size_t columns = 0, rows = 0;
    std::vector<Sections> tunnels;  // row by row
    bool operator==(const Level&) const = default;
  };
  void unite(std::size_t level, std::size_t x, std::size_t y, const EncloseTile& enclose_tile);
  void descend(std::size_t level, std::size_t x, std::size_t y, const TunnelTest& test, std::vector<bool>& tiles,
               RegionCounters& counters) const;

  std::size_t columns_ = 0, rows_ = 0;
  std::vector<Level> levels_;  // from 2x2 tiles up to the image
};

}  // namespace relook
