// Pictures of regions, as in Figures 2 b to f of the paper: a frame with the outlines of squares of the quadtree.
#pragma once
#include <cstddef>

#include "frame/image.h"
#include "region/path_groups.h"

namespace relook {

/// Draws the largest regions of a tile that consist of the given leaves in white, one pixel wide, inside the regions.
void draw_regions(Frame& frame, std::size_t tile, const Leaves& leaves);

/// Draws the largest regions of a tile that are 1-groups, leaves at the least.
void draw_groups(Frame& frame, std::size_t tile, const PathGroups& groups);

}  // namespace relook
