// One tile after a step that changes lights alone, from its vertices that are kept (color/path/tile_vertices.h): new
// lights are sampled there, segments shot, terms added to their sums; paths are what is stored with other states of
// lights. The same bits as update_path_tile() gives.
#pragma once
#include "replay/path/path_tile.h"

namespace relook {

/// Can a step be done so? Its lights are all new, and no ray from the eye meets a shape of theirs.
[[nodiscard]] bool may_use_vertices(const PathPass& pass);
/// Are samples whose ray from the eye meets nothing none of those that the step's lights bring terms to?
[[nodiscard]] bool are_misses_dark(const PathPass& pass);

/// `sums`: of the tile before the edit. Requires: may_use_vertices(); the tile's hits are there.
[[nodiscard]] PathTileResult relight_path_tile(const PathPass& pass, std::size_t tile, const PackedSums& sums,
                                               const TileVertices& vertices);

}  // namespace relook
