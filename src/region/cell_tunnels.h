// Tunnels of a tile in the making, while its ray trees come by in any order: around each cell's own trees. Regions
// above the cells follow from these once all trees have been enclosed.
#pragma once
#include <vector>

#include "region/tile_tunnels.h"

namespace relook {

class CellTunnels {
 public:
  /// `most`: tunnels of a region.
  CellTunnels(const TileGrid& grid, std::size_t most);
  /// The tree of a sample at a pixel of a tile that is `width` pixels wide, whose nodes start at `root`. Trees of a
  /// cell come in the order of their samples.
  void enclose(std::uint32_t pixel, std::uint32_t width, PathId path_class, const RayScene& scene,
               const TreeBlock& block, std::uint32_t root);
  [[nodiscard]] TileTunnels tunnels() const;
  /// Around all trees of the tile.
  [[nodiscard]] Sections around() const;

 private:
  TileGrid grid_;
  std::size_t most_;
  std::vector<TunnelSet> of_cell_;  // [cells], or the one of the tile if there are none
  std::vector<History> scratch_;
};

/// Around all of a tile's tunnels. Requires: it has regions.
[[nodiscard]] Sections around(const TileTunnels& tunnels);

}  // namespace relook
