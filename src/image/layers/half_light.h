// Light of the first half of each pixel's samples, under Integrator::path. Beside that of all of them it tells how far
// a pixel is from what it estimates: both halves are points of the pixel's own sets, stratified in themselves.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "frame/image.h"
#include "image/sampling.h"
#include "image/tile_light.h"
#include "scene/scene.h"
#include "trace/tracer.h"

namespace relook {

/// A scene made ready for halves; shared by threads.
struct HalfScene {
  /// Both outlive it.
  HalfScene(const Scene& scene, const ViewOptions& options);

  const ViewOptions& view;
  ColorScene rays;
  Tracer tracer{false};
  Tracer::TopLevel level;
  GrowScene grow;
  TilePrograms programs;
};

/// Has a pixel two halves?
[[nodiscard]] inline bool has_halves(const ViewOptions& view) {
  return view.integrator == Integrator::path && view.samples > 1;
}

/// Works on one tile after another; one per thread. Requires: has_halves().
class HalfLight {
 public:
  explicit HalfLight(const HalfScene& scene);
  /// Sums of the first floor(N / 2) samples of pixels first, first + stride, ... of a tile, by place in this list.
  [[nodiscard]] TileSums trace(const TileRect& rect, std::uint32_t first = 0, std::uint32_t stride = 1);
  /// The mean of those samples in a pixel.
  template <class Sums>
  [[nodiscard]] Rgba mean(const Sums& sums, std::size_t pixel, std::span<const LightColor> colors) const {
    return compose(sums, pixel, colors, half_);
  }
  /// By which the square of the difference between that mean and the pixel is its variance: with means A of h samples
  /// and F of all N, E(A - F)^2 = V (N - h) / h, V the variance of F.
  [[nodiscard]] float scale() const {
    return static_cast<float>(half_) / static_cast<float>(scene_.view.samples - half_);
  }

 private:
  const HalfScene& scene_;
  std::uint32_t half_;
  PrimaryRays primary_;
  TileShading shading_;
  TreeBlock block_;
  std::vector<SpawnedRay> rays_;
  std::vector<std::uint32_t> roots_;
};

/// Sums of halves by tile, kept from frame to frame of one run.
struct KeptHalves {
  std::vector<PackedSums> sums;         // [tiles]
  std::vector<std::uint32_t> versions;  // [tiles] of the tile's sums of all samples; 0: none is kept
};

/// How noisy a frame is: how far the luminance of pixels is off on average, as halves tell, over the mean luminance;
/// from every 32nd pixel. None: a sample a pixel, whitted, or a black frame. `frame`: of the scene.
[[nodiscard]] std::optional<double> noise(const Scene& scene, const ViewOptions& view, const Frame& frame);

}  // namespace relook
