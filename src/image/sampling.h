// Samples of a tile: which pixel, where in it, and the primary ray. Positions are fixed: the same in every pixel, or,
// under the path integrator, points of each pixel's own set.
#pragma once
#include <algorithm>
#include <vector>

#include "frame/image.h"
#include "region/quadtree.h"
#include "scene/camera.h"
#include "trace/tree/tree_block.h"

namespace relook {

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
  Lens lens_;
  bool is_path_;
  std::vector<Uv> in_pixel_;  // positions of a pixel's samples, in [0, 1)
};

/// A pixel from its samples: their sum in order, divided by their number.
[[nodiscard]] Rgba pixel_color(const Rgba* samples, std::uint32_t count);

}  // namespace relook
