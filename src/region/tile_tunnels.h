// The tunnels of one tile (paper 3.4): per region up to some number of tunnels, the first ones each for the ray trees
// of one path, the last for all others. Leaves enclose their ray trees; a region above encloses its four parts'
// tunnels.
#pragma once
#include <functional>
#include <span>
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
  [[nodiscard]] bool empty() const { return first_.empty(); }
  [[nodiscard]] std::size_t sections() const { return sections_.size(); }
  [[nodiscard]] std::size_t tunnels() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const TileTunnels&) const = default;

  /// A copy as plain bytes, for this process alone; and back.
  [[nodiscard]] Bytes packed() const;
  [[nodiscard]] static TileTunnels unpacked(BytesView bytes);

  /// The tile's tunnels after the trees of some leaves have changed: `leaf(index)` gives those of a changed leaf, all
  /// else is kept, regions above changed leaves are united anew. `*this` may be empty if all leaves are changed.
  [[nodiscard]] TileTunnels rebuilt(const Leaves& changed, std::size_t most,
                                    const std::function<std::span<const Tunnel>(std::uint32_t)>& leaf) const;

 private:
  struct Entry {
    PathId path;
    std::uint32_t first = 0, sections = 0;  // range of sections_
    bool operator==(const Entry&) const = default;
  };
  void append(PathId path, std::span<const TunnelSection> sections);
  void unite(std::uint32_t region, std::size_t most);

  std::vector<std::uint32_t> first_;  // [kRegions + 1] into entries_; empty: not built
  std::vector<Entry> entries_;
  std::vector<TunnelSection> sections_;
};

/// What a change may touch in one leaf, by tunnel.
struct LeafTouches {
  std::uint32_t leaf = 0;
  struct OfTunnel {
    PathId path;  // none: of all paths without a tunnel of their own
    Touches touches;
  };
  std::vector<OfTunnel> tunnels;
  std::vector<PathId> untouched;  // paths whose own tunnel the change does not touch

  /// What to test of a tree with this path; null: nothing.
  [[nodiscard]] const Touches* of(PathId path) const;
};

/// The leaves of a tile that a change may touch, found from the tile down.
void find_touched_leaves(const TileTunnels& tunnels, const TunnelTest& test, std::vector<LeafTouches>& touched,
                         RegionCounters& counters);

}  // namespace relook
