// Grows ray trees: by tracing against the whole scene, from stored paths and hits, from paths alone, or by updating
// what is stored after a change of the scene (paper 2.2): all give the same nodes for the same scene.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "trace/object_levels.h"
#include "trace/tracer.h"
#include "trace/tree/path_cursor.h"
#include "trace/tree/segment_counts.h"
#include "trace/tree/spawn.h"
#include "trace/tree/touch.h"
#include "trace/tree/tree_block.h"

namespace relook {

struct GrowCounters {
  std::uint64_t ray_updates = 0;     // rays traced against the whole scene
  std::uint64_t shadow_updates = 0;  // shadow segments traced against the whole scene
  std::uint64_t ray_tests = 0;       // stored segments tested against the selection
  CulledSegments culled;             // stored segments looked at, or dropped, without a test
  std::uint64_t object_rays = 0;     // rays and shadow segments against one known object, to find hits again or where
                                     // transparent surfaces stand on a shadow segment
  std::uint64_t trees_rebuilt = 0;   // whose hits these rays have found again
  std::uint64_t hits_rebuilt = 0;    // of these trees

  GrowCounters& operator+=(const GrowCounters& other) {
    ray_updates += other.ray_updates;
    shadow_updates += other.shadow_updates;
    ray_tests += other.ray_tests;
    culled += other.culled;
    object_rays += other.object_rays;
    trees_rebuilt += other.trees_rebuilt;
    hits_rebuilt += other.hits_rebuilt;
    return *this;
  }
};

/// What all growing needs.
struct GrowScene {
  const RayScene& scene;
  const Tracer::TopLevel* level = nullptr;  // the whole scene; null if nothing is traced
  std::uint32_t max_depth = 6;
  std::uint32_t shadow_bits = 0;  // of shadow counters; more than 0: the level is of a tracer that counts blockers
  const ObjectLevels* objects = nullptr;  // for hits, or distances of hits, that are not kept; null: all are known
  Integrator integrator = Integrator::whitted;
  std::uint32_t diffuse_depth = 0, glossy_depth = 4, transmission_depth = 16;  // bounces, of the path integrator

  [[nodiscard]] SpawnRule rule() const {
    return {max_depth, integrator, diffuse_depth, glossy_depth, transmission_depth};
  }
  [[nodiscard]] PathLayout layout() const { return {scene.light_order().size(), shadow_bits}; }
};

/// Appends the ray trees of consecutive samples, traced, and the indices of their roots.
void trace_trees(const GrowScene& grow, std::span<const SpawnedRay> primaries, std::uint32_t first_sample,
                 TreeBlock& block, std::vector<std::uint32_t>& roots, GrowCounters& counters);

class KeptRay;  // trace/update/kept_rays.h

/// A stored ray tree being walked.
struct StoredTree {
  PathCursor cursor;
  std::optional<std::span<const Hit>> hits;  // none: not kept; a tree that meets nothing has an empty span
  const KeptRay* kept = nullptr;             // the tree's rays behind the first, to update_tree alone; null: not kept
};

/// Appends the ray tree of one sample from its path and hits. Hits that are not kept are found again in `grow.objects`
/// (paper 4.1.2). Requires: the scene is the one they were recorded in.
std::uint32_t expand_tree(const GrowScene& grow, const SpawnedRay& primary, std::uint32_t sample, StoredTree stored,
                          TreeBlock& block, GrowCounters& counters);

/// What changed between the scene of the stored trees and the scene as it is now, in terms of rays.
struct RayChange {
  enum Flag : std::uint8_t {
    moved = 1,     // hits on the object are not valid any more; it may be met elsewhere
    shadows = 2,   // it blocks or filters light differently (moved objects too)
    respawns = 4,  // its hits stay, but other rays may leave from them
  };
  std::vector<std::uint8_t> objects;               // flags by ObjectId; empty: none has any
  std::vector<RayObject> before;                   // values before the change of flagged objects
  std::vector<std::uint32_t> before_index;         // by ObjectId, into `before`
  Tracer::TopLevel moved_after;                    // moved objects where they are now
  Tracer::TopLevel shadows_before, shadows_after;  // objects with flag `shadows`
  SelectionBounds bounds;                          // of these three, where they are not empty
  std::vector<LightId> old_lights;                 // light order of the stored trees
  std::vector<std::uint32_t> old_light_index;      // by place in the new light order; kNoNode: new or moved light
  std::vector<Box> light_boxes;                    // by place in the new light order: around a light, empty: it may be
                                                   // anywhere; none at all: nothing is known
  std::vector<std::uint32_t> lost_lights;          // places in the old light order to which no new one refers
  bool lights_changed = false;                     // any light added, deleted, moved or reordered
  bool keeps_places = false;                       // the light order is the stored one, whatever has moved

  [[nodiscard]] std::uint8_t flags(ObjectId id) const {
    return objects.empty() ? std::uint8_t{0} : objects[id.index()];
  }
  /// Of a flagged object that was in trees.
  [[nodiscard]] const RayObject& value_before(ObjectId id) const { return before[before_index[id.index()]]; }
  /// Has no object any flag?
  [[nodiscard]] bool only_lights() const {
    return before.empty() && moved_after.empty() && shadows_before.empty() && shadows_after.empty();
  }
  /// Finds the lost lights from the old ones and their new places.
  void find_lost_lights();
  /// Makes room for the flags of that many objects.
  void reserve(std::size_t count) {
    objects.resize(count, 0);
    before_index.resize(count, kNoNode);
  }
};

/// What of an updated tree differs from what is stored.
enum class TreeChange : std::uint8_t {
  none,
  counters,  // only what stands before lights that were blocked and still are: the path, no colour
  lights,    // only lights that are new, gone or elsewhere
  all,       // a node, hit, filter or shadow state, or a light that reaches a node has moved
};

/// Appends the ray tree of one sample as it is after the change, reusing what is stored and still valid. `touches`: the
/// segments that the selection may meet or may have met; null: any. Requires: `stored` has its hits. With its rays kept
/// nothing is spawned, nodes have no lobes, and a tree that would be TreeChange::all is left half done; they are there
/// only if no object of the tree has a flag.
std::uint32_t update_tree(const GrowScene& grow, const RayChange& change, const Touches* touches,
                          const SpawnedRay& primary, std::uint32_t sample, StoredTree stored, TreeBlock& block,
                          GrowCounters& counters, TreeChange& what);

}  // namespace relook
