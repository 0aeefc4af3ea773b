#include "region/cell_tunnels.h"

#include <algorithm>

namespace relook {

CellTunnels::CellTunnels(const TileGrid& grid, std::size_t most)
    : grid_(grid), most_(most), of_cell_(std::max(grid.cells(), 1U), TunnelSet(grid.cells() > 0 ? most : 1)) {}

void CellTunnels::enclose(std::uint32_t pixel, std::uint32_t width, PathId path_class, const RayScene& scene,
                          const TreeBlock& block, std::uint32_t root) {
  TunnelSet& cell = of_cell_[grid_.cells() > 0 ? grid_.cell_of(pixel, width) : 0];
  relook::enclose(cell.of(path_class), scene, block, root, scratch_);
}

TileTunnels CellTunnels::tunnels() const {
  return TileTunnels::built(grid_, most_, [this](std::uint32_t cell) { return of_cell_[cell].tunnels(); });
}

Sections CellTunnels::around() const {
  Sections all;
  for (const TunnelSet& cell : of_cell_)
    for (const Tunnel& tunnel : cell.tunnels()) relook::enclose(all, tunnel.sections);
  return all;
}

Sections around(const TileTunnels& tunnels) {
  Sections all;
  const std::uint32_t root = tunnels.grid().root();
  for (std::size_t k = 0; k < tunnels.count(root); ++k) enclose(all, tunnels.tunnel(root, k).sections);
  return all;
}

}  // namespace relook
