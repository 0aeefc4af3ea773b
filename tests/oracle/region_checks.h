// Checks of the image quadtree against the ray trees that it stands for.
#pragma once
#include <string>

#include "replay/replay.h"

namespace relook {

/// How the words of the replayer's paths are laid out.
[[nodiscard]] PathLayout layout_of(const Replayer& replayer);

/// Groups and tunnels built afresh from the replayer's trees.
[[nodiscard]] ImageRegions fresh_regions(const Replayer& replayer);

/// The number of tiles whose groups or tunnels (if they are in memory) are not those built afresh; one more if
/// the image's are not.
[[nodiscard]] std::size_t stale_tiles(const Replayer& replayer);

/// The number of stored segments that leave a tunnel that should enclose them, of their leaf or of any region above.
/// `segments`: how many were looked at.
[[nodiscard]] std::size_t segments_outside(const Replayer& replayer, const ImageRegions& regions,
                                           std::size_t& segments);

}  // namespace relook
