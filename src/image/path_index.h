// Facts about interned paths that searches need: which paths name an object, and how many segments a path stands for.
#pragma once
#include <span>
#include <vector>

#include "trace/tree/path_cursor.h"

namespace relook {

class PathIndex {
 public:
  /// Takes in the paths that the table has got since the last call. `layout`: of all of them.
  void extend(const PathTable& paths, const PathLayout& layout);
  /// Forgets all: the table has been numbered afresh.
  void clear();

  /// The paths that name this object (see for_each_object()), increasing.
  [[nodiscard]] std::span<const PathId> paths_of(ObjectId object) const;
  /// Rays and shadow segments of a tree with this path.
  [[nodiscard]] std::uint32_t segments(PathId path) const { return segments_[path.index()]; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::vector<PathId>> of_object_;
  std::vector<std::uint32_t> segments_;
};

/// Calls visit(object) for every object that a path names: those that are hit, and transparent ones on the way to a
/// light. An object may come several times.
template <class Visit>
void for_each_object(std::span<const std::uint32_t> path, const PathLayout& layout, const Visit& visit) {
  for (PathCursor cursor(path, layout); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (node.is_miss()) continue;
    visit(node.object);
    EntryReader entries(node.entries, layout.shadow_bits);
    for (std::size_t light = 0; light < layout.lights; ++light)
      for (std::uint32_t object : entries.next(shadow_state(node.lights, light)).objects) visit(ObjectId(object));
  }
}

}  // namespace relook
