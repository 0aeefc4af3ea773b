#include "region/tile_tunnels.h"

#include <algorithm>

#include "base/byte_columns.h"

namespace relook {
namespace {

bool is_touched(const TileTunnels& tunnels, std::uint32_t region, const TunnelTest& test) {
  for (std::size_t k = 0; k < tunnels.count(region); ++k)
    if (find_touches(tunnels.tunnel(region, k).sections, test, nullptr)) return true;
  return false;
}

void find_in_leaf(const TileTunnels& tunnels, std::uint32_t leaf, const TunnelTest& test,
                  std::vector<LeafTouches>& touched) {
  LeafTouches found;
  found.leaf = leaf;
  Touches touches;
  for (std::size_t k = 0; k < tunnels.count(leaf); ++k) {
    const TileTunnels::View tunnel = tunnels.tunnel(leaf, k);
    if (find_touches(tunnel.sections, test, &touches))
      found.tunnels.push_back({tunnel.path, touches});
    else
      found.untouched.push_back(tunnel.path);
  }
  if (!found.tunnels.empty()) touched.push_back(std::move(found));
}

void descend(const TileTunnels& tunnels, std::uint32_t region, const TunnelTest& test,
             std::vector<LeafTouches>& touched, RegionCounters& counters) {
  if (tunnels.count(region) == 0) return;  // outside of the image
  ++counters.visited;
  if (is_leaf(region)) {
    const std::size_t before = touched.size();
    find_in_leaf(tunnels, region, test, touched);
    if (touched.size() == before) ++counters.culled;
    return;
  }
  if (!is_touched(tunnels, region, test)) {
    ++counters.culled;
    return;
  }
  for (std::uint32_t child : children_of(region)) descend(tunnels, child, test, touched, counters);
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
  for (std::uint32_t child : children_of(region))
    for (std::size_t k = 0; k < count(child); ++k) {
      const View view = tunnel(child, k);
      enclose(set.of(view.path), view.sections);
    }
  for (const Tunnel& united : set.tunnels()) append(united.path, united.sections);
}

Bytes TileTunnels::packed() const {
  ByteColumns columns;
  columns.append(first_);
  columns.append(entries_);
  columns.append(sections_);
  return columns.take();
}

TileTunnels TileTunnels::unpacked(BytesView bytes) {
  ByteColumnsReader columns(bytes);
  TileTunnels tunnels;
  columns.next(tunnels.first_);
  columns.next(tunnels.entries_);
  columns.next(tunnels.sections_);
  return tunnels;
}

TileTunnels TileTunnels::rebuilt(const Leaves& changed, std::size_t most,
                                 const std::function<std::span<const Tunnel>(std::uint32_t)>& leaf) const {
  TileTunnels next;
  next.entries_.reserve(entries_.size());
  next.sections_.reserve(sections_.size());
  next.first_.push_back(0);
  std::array<bool, kRegions> is_changed{};
  for (std::uint32_t region = 0; region < kRegions; ++region) {
    if (is_leaf(region)) {
      is_changed[region] = changed.test(region);
    } else {
      const auto children = children_of(region);
      is_changed[region] = std::ranges::any_of(children, [&](std::uint32_t child) { return is_changed[child]; });
    }
    if (!is_changed[region]) {
      for (std::size_t k = 0; k < count(region); ++k) next.append(tunnel(region, k).path, tunnel(region, k).sections);
    } else if (is_leaf(region)) {
      for (const Tunnel& tunnel : leaf(region)) next.append(tunnel.path, tunnel.sections);
    } else {
      next.unite(region, most);
    }
    next.first_.push_back(static_cast<std::uint32_t>(next.entries_.size()));
  }
  next.entries_.shrink_to_fit();
  next.sections_.shrink_to_fit();
  return next;
}

const Touches* LeafTouches::of(PathId path) const {
  for (const OfTunnel& tunnel : tunnels)
    if (tunnel.path == path) return &tunnel.touches;
  if (std::ranges::find(untouched, path) != untouched.end()) return nullptr;
  return !tunnels.empty() && tunnels.back().path.is_none() ? &tunnels.back().touches : nullptr;
}

void find_touched_leaves(const TileTunnels& tunnels, const TunnelTest& test, std::vector<LeafTouches>& touched,
                         RegionCounters& counters) {
  descend(tunnels, kRoot, test, touched, counters);
}

}  // namespace relook
