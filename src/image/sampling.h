// Samples of a tile: which pixel, where in it, and the primary ray. Fixed positions, no randomness.
#pragma once
#include <algorithm>
#include <vector>

#include "image/image.h"
#include "region/quadtree.h"
#include "scene/camera.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Number of samples of a tile.
[[nodiscard]] inline std::uint32_t sample_count(const TileRect& rect, const ViewOptions& view) {
  return rect.pixels() * view.samples;
}
/// Trees are shaded in chunks of samples whose nodes stay in the processor's cache, and whose memory is bounded where a
/// sample has thousands of lights behind glass: 2048, or about as many as fit into some megabytes.
class ChunkSize {
 public:
  explicit ChunkSize(std::size_t lights)
      : samples_(static_cast<std::uint32_t>(std::clamp<std::size_t>(kFirstLinks / (lights + 1), 1, kMostSamples))) {}

  /// How many samples to take next.
  [[nodiscard]] std::uint32_t samples() const { return samples_; }
  /// The next chunk follows from what the last one, of `samples` samples, has taken.
  void learn(const TreeBlock& block, std::uint32_t samples) {
    const std::size_t fitting = std::size_t{samples} * kMostBytes / std::max<std::size_t>(1, bytes_of_chunk(block));
    const std::size_t most = std::min<std::size_t>(std::size_t{kMostGrowth} * samples_, kMostSamples);
    samples_ = static_cast<std::uint32_t>(std::clamp<std::size_t>(fitting, 1, most));
  }
  /// Of trees that are gathered one by one.
  [[nodiscard]] static bool is_full(const TreeBlock& block, std::size_t samples) {
    return samples >= kMostSamples || bytes_of_chunk(block) >= kMostBytes;
  }

 private:
  static constexpr std::uint32_t kMostSamples = 2048, kMostGrowth = 4;
  static constexpr std::size_t kFirstLinks = std::size_t{1} << 14, kMostBytes = std::size_t{16} << 20;

  [[nodiscard]] static std::size_t bytes_of_chunk(const TreeBlock& block) {
    return block.lights.size() * sizeof(LightLink) + block.filters.size() * sizeof(FilterNode);
  }

  std::uint32_t samples_;
};

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
