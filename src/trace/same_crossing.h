// What makes two hits of one ray one crossing of a surface: an object and two of its hits in, whether they are one out;
// inside src/trace.
#pragma once
#include "trace/ray_scene.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// A ray that meets an edge or a corner meets the triangles around it: they are one surface, not one behind another.
/// False for the two sides of a fold, and for triangles that lie upon each other. `travel`: the way of the ray, of any
/// length. Requires: the hits are as near to each other along the ray as rounding puts them.
[[nodiscard]] bool is_same_crossing(const RayObject& object, const Hit& a, const Hit& b, const Direction& travel);

}  // namespace relook
