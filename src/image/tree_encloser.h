// Encloses the ray trees of a tile, expanded from their stored form (paper 3.4.3).
#pragma once
#include <span>
#include <vector>

#include "cache/residency/residency.h"
#include "frame/image.h"
#include "image/sampling.h"
#include "region/path_groups.h"
#include "region/tile_tunnels.h"
#include "trace/tree/grow.h"

namespace relook {

class TreeEncloser {
 public:
  /// `most`: how many tunnels a region has at most. `trees_lease`: of the tile's ray trees, if they may leave memory.
  /// All else outlives it.
  TreeEncloser(const Image& image, const GrowScene& grow, std::size_t tile, std::size_t most, const ClassOf& class_of,
               Residency::Lease trees_lease = {});
  /// The tunnels around the trees of a part of the tile, until the next call.
  [[nodiscard]] std::span<const Tunnel> of(const RegionSquare& square);
  /// One around all of the tile's.
  [[nodiscard]] Sections around();

 private:
  void add(std::uint32_t sample);

  Residency::Lease lease_;
  const Image& image_;
  const GrowScene& grow_;
  const TileTrees& trees_;
  TileRect rect_;
  PrimaryRays primaries_;
  const ClassOf& class_of_;
  GrowCounters counters_;
  TunnelSet set_;
  TreeBlock block_;
  std::vector<History> histories_;
};

}  // namespace relook
