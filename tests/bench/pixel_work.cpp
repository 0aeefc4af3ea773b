#include "pixel_work.h"

#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "color/shade.h"
#include "image/sampling.h"
#include "setup.h"
#include "trace/tree/grow.h"

namespace relook {
namespace {

constexpr std::size_t kChunkSamples = 2048;

/// Samples of one tile.
struct TileSamples {
  std::size_t tile = 0;
  std::vector<std::uint32_t> samples;
};

/// The tiles that hold any of the pixels.
std::vector<TileSamples> by_tile(const Camera& camera, const ViewOptions& view, std::span<const std::uint32_t> pixels) {
  std::vector<TileSamples> tiles(tile_count(camera.width, camera.height));
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) tiles[tile].tile = tile;
  for (std::uint32_t pixel : pixels) {
    const std::uint32_t x = pixel % camera.width, y = pixel / camera.width;
    const std::size_t tile = tile_of(x, y, camera.width);
    const TileRect rect = tile_rect(tile, camera.width, camera.height);
    const std::uint32_t first = ((y - rect.y0) * (rect.x1 - rect.x0) + x - rect.x0) * view.samples;
    for (std::uint32_t k = 0; k < view.samples; ++k) tiles[tile].samples.push_back(first + k);
  }
  std::erase_if(tiles, [](const TileSamples& tile) { return tile.samples.empty(); });
  return tiles;
}

/// Traces and shades samples; one per thread.
class SampleRenderer {
 public:
  SampleRenderer(const GrowScene& grow, const ColorScene& scene, const ViewOptions& view, ProgramTable& programs)
      : grow_(grow), primaries_(scene.camera(), view), shader_(scene, programs) {}

  void render(const TileSamples& tile) {
    const Camera& camera = grow_.scene.camera();
    const TileRect rect = tile_rect(tile.tile, camera.width, camera.height);
    for (std::size_t first = 0; first < tile.samples.size(); first += kChunkSamples) {
      const std::size_t count = std::min(kChunkSamples, tile.samples.size() - first);
      rays_.clear();
      block_.clear();
      roots_.clear();
      for (std::uint32_t sample : std::span(tile.samples).subspan(first, count))
        rays_.push_back(primaries_.ray(rect, sample));
      trace_trees(grow_, rays_, 0, block_, roots_, counters_);
      colors_.resize(count);
      shader_.shade(block_, roots_, colors_);
    }
  }

 private:
  const GrowScene& grow_;
  PrimaryRays primaries_;
  Shader shader_;
  GrowCounters counters_;
  TreeBlock block_;
  std::vector<SpawnedRay> rays_;
  std::vector<std::uint32_t> roots_;
  std::vector<Rgba> colors_;
};

}  // namespace

double time_pixel_work(const Scene& scene, const ViewOptions& view, std::span<const std::uint32_t> pixels) {
  const std::vector<TileSamples> tiles = by_tile(scene.camera, view, pixels);
  const ColorScene rays(scene);
  Tracer tracer(view.shadow_bits > 0);
  const Tracer::TopLevel level = tracer.build(rays);
  const GrowScene grow{rays, &level, view.max_depth, view.shadow_bits};
  ProgramTable programs;
  return fastest(3, [&] {
    Pool<SampleRenderer> renderers;
    parallel_for(tiles.size(), [&](std::size_t i) {
      const auto renderer =
          renderers.take([&] { return std::make_unique<SampleRenderer>(grow, rays, view, programs); });
      renderer->render(tiles[i]);
    });
  });
}

}  // namespace relook
