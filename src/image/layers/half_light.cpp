#include "image/layers/half_light.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "base/pool.h"
#include "light/luminance.h"
#include "scene/light_sums.h"

namespace relook {
namespace {

constexpr std::uint32_t kStride = 32;  // every so many pixels one is looked at

struct NoiseSums {
  double error = 0, light = 0;
};

}  // namespace

HalfScene::HalfScene(const Scene& scene, const ViewOptions& options)
    : view(options),
      rays(scene),
      level(tracer.build(rays)),
      grow(grow_scene(rays, &level, options, 0)),
      programs(rays) {}

HalfLight::HalfLight(const HalfScene& scene)
    : scene_(scene),
      half_(scene.view.samples / 2),
      primary_(scene.rays.camera(), scene.view),
      shading_(scene.programs, half_) {}

TileSums HalfLight::trace(const TileRect& rect, std::uint32_t first, std::uint32_t stride) {
  const std::uint32_t samples = scene_.view.samples;
  const std::uint32_t pixels = first < rect.pixels() ? (rect.pixels() - first - 1) / stride + 1 : 0;
  TileLight light{{}, TileSums(scene_.programs.places().count, pixels)};
  ChunkSize chunk(scene_.grow.layout().lights);
  GrowCounters counters;
  for (std::uint32_t begin = 0, end = 0; begin < pixels; begin = end) {
    stop_if_interrupted();
    end = std::min(begin + std::max(1U, chunk.samples() / half_), pixels);
    rays_.clear();
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t sample = (first + k * stride) * samples;
      primary_.append(rect, sample, sample + half_, rays_);
    }
    block_.clear();
    roots_.clear();
    trace_trees(scene_.grow, rays_, begin * half_, block_, roots_, counters);
    shading_.add(block_, roots_, begin * half_, light);
    chunk.learn(block_, (end - begin) * half_);
  }
  return std::move(light.sums);
}

std::optional<double> noise(const Scene& scene, const ViewOptions& view, const Frame& frame) {
  if (!has_halves(view)) return std::nullopt;
  const HalfScene half_scene(scene, view);
  const std::vector<LightColor> colors = colors_of(light_sums(scene));
  Pool<HalfLight> workers;
  std::vector<NoiseSums> tiles(tile_count(frame.width, frame.height));
  parallel_for(tiles.size(), [&](std::size_t tile) {
    const TileRect rect = tile_rect(tile, frame.width, frame.height);
    const auto worker = workers.take([&] { return std::make_unique<HalfLight>(half_scene); });
    const auto first = static_cast<std::uint32_t>(tile % kStride);
    const TileSums sums = worker->trace(rect, first, kStride);
    const double scale = std::sqrt(static_cast<double>(worker->scale()));
    for (std::uint32_t pixel = first, k = 0; pixel < rect.pixels(); pixel += kStride, ++k) {
      const std::uint32_t x = rect.x0 + pixel % rect.width(), y = rect.y0 + pixel / rect.width();
      const Rgba half = worker->mean(sums, k, colors), all = frame.pixels[std::size_t{y} * frame.width + x];
      const double light = luminance(Color(all.r, all.g, all.b));
      const double difference = luminance(Color(half.r, half.g, half.b)) - light;
      if (!std::isfinite(light) || !std::isfinite(difference)) continue;
      tiles[tile].light += light;
      tiles[tile].error += std::fabs(difference) * scale;
    }
  });
  NoiseSums all;
  for (const NoiseSums& tile : tiles) {
    all.light += tile.light;
    all.error += tile.error;
  }
  if (!(all.light > 0)) return std::nullopt;
  return all.error / all.light;
}

}  // namespace relook
