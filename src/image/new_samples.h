// What a pass over an image has found out about single samples of its tiles, on the way into the stored image.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "trace/tree/ray_path.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// Colours of some samples of a tile.
struct SampleColors {
  std::vector<std::uint32_t> samples;  // increasing
  std::vector<Rgba> colors;            // of `samples`
};

/// Ray trees of some samples of a tile in their stored form.
struct SampleTrees {
  std::vector<std::uint32_t> samples;       // increasing
  PathTable paths;                          // numbered within the tile
  std::vector<PathId> path_of;              // of `samples`, in `paths`
  std::vector<Hit> hits;                    // of `samples`, one after the other
  std::vector<std::uint32_t> first_hit{0};  // [samples.size() + 1] into hits

  /// Hits of the sample at place `k`.
  [[nodiscard]] std::span<const Hit> hits_at(std::size_t k) const {
    return std::span(hits).subspan(first_hit[k], first_hit[k + 1] - first_hit[k]);
  }
};

/// Of one tile.
struct NewSamples {
  std::size_t tile = 0;
  SampleColors shaded;          // with new colours
  SampleTrees packed;           // with new trees
  bool missed_tunnels = false;  // there should have been some to tell what to test
};

}  // namespace relook
