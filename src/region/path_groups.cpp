#include "region/path_groups.h"

#include <algorithm>

#include "base/error.h"

namespace relook {
namespace {

void add_leaves_of(std::uint32_t region, Leaves& leaves) {
  const RegionSquare square = square_of(region);
  for (std::uint32_t y = square.y / kLeafSize; y < (square.y + square.size) / kLeafSize; ++y)
    for (std::uint32_t x = square.x / kLeafSize; x < (square.x + square.size) / kLeafSize; ++x)
      leaves.set(y * kLeafSide + x);
}

void descend(const PathGroups& groups, std::uint32_t region, std::span<const std::uint8_t> flagged, Leaves& leaves,
             RegionCounters& counters) {
  ++counters.visited;
  if (!groups.is_group(region)) {
    if (is_leaf(region)) {
      leaves.set(region);
      return;
    }
    for (std::uint32_t child : children_of(region)) descend(groups, child, flagged, leaves, counters);
    return;
  }
  const auto classes = groups.classes(region);
  const auto hits = static_cast<std::size_t>(
      std::ranges::count_if(classes, [&](PathId path_class) { return flagged[path_class.index()] != 0; }));
  if (hits == 0) {
    ++counters.culled;
    return;
  }
  if (hits == classes.size() || is_leaf(region)) {
    add_leaves_of(region, leaves);
    return;
  }
  for (std::uint32_t child : children_of(region)) descend(groups, child, flagged, leaves, counters);
}

/// The path classes of a tile's pixels.
class PixelClasses {
 public:
  PixelClasses(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, const ClassOf& class_of)
      : trees_(trees), width_(width), samples_(samples), class_of_(class_of) {}

  [[nodiscard]] bool is_inside(std::uint32_t x, std::uint32_t y) const {
    return x < width_ && (std::size_t{y} * width_ + x) * samples_ < trees_.paths.size();
  }
  [[nodiscard]] bool has_one(std::uint32_t x0, std::uint32_t y0, std::uint32_t size) const {
    PathId only;
    for (std::uint32_t y = y0; y < y0 + size; ++y)
      for (std::uint32_t x = x0; x < x0 + size && is_inside(x, y); ++x)
        for (std::uint32_t k = 0; k < samples_; ++k) {
          const PathId path = trees_.paths[(std::size_t{y} * width_ + x) * samples_ + k];
          const PathId own = class_of_(path);
          if (!only.is_none() && only != own) return false;
          only = own;
        }
    return true;
  }
  /// Largest uniform squares in a square of 4, 2 or 1 pixels.
  [[nodiscard]] std::size_t count(std::uint32_t x, std::uint32_t y, std::uint32_t size) const {
    if (!is_inside(x, y)) return 0;
    if (has_one(x, y, size)) return 1;
    if (size == 1) return 0;
    const std::uint32_t half = size / 2;
    return count(x, y, half) + count(x + half, y, half) + count(x, y + half, half) + count(x + half, y + half, half);
  }

 private:
  const TileTrees& trees_;
  std::uint32_t width_, samples_;
  ClassOf class_of_;
};

std::size_t count_below(const PathGroups& groups, std::uint32_t region, const PixelClasses& pixels) {
  if (groups.is_group(region) && groups.classes(region).size() <= 1) return groups.classes(region).size();
  if (is_leaf(region)) {
    const RegionSquare square = square_of(region);
    return pixels.count(square.x, square.y, square.size);
  }
  std::size_t sum = 0;
  for (std::uint32_t child : children_of(region)) sum += count_below(groups, child, pixels);
  return sum;
}

}  // namespace

PathGroups::PathGroups(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, std::size_t most,
                       const ClassOf& class_of)
    : most_(most), classes_(most * kRegions) {
  require(most > 0 && most <= kMostGroupPaths, "a group knows 1 to 64 paths");
  std::uint32_t pixel = 0, k = 0;
  PathId last;
  std::uint32_t last_leaf = kRegions;
  for (PathId path : trees.paths) {
    const std::uint32_t leaf = leaf_of(pixel, width);
    if (path != last || leaf != last_leaf) add(leaf, class_of(path));
    last = path;
    last_leaf = leaf;
    if (++k < samples) continue;
    k = 0;
    ++pixel;
  }
  for (std::uint32_t region = kLeaves; region < kRegions; ++region) unite(region);
}

void PathGroups::add(std::uint32_t region, PathId path_class) {
  if (counts_[region] == kMany) return;
  const auto known = classes(region);
  if (std::ranges::find(known, path_class) != known.end()) return;
  if (known.size() == most_) {
    counts_[region] = kMany;
    std::fill_n(classes_.begin() + static_cast<std::ptrdiff_t>(most_ * region), most_, PathId());
    return;
  }
  classes_[most_ * region + counts_[region]++] = path_class;
}

void PathGroups::unite(std::uint32_t region) {
  for (std::uint32_t child : children_of(region)) {
    if (counts_[child] == kMany) {
      counts_[region] = kMany;
      std::fill_n(classes_.begin() + static_cast<std::ptrdiff_t>(most_ * region), most_, PathId());
      return;
    }
    for (PathId path_class : classes(child)) add(region, path_class);
  }
}

void select_leaves(const PathGroups& groups, std::span<const std::uint8_t> flagged, Leaves& leaves,
                   RegionCounters& counters) {
  descend(groups, kRoot, flagged, leaves, counters);
}

std::size_t count_groups(const PathGroups& groups, const TileTrees& trees, std::uint32_t width, std::uint32_t samples,
                         const ClassOf& class_of) {
  return count_below(groups, kRoot, PixelClasses(trees, width, samples, class_of));
}

}  // namespace relook
