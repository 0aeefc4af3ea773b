// What a step did and what it could skip; the names are those of report.json (report/report.schema.json).
#pragma once
#include <cstdint>

#include "region/quadtree.h"
#include "trace/tree/grow.h"

namespace relook {

/// What left memory or came back. Colour trees and rebuilt ray trees one by one; all else tile by tile. `bytes`: of all
/// together.
struct Moves {
  std::uint64_t ray_trees = 0, sample_colors = 0, light_sums = 0, color_trees = 0, tunnels = 0, bytes = 0;
  Moves& operator+=(const Moves& other);
};

/// Ray trees whose hits were found again.
[[nodiscard]] Moves rebuilt_trees(const GrowCounters& counters);

struct Counters {
  std::uint64_t samples_total = 0, samples_affected = 0;  // affected: visited because they may change
  std::uint64_t pixels_changed = 0;                       // pixels with at least one different bit
  RegionCounters by_groups, by_tunnels;                   // regions visited and culled by either
  std::uint64_t ray_tests = 0, ray_tests_culled = 0;      // stored segments tested against the selection only, or not
  CulledSegments culled;                                  // of those not tested, by what ruled them out
  std::uint64_t ray_updates = 0;                          // rays traced against the whole scene
  std::uint64_t shadow_updates = 0;                       // shadow segments traced against the whole scene
  std::uint64_t object_rays = 0;                          // rays and shadow segments against one known object
  std::uint64_t color_trees_evaluated = 0;
  std::uint64_t color_trees_reused = 0;  // of these, from what earlier steps had kept: columns or terms, no ray trees
  std::uint64_t tunnels_read = 0;    // tiles whose tunnels the cache holds and that were used for the first time
  Moves evicted, rebuilt, reloaded;  // rebuilt: worked out again after it had left or had become invalid

  Counters& operator+=(const Counters& other);
};

struct Seconds {
  double classify = 0, select = 0, test = 0, update = 0, evaluate = 0, write = 0, total = 0;
  double cpu = 0;  // of all threads, in total; what is written of the frame before may be among it
};

/// Bytes held in memory by kind.
struct Resident {
  std::uint64_t ray_paths = 0, ray_trees = 0, sample_colors = 0, light_sums = 0, kept_rays = 0, kept_segments = 0,
                kept_terms = 0, kept_vertices = 0, color_trees = 0, groups = 0, tunnels = 0;
  std::uint64_t total = 0;  // the frame included
};

}  // namespace relook
