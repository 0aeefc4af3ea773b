// Which regions have tunnels, and how many (paper 3.4.1, 4.1, 4.1.3): fixed limits, decided from the size of the image
// alone, so that tunnels after any journal are those that would be built afresh.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "region/quadtree.h"

namespace relook {

/// The limits that --tunnels, --tunnel-levels and --most-tunnels set.
struct TunnelShape {
  std::size_t of_region = 1;              // most tunnels of a region, the last for all further paths; 0: none
  std::uint32_t dropped_levels = 2;       // the lowest levels without tunnels, 0..kTileLevel; 0: down to single pixels
  std::optional<std::uint64_t> of_image;  // most tunnels in all; none: no limit
  bool operator==(const TunnelShape&) const = default;
};

/// [tiles], numbered row by row: the level of a tile's cells; kTileLevel + 1 where the tile has no tunnel but the one
/// around all of it. Empty: the image has no tunnels. A limit on all tunnels takes the lowest levels first, in some
/// tiles sooner than in others, which are spread evenly; one that has no room for a tunnel of each tile and of each
/// region above leaves none. A region counts with as many tunnels as it may have.
[[nodiscard]] std::vector<std::uint8_t> cell_levels(const TunnelShape& shape, std::uint32_t width,
                                                    std::uint32_t height);

/// The number of regions of the quadtree above the tiles. Each has one tunnel if the image has any.
[[nodiscard]] std::uint64_t regions_above_tiles(std::uint32_t width, std::uint32_t height);

}  // namespace relook
