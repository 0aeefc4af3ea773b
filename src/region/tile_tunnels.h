// The tunnels of one tile (paper 3.4): a region has up to some number of tunnels, the first ones each for the ray trees
// of one path, the last for all others. Cells, the lowest regions that have any, enclose their ray trees; a region
// above encloses its four parts' tunnels, so that these follow from the cells'. After any edit they equal those built
// afresh. Kept by ImageRegions (image/regions.h), stored by the cache (cache/tunnel_parts.h).
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/id.h"
#include "region/quadtree.h"
#include "region/tunnel.h"

namespace relook {

/// A tunnel of a region.
struct Tunnel {
  PathId path;  // that all its ray trees have; none: it collects the trees of all paths without a tunnel of their own
  Sections sections;
};

/// The tunnels of one region in the making, at most `most`: those for one path in order of first appearance, then the
/// collecting one.
class TunnelSet {
 public:
  explicit TunnelSet(std::size_t most) : most_(most) {}
  /// The tunnel for a tree with this path.
  Sections& of(PathId path);
  [[nodiscard]] std::span<const Tunnel> tunnels() const { return tunnels_; }
  void clear() { tunnels_.clear(); }

 private:
  Sections& collecting();
  std::size_t most_;
  std::vector<Tunnel> tunnels_;  // a collecting one stands last
};

class TileTunnels {
 public:
  TileTunnels() = default;

  struct View {
    PathId path;
    std::span<const TunnelSection> sections;
  };
  [[nodiscard]] std::size_t count(std::uint32_t region) const { return first_[region + 1] - first_[region]; }
  [[nodiscard]] View tunnel(std::uint32_t region, std::size_t k) const {
    const Entry& entry = entries_[first_[region] + k];
    return {entry.path, {sections_.data() + entry.first, entry.sections}};
  }
  /// True if none have been built.
  [[nodiscard]] bool empty() const { return first_.empty(); }
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  [[nodiscard]] std::size_t sections() const { return sections_.size(); }
  [[nodiscard]] std::size_t tunnels() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const TileTunnels&) const = default;

  /// The tunnels as bytes and back: for the spill file of this process alone, since the bytes are not checked.
  [[nodiscard]] Bytes packed() const;
  [[nodiscard]] static TileTunnels unpacked(BytesView bytes);

  /// The tunnels of the cells as columns. All of a tile's tunnels follow from them, so that a cache stores nothing
  /// else.
  struct Cells {
    std::vector<std::uint8_t> counts;           // [cells] of tunnels
    std::vector<PathId> paths;                  // [tunnels], cell by cell
    std::vector<std::uint32_t> section_counts;  // [tunnels]
    Sections sections;                          // tunnel by tunnel
  };
  [[nodiscard]] Cells cells() const;
  /// Cells and all regions above. `most`: tunnels of a region. Requires: broken_invariants(cells, ...) finds nothing.
  [[nodiscard]] static TileTunnels united(const TileGrid& grid, const Cells& cells, std::size_t most);

  /// Renumbers the paths of the tunnels; the order of a region's tunnels stays.
  void rename_paths(const std::function<PathId(PathId)>& new_id);

  using TunnelsOfCell = std::function<std::span<const Tunnel>(std::uint32_t cell)>;
  /// Builds a tile's tunnels from those of its cells. `of_cell` is asked for one cell after the other; what it returns
  /// is copied.
  [[nodiscard]] static TileTunnels built(const TileGrid& grid, std::size_t most, const TunnelsOfCell& of_cell);
  /// The tile's tunnels after the trees of the leaves `changed` have changed: `of_cell` gives those of cells with
  /// changed leaves, regions above these are united anew, all else is kept. Requires: !empty(), and the same `most` as
  /// before.
  [[nodiscard]] TileTunnels rebuilt(const Leaves& changed, std::size_t most, const TunnelsOfCell& of_cell) const;

 private:
  struct Entry {
    PathId path;
    std::uint32_t first = 0, sections = 0;  // range of sections_
    bool operator==(const Entry&) const = default;
  };
  /// `kept`: null, or tunnels whose regions without a changed cell are taken over.
  static TileTunnels put_together(const TileGrid& grid, std::size_t most, const TileTunnels* kept,
                                  const std::vector<bool>& is_changed_cell, const TunnelsOfCell& of_cell);
  void append(PathId path, std::span<const TunnelSection> sections);
  void unite(std::uint32_t region, std::size_t most);

  TileGrid grid_ = kLeafGrid;
  std::vector<std::uint32_t> first_;  // [regions + 1] into entries_; empty: not built
  std::vector<Entry> entries_;
  std::vector<TunnelSection> sections_;
};

/// What is wrong with sections that cannot be those of a tunnel, as a sentence, or "".
[[nodiscard]] std::string broken_tunnel(std::span<const TunnelSection> sections);
/// What is wrong with cells that cannot be those of a tile with `most` tunnels a region and paths below `path_classes`:
/// the first finding as a sentence, or nothing.
[[nodiscard]] std::vector<std::string> broken_invariants(const TileTunnels::Cells& cells, const TileGrid& grid,
                                                         std::size_t most, std::size_t path_classes);

/// What a change may touch in one cell, by tunnel.
struct CellTouches {
  std::uint32_t cell = 0;
  struct OfTunnel {
    PathId path;  // none: of all paths without a tunnel of their own
    Touches touches;
  };
  std::vector<OfTunnel> tunnels;
  std::vector<PathId> untouched;  // paths whose own tunnel the change does not touch

  /// What to test of a tree with this path; null: nothing.
  [[nodiscard]] const Touches* of(PathId path) const;
};

/// The cells of a tile that a change may touch, found from the tile down.
void find_touched_cells(const TileTunnels& tunnels, const TunnelTest& test, std::vector<CellTouches>& touched,
                        RegionCounters& counters);

}  // namespace relook
