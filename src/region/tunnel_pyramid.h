// The image quadtree above the tiles: regions of 2x2 tiles, of 2x2 of these, and so on up to the whole image, each with
// one tunnel around those of its parts.
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
  /// After the tunnels of some tiles have changed.
  void update(const std::vector<std::size_t>& tiles, const EncloseTile& enclose_tile);

  /// By tile: may the change touch it? Found from the whole image down; tiles themselves are not looked at.
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
