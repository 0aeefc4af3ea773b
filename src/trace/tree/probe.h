// Ray tests without ray trees (paper 2.2, 3.4): does the selection, where it is now or where it was, meet a stored
// segment that its tunnel could not rule out? Only the points on the way to such segments are computed.
#pragma once
#include "trace/tree/grow.h"
#include "trace/tree/touch.h"

namespace relook {

/// True if the change may alter the tree: then update_tree() says how. Counts the ray tests that it made.
/// Requires: `stored` has its hits, no node or filter of its path belongs to a changed object, and the lights are as
/// before.
[[nodiscard]] bool probe_tree(const GrowScene& grow, const RayChange& change, const Touches& touches,
                              const SpawnedRay& primary, StoredTree stored, GrowCounters& counters);

}  // namespace relook
