// Tunnels (paper 3.4.1): around all segments of some ray trees, a section for each branch history with its rays and its
// shadow segments. A section keeps the boxes of its segments' ends; the shafts between them follow from these.
// enclose() makes a tunnel, find_touches() asks what of it a change of the scene may touch: never less than what it
// does touch.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "region/shaft.h"
#include "trace/tree/touch.h"
#include "trace/tree/tree_block.h"

namespace relook {

struct TunnelSection {
  History history;
  float slack = 0;                   // the most metres that a ray test looks beyond the ray's hit
  LightSet open = {}, blocked = {};  // lights to which some shadow segment is open, or blocked
  Box points;                        // the hits, and the origins of what leaves them; at the eye: of primary rays
  Box leaving;                       // unit directions of the rays that met nothing

  bool operator==(const TunnelSection&) const = default;
};

/// Sections by history, increasing; the first is the eye's. Empty if no tree is inside.
using Sections = std::vector<TunnelSection>;

/// The section of a history, or null.
[[nodiscard]] const TunnelSection* find_section(std::span<const TunnelSection> tunnel, History history);

/// Extends a tunnel by the tree of the sample whose nodes start at `root`. `scratch`: working memory.
void enclose(Sections& tunnel, const RayScene& scene, const TreeBlock& block, std::uint32_t root,
             std::vector<History>& scratch);
/// Extends a tunnel by another one.
void enclose(Sections& tunnel, std::span<const TunnelSection> other);

/// The far end of the shadow segments to one light: its position, or the direction to it.
struct LightEnd {
  bool directional = false;
  Box end;
};
[[nodiscard]] std::vector<LightEnd> light_ends(const RayScene& scene);
[[nodiscard]] std::vector<LightEnd> light_ends(const Scene& scene);

/// Square metres of all shafts of a tunnel together, a weight of the paper's 4.3. Shafts that have no far end, of rays
/// that met nothing and of directional lights, are taken as long as the tunnel's own extent.
[[nodiscard]] double surface_area(std::span<const TunnelSection> tunnel, const std::vector<LightEnd>& lights);

/// Several objects as boxes: `all` is around all of them; with two objects or more, `parts` are around some of them
/// each.
struct BoxSet {
  Box all;
  std::vector<Box> parts;
  [[nodiscard]] bool empty() const { return all.isEmpty(); }
};
/// `boxes`: one an object; they are reordered. `most`: parts.
[[nodiscard]] BoxSet box_set(std::vector<Box>& boxes, std::size_t most = 16);
[[nodiscard]] bool touches(const Shaft& shaft, const BoxSet& boxes);

/// What a change of the scene can touch, in boxes that hold every hit up to rounding.
struct ChangeBoxes {
  BoxSet moved;                 // what rays may meet after the change
  BoxSet shadows_before;        // what blocked or filtered light before it
  BoxSet shadows_after;         // what does so after it
  float condition = 1;          // how much the objects' placement stretches rounding, at least 1
  bool count_blockers = false;  // with shadow counters: a further blocker of a blocked segment is a change, too
};

struct TunnelTest {
  const ChangeBoxes& change;
  const std::vector<LightEnd>& lights;
};
/// True if the change may touch the tunnel at all. `touches`, if not null, gets the sections that it may touch, and
/// those above them, by increasing history.
bool find_touches(std::span<const TunnelSection> tunnel, const TunnelTest& test, Touches* touches);

}  // namespace relook
