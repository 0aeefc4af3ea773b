// An image with what it was made from, as a cache keeps it and a replay goes on from it: the frame, the colour of every
// sample or the sums of light of every pixel, and the paths and ray trees behind them. Plain data.
#pragma once
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "frame/frame.h"
#include "frame/light_sums.h"
#include "scene/camera.h"
#include "scene/integrator.h"
#include "trace/tree/ray_path.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// Sampling options that a cache fixes, beside the camera.
struct ViewOptions {
  std::uint32_t samples = 1;      // per pixel, at fixed positions; 1..4096
  std::uint32_t max_depth = 6;    // generations of rays, primary rays are the first; 1..32
  std::uint32_t shadow_bits = 0;  // of the shadow counters in ray paths; 0..4
  Integrator integrator = Integrator::whitted;
  // Of paths alone, 0..32: bounces off diffuse surfaces (0: direct light only), off glossy ones, and through what
  // transmits.
  std::uint32_t diffuse_depth = 0, glossy_depth = 4, transmission_depth = 16;
  Lens lens{};  // likewise
  bool operator==(const ViewOptions&) const = default;
};

/// Are the hits of a tile's ray trees kept? Without, they follow from the paths (paper 4.1.2).
[[nodiscard]] inline bool has_hits(const TileTrees& trees) { return !trees.first_hit.empty(); }

struct Image {
  ViewOptions view;
  Frame frame;
  PathTable paths;
  std::vector<TileTrees> trees;                  // [tile_count()]
  std::vector<std::vector<Rgba>> sample_colors;  // [tile_count()][samples of the tile]; of paths none
  std::vector<PackedSums> light_sums;            // [tile_count()] of paths; otherwise none
};

}  // namespace relook
