#include "region/tunnel_pyramid.h"

#include <algorithm>

namespace relook {

TunnelPyramid::TunnelPyramid(std::size_t columns, std::size_t rows, const EncloseTile& enclose_tile)
    : columns_(columns), rows_(rows) {
  while (columns > 1 || rows > 1 || levels_.empty()) {
    columns = (columns + 1) / 2;
    rows = (rows + 1) / 2;
    levels_.push_back({columns, rows, std::vector<Sections>(columns * rows)});
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < columns; ++x) unite(levels_.size() - 1, x, y, enclose_tile);
  }
}

void TunnelPyramid::update(const std::vector<std::size_t>& tiles, const EncloseTile& enclose_tile) {
  std::vector<std::size_t> changed = tiles;  // places in the level below
  std::size_t columns = columns_;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const std::size_t wide = levels_[level].columns;
    for (std::size_t& place : changed) place = place / columns / 2 * wide + place % columns / 2;
    std::ranges::sort(changed);
    const auto repeated = std::ranges::unique(changed);
    changed.erase(repeated.begin(), repeated.end());
    for (std::size_t place : changed) unite(level, place % wide, place / wide, enclose_tile);
    columns = wide;
  }
}

void TunnelPyramid::unite(std::size_t level, std::size_t x, std::size_t y, const EncloseTile& enclose_tile) {
  const std::size_t columns = level == 0 ? columns_ : levels_[level - 1].columns;
  const std::size_t rows = level == 0 ? rows_ : levels_[level - 1].rows;
  Sections united;
  for (std::size_t part = 0; part < 4; ++part) {
    const std::size_t px = 2 * x + part % 2, py = 2 * y + part / 2;
    if (px >= columns || py >= rows) continue;
    if (level == 0)
      enclose_tile(py * columns + px, united);
    else
      enclose(united, levels_[level - 1].tunnels[py * columns + px]);
  }
  levels_[level].tunnels[y * levels_[level].columns + x] = std::move(united);
}

void TunnelPyramid::descend(std::size_t level, std::size_t x, std::size_t y, const TunnelTest& test,
                            std::vector<bool>& tiles, RegionCounters& counters) const {
  ++counters.visited;
  if (!find_touches(levels_[level].tunnels[y * levels_[level].columns + x], test, nullptr)) {
    ++counters.culled;
    return;
  }
  const std::size_t columns = level == 0 ? columns_ : levels_[level - 1].columns;
  const std::size_t rows = level == 0 ? rows_ : levels_[level - 1].rows;
  for (std::size_t part = 0; part < 4; ++part) {
    const std::size_t px = 2 * x + part % 2, py = 2 * y + part / 2;
    if (px >= columns || py >= rows) continue;
    if (level == 0)
      tiles[py * columns + px] = true;
    else
      descend(level - 1, px, py, test, tiles, counters);
  }
}

std::vector<bool> TunnelPyramid::find(const TunnelTest& test, RegionCounters& counters) const {
  std::vector<bool> tiles(columns_ * rows_, false);
  if (!tiles.empty()) descend(levels_.size() - 1, 0, 0, test, tiles, counters);
  return tiles;
}

std::size_t TunnelPyramid::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_)
    for (const Sections& tunnel : level.tunnels) sum += sizeof(tunnel) + tunnel.capacity() * sizeof(TunnelSection);
  return sum;
}

}  // namespace relook
