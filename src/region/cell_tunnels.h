// The tunnels of a tile in the making (paper 3.4.3): ray trees come in one by one, and each cell encloses its own. Once
// all have come, tunnels() unites the cells upwards. Used by preprocess, which has the trees at hand as it traces
// (image/render.cpp).
#pragma once
#include <vector>

#include "region/tile_tunnels.h"

namespace relook {

class CellTunnels {
 public:
  /// `most`: tunnels of a region.
  CellTunnels(const TileGrid& grid, std::size_t most);
  /// Encloses the tree whose nodes start at `root`: of a sample at `pixel` of a tile that is `width` pixels wide. Cells
  /// come in any order; within a cell, trees come in the order of their samples, so that a region's tunnels do, too.
  void enclose(std::uint32_t pixel, std::uint32_t width, PathId path_class, const RayScene& scene,
               const TreeBlock& block, std::uint32_t root);
  [[nodiscard]] TileTunnels tunnels() const;
  /// Around all trees of the tile.
  [[nodiscard]] Sections around() const;

 private:
  TileGrid grid_;
  std::size_t most_;
  std::vector<TunnelSet> of_cell_;  // [cells]; of a tile without cells, the one around all of it
  std::vector<History> scratch_;
};

/// Around all of a tile's tunnels. Requires: tunnels.grid().regions() > 0.
[[nodiscard]] Sections around(const TileTunnels& tunnels);

}  // namespace relook
