// Which regions have tunnels, and how many (paper 3.4.1, 4.1, 4.1.3): fixed limits, decided from the size of the image
// alone, so that tunnels after any journal are those that would be built afresh.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "region/quadtree.h"

namespace relook {

/// What is asked for.
struct TunnelShape {
  std::size_t of_region = 1;              // most tunnels of a region, the last for all further paths; 0: none
  std::uint32_t dropped_levels = 2;       // the lowest levels without tunnels, 0..kTileLevel; 0: down to single pixels
  std::optional<std::uint64_t> of_image;  // most tunnels in all; none: no limit
  bool operator==(const TunnelShape&) const = default;
};

/// [tiles], numbered row by row: the level of a tile's cells, kTileLevel + 1 where it has just the one around all of
/// it. Empty: no tunnels at all. With a limit on all tunnels the lowest levels go first, in some tiles sooner than in
/// others, which are spread evenly; what a limit leaves nothing of is an image's tunnels from its tiles up. Of a region
/// so many are counted as it may have.
[[nodiscard]] std::vector<std::uint8_t> cell_levels(const TunnelShape& shape, std::uint32_t width,
                                                    std::uint32_t height);

/// Of the quadtree: each has one tunnel if there are any.
[[nodiscard]] std::uint64_t regions_above_tiles(std::uint32_t width, std::uint32_t height);

}  // namespace relook
