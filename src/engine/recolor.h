// A step that changes colour parameters alone (paper 2.1, 3.3): the samples that depend on them are compressed when
// the parameters change first, and afterwards only the residual programs are run.
#pragma once
#include "engine/compressed_edits.h"
#include "engine/stored_image.h"
#include "engine/tile_update.h"

namespace relook {

/// True if compressed trees can follow the change.
[[nodiscard]] bool is_compressible(const ColorChange& change);

/// Compresses the trees of a tile's samples. `pass`: for the change; `work`: where to look.
[[nodiscard]] CompressedTile compress_tile(const UpdatePass& pass, std::size_t tile, const TileWork& work,
                                           CompressedImage& image, Shader& shader);

/// Evaluates a valid tile and brings colours and frame up to date: the mask of its changed pixels. Tiles may be done at
/// the same time.
[[nodiscard]] TileMask recolor_tile(const CompressedTile& compressed, std::size_t tile, const Scene& scene,
                                    StoredImage& stored, ColorMemory& memory);

}  // namespace relook
