#include "region/tile_tunnels.h"

#include <algorithm>
#include <cmath>

#include "base/byte_columns.h"

namespace relook {
namespace {

bool is_touched(const TileTunnels& tunnels, std::uint32_t region, const TunnelTest& test) {
  for (std::size_t k = 0; k < tunnels.count(region); ++k)
    if (find_touches(tunnels.tunnel(region, k).sections, test, nullptr)) return true;
  return false;
}

void find_in_cell(const TileTunnels& tunnels, std::uint32_t cell, const TunnelTest& test,
                  std::vector<CellTouches>& touched) {
  CellTouches found;
  found.cell = cell;
  Touches touches;
  for (std::size_t k = 0; k < tunnels.count(cell); ++k) {
    const TileTunnels::View tunnel = tunnels.tunnel(cell, k);
    if (find_touches(tunnel.sections, test, &touches))
      found.tunnels.push_back({tunnel.path, touches});
    else
      found.untouched.push_back(tunnel.path);
  }
  if (!found.tunnels.empty()) touched.push_back(std::move(found));
}

void descend(const TileTunnels& tunnels, std::uint32_t region, const TunnelTest& test,
             std::vector<CellTouches>& touched, RegionCounters& counters) {
  if (tunnels.count(region) == 0) return;  // outside of the image
  ++counters.visited;
  if (tunnels.grid().is_cell(region)) {
    const std::size_t before = touched.size();
    find_in_cell(tunnels, region, test, touched);
    if (touched.size() == before) ++counters.culled;
    return;
  }
  if (!is_touched(tunnels, region, test)) {
    ++counters.culled;
    return;
  }
  for (std::uint32_t child : tunnels.grid().children_of(region)) descend(tunnels, child, test, touched, counters);
}

}  // namespace

Sections& TunnelSet::collecting() {
  if (tunnels_.empty() || !tunnels_.back().path.is_none()) tunnels_.push_back({PathId::none(), {}});
  return tunnels_.back().sections;
}

Sections& TunnelSet::of(PathId path) {
  if (most_ == 1) return collecting();
  const auto own = std::ranges::find(tunnels_, path, &Tunnel::path);
  if (own != tunnels_.end()) return own->sections;
  const bool collects = !tunnels_.empty() && tunnels_.back().path.is_none();
  if (path.is_none() || collects || tunnels_.size() + 1 == most_) return collecting();
  tunnels_.push_back({path, {}});
  return tunnels_.back().sections;
}

std::size_t TileTunnels::bytes() const {
  return first_.capacity() * sizeof(std::uint32_t) + entries_.capacity() * sizeof(Entry) +
         sections_.capacity() * sizeof(TunnelSection);
}

void TileTunnels::append(PathId path, std::span<const TunnelSection> sections) {
  entries_.push_back({path, static_cast<std::uint32_t>(sections_.size()), static_cast<std::uint32_t>(sections.size())});
  sections_.insert(sections_.end(), sections.begin(), sections.end());
}

void TileTunnels::unite(std::uint32_t region, std::size_t most) {
  TunnelSet set(most);
  for (std::uint32_t child : grid_.children_of(region))
    for (std::size_t k = 0; k < count(child); ++k) {
      const View view = tunnel(child, k);
      enclose(set.of(view.path), view.sections);
    }
  for (const Tunnel& united : set.tunnels()) append(united.path, united.sections);
}

Bytes TileTunnels::packed() const {
  ByteColumns columns;
  columns.append(std::vector<std::uint32_t>{grid_.lowest()});
  columns.append(first_);
  columns.append(entries_);
  columns.append(sections_);
  return columns.take();
}

TileTunnels TileTunnels::unpacked(BytesView bytes) {
  ByteColumnsReader columns(bytes);
  TileTunnels tunnels;
  std::vector<std::uint32_t> level;
  columns.next(level);
  if (level.size() == 1) tunnels.grid_ = TileGrid(level.front());
  columns.next(tunnels.first_);
  columns.next(tunnels.entries_);
  columns.next(tunnels.sections_);
  return tunnels;
}

TileTunnels TileTunnels::put_together(const TileGrid& grid, std::size_t most, const TileTunnels* kept,
                                      const std::vector<bool>& is_changed_cell, const TunnelsOfCell& of_cell) {
  TileTunnels next;
  next.grid_ = grid;
  next.first_.reserve(grid.regions() + 1);
  next.first_.push_back(0);
  if (kept != nullptr) {
    next.entries_.reserve(kept->entries_.size());
    next.sections_.reserve(kept->sections_.size());
  }
  std::vector<bool> is_changed(is_changed_cell);
  is_changed.resize(grid.regions());
  for (std::uint32_t region = 0; region < grid.regions(); ++region) {
    if (!grid.is_cell(region))
      for (const std::uint32_t child : grid.children_of(region))
        is_changed[region] = is_changed[region] || is_changed[child];
    if (!is_changed[region]) {
      for (std::size_t k = 0; k < kept->count(region); ++k) {
        const View tunnel = kept->tunnel(region, k);
        next.append(tunnel.path, tunnel.sections);
      }
    } else if (grid.is_cell(region)) {
      for (const Tunnel& tunnel : of_cell(region)) next.append(tunnel.path, tunnel.sections);
    } else {
      next.unite(region, most);
    }
    next.first_.push_back(static_cast<std::uint32_t>(next.entries_.size()));
  }
  next.entries_.shrink_to_fit();
  next.sections_.shrink_to_fit();
  return next;
}

TileTunnels TileTunnels::built(const TileGrid& grid, std::size_t most, const TunnelsOfCell& of_cell) {
  return put_together(grid, most, nullptr, std::vector<bool>(grid.cells(), true), of_cell);
}

TileTunnels TileTunnels::rebuilt(const Leaves& changed, std::size_t most, const TunnelsOfCell& of_cell) const {
  std::vector<bool> is_changed(grid_.cells());
  for (std::uint32_t cell = 0; cell < grid_.cells(); ++cell)
    for_each_leaf_of(grid_, cell,
                     [&](std::uint32_t leaf) { is_changed[cell] = is_changed[cell] || changed.test(leaf); });
  return put_together(grid_, most, this, is_changed, of_cell);
}

void TileTunnels::rename_paths(const std::function<PathId(PathId)>& new_id) {
  for (Entry& entry : entries_)
    if (!entry.path.is_none()) entry.path = new_id(entry.path);
}

TileTunnels::Cells TileTunnels::cells() const {
  Cells cells;
  for (std::uint32_t cell = 0; cell < grid_.cells(); ++cell) {
    cells.counts.push_back(static_cast<std::uint8_t>(count(cell)));
    for (std::size_t k = 0; k < count(cell); ++k) {
      const View view = tunnel(cell, k);
      cells.paths.push_back(view.path);
      cells.section_counts.push_back(static_cast<std::uint32_t>(view.sections.size()));
      cells.sections.insert(cells.sections.end(), view.sections.begin(), view.sections.end());
    }
  }
  return cells;
}

TileTunnels TileTunnels::united(const TileGrid& grid, const Cells& cells, std::size_t most) {
  std::vector<Tunnel> tunnels;
  std::size_t next_tunnel = 0, next_section = 0;
  return built(grid, most, [&](std::uint32_t cell) {
    tunnels.clear();
    for (std::size_t k = 0; k < cells.counts[cell]; ++k, ++next_tunnel) {
      const auto first = cells.sections.begin() + static_cast<std::ptrdiff_t>(next_section);
      const auto sections = cells.section_counts[next_tunnel];
      tunnels.push_back({cells.paths[next_tunnel], Sections(first, first + sections)});
      next_section += sections;
    }
    return std::span<const Tunnel>(tunnels);
  });
}

namespace {

bool is_box(const Box& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return false;
  return box == Box() || (box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z);
}

}  // namespace

std::string broken_tunnel(std::span<const TunnelSection> sections) {
  if (sections.empty() || !sections.front().history.is_eye()) return "a tunnel does not begin at the eye";
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const TunnelSection& section = sections[i];
    if (i > 0 && section.history <= sections[i - 1].history) return "the sections of a tunnel are not in order";
    if (i > 0 && find_section(sections.first(i), section.history.parent()) == nullptr)
      return "a section of a tunnel begins nowhere";
    const bool is_sound = is_box(section.points) && is_box(section.leaving) && section.slack >= 0 &&
                          std::isfinite(section.slack) && (i > 0 || !section.points.isEmpty());
    if (!is_sound) return "the box of a section is none";
  }
  return "";
}

std::vector<std::string> broken_invariants(const TileTunnels::Cells& cells, const TileGrid& grid, std::size_t most,
                                           std::size_t path_classes) {
  if (cells.counts.size() != grid.cells()) return {"there are not as many cells as a tile has"};
  std::size_t tunnels = 0, sections = 0;
  for (const std::uint8_t count : cells.counts) {
    if (count > most) return {"a region has too many tunnels"};
    tunnels += count;
  }
  for (const std::uint32_t count : cells.section_counts) sections += count;
  if (cells.paths.size() != tunnels || cells.section_counts.size() != tunnels || cells.sections.size() != sections)
    return {"there are not as many tunnels or sections as is said"};
  std::size_t tunnel = 0, section = 0;
  for (const std::uint8_t count : cells.counts)
    for (std::size_t k = 0; k < count; ++k, ++tunnel) {
      const PathId path = cells.paths[tunnel];
      const bool may_collect = k + 1 == count;
      if (path.is_none() ? !may_collect : path.index() >= path_classes || most == 1 || k + 1 == most)
        return {"a tunnel is of no path that it can be of"};
      std::string broken = broken_tunnel(std::span(cells.sections).subspan(section, cells.section_counts[tunnel]));
      if (!broken.empty()) return {std::move(broken)};
      section += cells.section_counts[tunnel];
    }
  return {};
}

const Touches* CellTouches::of(PathId path) const {
  for (const OfTunnel& tunnel : tunnels)
    if (tunnel.path == path) return &tunnel.touches;
  if (std::ranges::find(untouched, path) != untouched.end()) return nullptr;
  return !tunnels.empty() && tunnels.back().path.is_none() ? &tunnels.back().touches : nullptr;
}

void find_touched_cells(const TileTunnels& tunnels, const TunnelTest& test, std::vector<CellTouches>& touched,
                        RegionCounters& counters) {
  if (tunnels.grid().regions() > 0) descend(tunnels, tunnels.grid().root(), test, touched, counters);
}

}  // namespace relook
