// Groups (paper 3.2): regions whose samples have few different ray paths know them, so that one look at each path
// decides about the region. A region with one path is a 1-group, or group; with up to m of them a p-group.
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

/// By path, what counts as the same path: PathId(class).
using ClassOf = std::function<PathId(PathId)>;

/// The groups of one tile.
class PathGroups {
 public:
  PathGroups() = default;
  /// `trees`: of a tile `width` pixels wide with `samples` samples a pixel. `most`: paths that a region knows, at least
  /// 1.
  PathGroups(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, std::size_t most,
             const ClassOf& class_of);

  /// After the paths of some leaves have changed: these are looked at again, and the regions above them.
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

/// Adds the leaves in which some path class is flagged, or may be: going down from the tile, a group is decided by its
/// classes. `flagged`: by path class.
void select_leaves(const PathGroups& groups, std::span<const std::uint8_t> flagged, Leaves& leaves,
                   RegionCounters& counters);

/// The groups above the tiles: regions of 2x2 tiles, of 2x2 of these, and so on up to the whole image.
class GroupPyramid {
 public:
  GroupPyramid() = default;
  /// `tiles`: groups of tiles in rows of `columns`; outlives it, its elements may change.
  GroupPyramid(std::span<const PathGroups> tiles, std::size_t columns, std::size_t most);
  /// After the groups of some tiles have changed.
  void update(std::span<const PathGroups> tiles, std::vector<std::size_t> changed);
  /// By tile: may it have a flagged class? Found from the whole image down; tiles themselves are not looked at.
  [[nodiscard]] std::vector<bool> find(std::span<const std::uint8_t> flagged, RegionCounters& counters) const;
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const GroupPyramid&) const = default;

 private:
  /// Of a region; nothing: it has more classes than it may know.
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
