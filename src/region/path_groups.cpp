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
  /// The number of largest squares with one class in a square of 4, 2 or 1 pixels.
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

void PathGroups::update(const TileTrees& trees, std::uint32_t width, std::uint32_t samples, const Leaves& changed,
                        const ClassOf& class_of) {
  std::vector<bool> is_changed(kRegions);
  const auto height = static_cast<std::uint32_t>(trees.paths.size() / samples / width);
  for (std::uint32_t leaf = 0; leaf < kLeaves; ++leaf) {
    if (!changed.test(leaf)) continue;
    is_changed[leaf] = true;
    clear(leaf);
    const RegionSquare square = square_of(leaf);
    for (std::uint32_t y = square.y; y < std::min(square.y + square.size, height); ++y)
      for (std::uint32_t x = square.x; x < std::min(square.x + square.size, width); ++x)
        for (std::uint32_t k = 0; k < samples; ++k) add(leaf, class_of(trees.paths[(y * width + x) * samples + k]));
  }
  for (std::uint32_t region = kLeaves; region < kRegions; ++region) {
    for (const std::uint32_t child : children_of(region)) is_changed[region] = is_changed[region] || is_changed[child];
    if (!is_changed[region]) continue;
    clear(region);
    unite(region);
  }
}

void PathGroups::clear(std::uint32_t region) {
  counts_[region] = 0;
  std::fill_n(classes_.begin() + static_cast<std::ptrdiff_t>(most_ * region), most_, PathId());
}

void PathGroups::add(std::uint32_t region, PathId path_class) {
  if (counts_[region] == kMany) return;
  const auto known = classes(region);
  if (std::ranges::find(known, path_class) != known.end()) return;
  if (known.size() == most_) {
    clear(region);
    counts_[region] = kMany;
    return;
  }
  classes_[most_ * region + counts_[region]++] = path_class;
}

void PathGroups::unite(std::uint32_t region) {
  for (std::uint32_t child : children_of(region)) {
    if (counts_[child] == kMany) {
      clear(region);
      counts_[region] = kMany;
      return;
    }
    for (PathId path_class : classes(child)) add(region, path_class);
  }
}

GroupPyramid::GroupPyramid(std::span<const PathGroups> tiles, std::size_t columns, std::size_t most)
    : columns_(columns), rows_(tiles.size() / columns), most_(most) {
  std::size_t rows = rows_;
  while (columns > 1 || rows > 1 || levels_.empty()) {
    columns = (columns + 1) / 2;
    rows = (rows + 1) / 2;
    levels_.push_back({columns, rows, std::vector<Classes>(columns * rows)});
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < columns; ++x) unite(tiles, levels_.size() - 1, x, y);
  }
}

void GroupPyramid::unite(std::span<const PathGroups> tiles, std::size_t level, std::size_t x, std::size_t y) {
  const std::size_t columns = level == 0 ? columns_ : levels_[level - 1].columns;
  const std::size_t rows = level == 0 ? rows_ : levels_[level - 1].rows;
  Classes& united = levels_[level].regions[y * levels_[level].columns + x];
  united.emplace();
  for (std::size_t part = 0; part < 4 && united; ++part) {
    const std::size_t px = 2 * x + part % 2, py = 2 * y + part / 2;
    if (px >= columns || py >= rows) continue;
    const std::size_t place = py * columns + px;
    const Classes* const below = level == 0 ? nullptr : &levels_[level - 1].regions[place];
    if (below != nullptr ? !*below : !tiles[place].is_group(kRoot)) {
      united.reset();
      break;
    }
    for (const PathId path_class : below != nullptr ? std::span<const PathId>(**below) : tiles[place].classes(kRoot)) {
      if (std::ranges::find(*united, path_class) != united->end()) continue;
      if (united->size() == most_) {
        united.reset();
        break;
      }
      united->push_back(path_class);
    }
  }
}

void GroupPyramid::update(std::span<const PathGroups> tiles, std::vector<std::size_t> changed) {
  std::size_t columns = columns_;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const std::size_t wide = levels_[level].columns;
    for (std::size_t& place : changed) place = place / columns / 2 * wide + place % columns / 2;
    std::ranges::sort(changed);
    const auto repeated = std::ranges::unique(changed);
    changed.erase(repeated.begin(), repeated.end());
    for (const std::size_t place : changed) unite(tiles, level, place % wide, place / wide);
    columns = wide;
  }
}

void GroupPyramid::descend(std::size_t level, std::size_t x, std::size_t y, std::span<const std::uint8_t> flagged,
                           std::vector<bool>& found, RegionCounters& counters) const {
  ++counters.visited;
  const Classes& classes = levels_[level].regions[y * levels_[level].columns + x];
  if (classes && std::ranges::none_of(*classes, [&](PathId id) { return flagged[id.index()] != 0; })) {
    ++counters.culled;
    return;
  }
  const std::size_t columns = level == 0 ? columns_ : levels_[level - 1].columns;
  const std::size_t rows = level == 0 ? rows_ : levels_[level - 1].rows;
  for (std::size_t part = 0; part < 4; ++part) {
    const std::size_t px = 2 * x + part % 2, py = 2 * y + part / 2;
    if (px >= columns || py >= rows) continue;
    if (level == 0)
      found[py * columns + px] = true;
    else
      descend(level - 1, px, py, flagged, found, counters);
  }
}

std::vector<bool> GroupPyramid::find(std::span<const std::uint8_t> flagged, RegionCounters& counters) const {
  std::vector<bool> found(columns_ * rows_, false);
  if (!found.empty()) descend(levels_.size() - 1, 0, 0, flagged, found, counters);
  return found;
}

std::size_t GroupPyramid::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_)
    for (const Classes& classes : level.regions)
      sum += sizeof classes + (classes ? classes->capacity() * sizeof(PathId) : 0);
  return sum;
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
