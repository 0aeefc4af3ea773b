// Ray trees, sample colours and sums of light as pieces that may leave memory (cache/residency/residency.h), from the
// moment a cache is read.
#pragma once
#include <span>
#include <vector>

#include "cache/residency/residency.h"
#include "frame/image.h"

namespace relook {

/// Says how they come and go; all are missing until they are noted. The image's vectors keep their elements where these
/// are: they may be moved, not resized.
void add_image_pieces(Residency& residency, Image& image);
/// All that a tile has.
void note_pieces(Residency& residency, std::size_t tile, const Image& image);

/// What works on tiles in order expects the pieces of the tile that many places ahead. On a disk of 5 ms and 150 MB/s
/// 4, 8 and 16 took the same time, 1 and 64 longer.
inline constexpr std::size_t kTilesAhead = 8;

/// A tile's trees have changed. Without hits they are missing. `hit_seconds`: to find a hit again.
void note_trees(Residency& residency, std::size_t tile, const TileTrees& trees, double hit_seconds = kHitSeconds);
void note_colors(Residency& residency, std::size_t tile, const std::vector<Rgba>& colors);
void note_sums(Residency& residency, std::size_t tile, const PackedSums& sums);

/// The tiles whose ray trees are not among a share of the samples (m_r of the paper's 4.1), where those with the most
/// `nodes` a sample are kept.
[[nodiscard]] std::vector<std::size_t> tiles_beyond(double share, const std::vector<TileTrees>& trees,
                                                    std::span<const std::uint64_t> nodes);

/// Of the hits and where they start.
[[nodiscard]] std::uint64_t hit_bytes(const TileTrees& trees);

}  // namespace relook
