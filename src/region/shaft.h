// Shafts (paper 3.4.2, after Haines & Wallace 1991): the convex hull of two boxes with axis-aligned faces. A segment
// whose ends lie in the boxes lies in the shaft; the shaft of sub-boxes lies in the shaft of the boxes. A box that is a
// point makes a pyramid. Called by tunnel.cpp for every section.
#pragma once
#include "base/math.h"

namespace relook {

struct Shaft {
  Box from, to;  // neither is empty
};

/// Everything that leaves `from` in one of the unit directions in the box `directions`, as far as `length` metres.
[[nodiscard]] Shaft extruded(const Box& from, const Box& directions, float length);

/// True if and only if the shaft and the box have a point in common, boundaries included, up to double rounding. The
/// hull of two boxes is the union over t in [0, 1] of the box whose bounds are interpolated between theirs; so the
/// question is whether six linear inequalities in t have a common solution. Haines & Wallace's trivial rejections by
/// the shaft's planes decide the same way against a box whose faces are aligned, too: these planes are all that can
/// separate the two.
[[nodiscard]] bool touches(const Shaft& shaft, const Box& box);

/// Square metres. Requires: neither box is empty.
[[nodiscard]] double surface_area(const Shaft& shaft);

}  // namespace relook
