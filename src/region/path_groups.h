// Groups (paper 3.2): regions whose samples have few different ray paths know them, so that one look at each path
// decides about the region. A region with one path is a 1-group, or group; with up to m of them a p-group. PathGroups
// are those of a tile, GroupPyramid has the regions above; after any edit both equal what would be built afresh. Kept
// by ImageRegions (image/regions.h).
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/id.h"
#include "region/quadtree.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// The class of a path, as an id: paths of one class count as the same path (atoms, paper 3.2).
using ClassOf = std::function<PathId(PathId)>;

/// The groups of one tile.
class PathGroups {
 public:
  PathGroups() = default;
  /// `trees`: of a tile `width` pixels wide with `samples` samples a pixel. `most`: paths that a region knows, at least
  /// 1.
  PathGroups(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, std::size_t most,
             const ClassOf& class_of);

  /// Brings the groups up to date after the paths of the leaves `changed` have changed: these, and the regions above.
  void update(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, const Leaves& changed,
              const ClassOf& class_of);

  /// False if the region has more paths than it may know.
  [[nodiscard]] bool is_group(std::uint32_t region) const { return counts_[region] != kMany; }
  /// The path classes of a group, in order of first appearance; none in a region outside of the image.
  [[nodiscard]] std::span<const PathId> classes(std::uint32_t region) const {
    return {classes_.data() + most_ * region, counts_[region]};
  }
  [[nodiscard]] std::size_t bytes() const { return classes_.capacity() * sizeof(PathId) + sizeof(*this); }
  bool operator==(const PathGroups&) const = default;

 private:
  static constexpr std::uint8_t kMany = 0xFF;
  void clear(std::uint32_t region);
  void add(std::uint32_t region, PathId path_class);
  void unite(std::uint32_t region);

  std::size_t most_ = 0;
  std::array<std::uint8_t, kRegions> counts_{};  // kMany: no group
  std::vector<PathId> classes_;                  // [kRegions * most_]
};

/// Largest number of paths that a group may know.
inline constexpr std::size_t kMostGroupPaths = 64;

/// Adds to `leaves` those in which some sample's path class is flagged, or may be. Groups are asked from the tile down:
/// a group without a flagged class is left out, one with flagged classes alone is taken whole. `flagged`: by path
/// class.
void select_leaves(const PathGroups& groups, std::span<const std::uint8_t> flagged, Leaves& leaves,
                   RegionCounters& counters);

/// The groups above the tiles: regions of 2x2 tiles, of 2x2 of these, and so on up to the whole image.
class GroupPyramid {
 public:
  GroupPyramid() = default;
  /// `tiles`: the groups of all tiles, in rows of `columns`; they are not kept, update() takes them again.
  GroupPyramid(std::span<const PathGroups> tiles, std::size_t columns, std::size_t most);
  /// After the groups of some tiles have changed.
  void update(std::span<const PathGroups> tiles, std::vector<std::size_t> changed);
  /// [tiles]: may the tile have a flagged class? Found from the whole image down to the level above the tiles.
  [[nodiscard]] std::vector<bool> find(std::span<const std::uint8_t> flagged, RegionCounters& counters) const;
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const GroupPyramid&) const = default;

 private:
  /// The classes of a region; none: it has more of them than it may know.
  using Classes = std::optional<std::vector<PathId>>;
  struct Level {
    std::size_t columns = 0, rows = 0;
    std::vector<Classes> regions;  // row by row
    bool operator==(const Level&) const = default;
  };
  void unite(std::span<const PathGroups> tiles, std::size_t level, std::size_t x, std::size_t y);
  void descend(std::size_t level, std::size_t x, std::size_t y, std::span<const std::uint8_t> flagged,
               std::vector<bool>& found, RegionCounters& counters) const;

  std::size_t columns_ = 0, rows_ = 0, most_ = 0;
  std::vector<Level> levels_;  // from 2x2 tiles up to the image
};

/// Number of the largest regions of a tile, single pixels included, whose samples all have one path class: the paper's
/// 1-groups.
[[nodiscard]] std::size_t count_groups(const PathGroups& groups, const TileTrees& trees, std::uint32_t width,
                                       std::uint32_t samples, const ClassOf& class_of);

}  // namespace relook
