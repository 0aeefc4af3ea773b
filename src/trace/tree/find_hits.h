// The hits of a ray tree as it was before a change, found again after it, so that a tree whose hits are not kept is
// updated as any other (paper 4.1.2, 2.2): rays against the objects that its path names, and below a node only where
// the old rays still go. What update_tree() does not read stays empty.
#pragma once
#include <vector>

#include "trace/object_rays.h"
#include "trace/tree/grow.h"

namespace relook {

class HitFinder {
 public:
  /// `grow`: after the change, with `objects`; all outlive it.
  HitFinder(const GrowScene& grow, const RayChange& change, GrowCounters& counters);

  /// Appends the hits of one sample, as many as pack() gave. Empty ones: of objects that have moved and all below them;
  /// of transparent surfaces that let light through differently now, or stand before a light that has moved or is gone;
  /// below rays that do not leave as they did. `path`: from its start.
  void find(const SpawnedRay& primary, const PathCursor& path, std::vector<Hit>& hits);

 private:
  void find_node(const SpawnedRay& before, const SpawnedRay& now);
  void find_filters(const RayNode& node, const PathNode& stored);
  void find_children(const RayNode& node, const PathNode& stored, const SpawnedRay& now);
  void append_empty(const PathNode& stored);
  void skip_trees(unsigned count);
  [[nodiscard]] bool has_flag(ObjectId id, RayChange::Flag flag) const { return (change_.flags(id) & flag) != 0; }

  const GrowScene& g_;
  const RayChange& change_;
  GrowCounters& counters_;
  ObjectRays rays_;
  std::vector<std::uint32_t> new_light_;  // by place in the old light order; kNoNode: moved or gone
  PathCursor cursor_{{}, {}};
  std::vector<Hit>* hits_ = nullptr;
  std::vector<std::uint32_t> steady_;  // of a segment: objects that let light through as before
};

}  // namespace relook
