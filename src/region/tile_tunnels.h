// The tunnels of one tile (paper 3.4): per region up to some number of tunnels, the first ones each for the ray trees
// of one path, the last for all others. Cells, the lowest regions that have any, enclose their ray trees; a region
// above encloses its four parts' tunnels, so that these follow from the cells'.
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
  PathId path;  // of all its ray trees; none: it collects what has no tunnel of its own
  Sections sections;
};

/// At most `most` tunnels: those for one path in order of first appearance, then the collecting one.
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
  /// Not built.
  [[nodiscard]] bool empty() const { return first_.empty(); }
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  [[nodiscard]] std::size_t sections() const { return sections_.size(); }
  [[nodiscard]] std::size_t tunnels() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const TileTunnels&) const = default;

  /// A copy as plain bytes, for this process alone; and back.
  [[nodiscard]] Bytes packed() const;
  [[nodiscard]] static TileTunnels unpacked(BytesView bytes);

  /// What all of a tile's tunnels follow from.
  struct Cells {
    std::vector<std::uint8_t> counts;           // [cells] of tunnels
    std::vector<PathId> paths;                  // [tunnels], cell by cell
    std::vector<std::uint32_t> section_counts;  // [tunnels]
    Sections sections;                          // tunnel by tunnel
  };
  [[nodiscard]] Cells cells() const;
  /// Requires: broken_invariants(cells, ...) finds nothing. `most`: tunnels of a region.
  [[nodiscard]] static TileTunnels united(const TileGrid& grid, const Cells& cells, std::size_t most);

  /// Gives the paths that tunnels are of other ids; the order of a region's tunnels stays.
  void rename_paths(const std::function<PathId(PathId)>& new_id);

  using TunnelsOfCell = std::function<std::span<const Tunnel>(std::uint32_t cell)>;
  /// `of_cell` is asked for one cell after the other.
  [[nodiscard]] static TileTunnels built(const TileGrid& grid, std::size_t most, const TunnelsOfCell& of_cell);
  /// The tile's tunnels after the trees of some leaves have changed: `of_cell` gives those of cells with changed
  /// leaves, all else is kept, regions above are united anew. Requires: built before, with as many of a region.
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

/// A sentence about sections that cannot be those of a tunnel, or "".
[[nodiscard]] std::string broken_tunnel(std::span<const TunnelSection> sections);
/// Sentences about cells that cannot be those of any tile with so many classes of paths and tunnels a region.
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
