// Samples of a tile: which pixel, where in it, and the primary ray. Fixed positions, no randomness.
#pragma once
#include <algorithm>
#include <vector>

#include "engine/image.h"
#include "region/quadtree.h"
#include "scene/camera.h"
#include "trace/tree_block.h"

namespace relook {

/// Number of samples of a tile.
[[nodiscard]] inline std::uint32_t sample_count(const TileRect& rect, const ViewOptions& view) {
  return rect.pixels() * view.samples;
}
/// Trees are shaded in chunks of about so many samples, so that a chunk's nodes stay in the processor's cache: fewer
/// where a node has many lights.
[[nodiscard]] inline std::uint32_t chunk_samples(std::size_t lights) {
  constexpr std::size_t kMostSamples = 2048, kMostLinks = std::size_t{1} << 20;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(kMostLinks / (lights + 1), 1, kMostSamples));
}
/// Calls visit(sample, leaf) for the samples of some leaves of a tile, in increasing order.
template <class Visit>
void for_each_sample(const TileRect& rect, const ViewOptions& view, const Leaves& leaves, const Visit& visit) {
  const std::uint32_t width = rect.x1 - rect.x0, height = rect.y1 - rect.y0;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t column = 0; column * kLeafSize < width; ++column) {
      const std::uint32_t leaf = y / kLeafSize * kLeafSide + column;
      if (!leaves.test(leaf)) continue;
      const std::uint32_t x0 = column * kLeafSize, x1 = std::min(x0 + kLeafSize, width);
      const std::uint32_t first = (y * width + x0) * view.samples, last = (y * width + x1) * view.samples;
      for (std::uint32_t sample = first; sample < last; ++sample) visit(sample, leaf);
    }
}
/// The primary rays of an image's samples.
class PrimaryRays {
 public:
  PrimaryRays(const Camera& camera, const ViewOptions& view);
  /// That of sample `sample` of a tile.
  [[nodiscard]] SpawnedRay ray(const TileRect& rect, std::uint32_t sample) const;
  /// Those of samples [first, last) of a tile.
  void append(const TileRect& rect, std::uint32_t first, std::uint32_t last, std::vector<SpawnedRay>& rays) const;

 private:
  [[nodiscard]] SpawnedRay through(std::uint32_t x, std::uint32_t y, std::uint32_t k) const;

  const Camera& camera_;
  std::vector<Uv> in_pixel_;  // positions of a pixel's samples, in [0, 1)
};

/// A pixel from its samples: their sum in order, divided by their number.
[[nodiscard]] Rgba pixel_color(const Rgba* samples, std::uint32_t count);

}  // namespace relook
