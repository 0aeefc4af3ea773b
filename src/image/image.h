// What is kept of one image between steps: paths, ray trees, the colour of every sample, and the frame.
#pragma once
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "trace/tree/ray_path.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// Sampling options that a cache fixes, beside the camera.
struct ViewOptions {
  std::uint32_t samples = 1;      // per pixel, at fixed positions; 1..1024
  std::uint32_t max_depth = 6;    // generations of rays, primary rays are the first; 1..32
  std::uint32_t shadow_bits = 0;  // of the shadow counters in ray paths; 0..4
  bool operator==(const ViewOptions&) const = default;
};

struct Frame {
  std::uint32_t width = 0, height = 0;
  std::vector<Rgba> pixels;  // [height * width], row 0 on top; float32 linear Rec.709, a = coverage
};

/// A tile's pixels: [x0, x1) x [y0, y1).
struct TileRect {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] std::uint32_t pixels() const { return (x1 - x0) * (y1 - y0); }
};
/// Tiles row by row, kTileSize square, the last ones clipped.
[[nodiscard]] std::size_t tile_count(std::uint32_t width, std::uint32_t height);
[[nodiscard]] TileRect tile_rect(std::size_t tile, std::uint32_t width, std::uint32_t height);

/// Are the hits of a tile's ray trees kept? Without, they follow from the paths (paper 4.1.2).
[[nodiscard]] inline bool has_hits(const TileTrees& trees) { return !trees.first_hit.empty(); }

struct Image {
  ViewOptions view;
  Frame frame;
  PathTable paths;
  std::vector<TileTrees> trees;                  // [tile_count]
  std::vector<std::vector<Rgba>> sample_colors;  // [tile_count][samples of the tile]
};

}  // namespace relook
