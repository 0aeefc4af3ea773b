#include "engine/render.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>

#include "base/parallel.h"
#include "base/pool.h"
#include "color/shade.h"
#include "engine/sampling.h"
#include "trace/grow.h"

namespace relook {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The ray trees of one tile in their stored form, with paths numbered within the tile.
struct TileRecord {
  PathTable paths;
  TileTrees trees;
};

class TileRenderer {
 public:
  TileRenderer(const GrowScene& grow, const ViewOptions& view, ProgramTable& programs)
      : grow_(grow), view_(view), primary_(grow.scene.scene().camera, view), shader_(grow.scene, programs) {}

  /// Traces and shades all samples of a tile. `record`: where to keep the trees, or null.
  void render(const TileRect& rect, std::vector<Rgba>& colors, TileRecord* record, GrowCounters& counters) {
    const std::uint32_t samples = sample_count(rect, view_), chunk = chunk_samples(grow_.layout().lights);
    colors.resize(samples);
    if (record != nullptr) record->trees.first_hit.push_back(0);
    for (std::uint32_t first = 0; first < samples; first += chunk) {
      const std::uint32_t last = std::min(first + chunk, samples);
      block_.clear();
      roots_.clear();
      rays_.clear();
      primary_.append(rect, first, last, rays_);
      trace_trees(grow_, rays_, first, block_, roots_, counters);
      shader_.shade(block_, roots_, std::span(colors).subspan(first, last - first));
      if (record != nullptr) keep(*record);
    }
  }

 private:
  void keep(TileRecord& record) {
    for (std::uint32_t root : roots_) {
      words_.clear();
      pack(block_, root, grow_.layout(), words_, record.trees.hits);
      record.trees.paths.push_back(record.paths.intern(words_));
      record.trees.first_hit.push_back(hit_place(record.trees.hits.size()));
    }
  }

  const GrowScene& grow_;
  const ViewOptions& view_;
  PrimaryRays primary_;
  Shader shader_;
  TreeBlock block_;
  std::vector<SpawnedRay> rays_;
  std::vector<std::uint32_t> roots_, words_;
};

/// Numbers a tile's paths in the image's table; ids follow the order of tiles, whatever thread made them.
void merge(TileRecord& record, PathTable& paths, TileTrees& trees) {
  std::vector<PathId> ids;
  for (std::uint32_t i = 0; i < record.paths.size(); ++i) ids.push_back(paths.intern(record.paths.words(PathId(i))));
  for (PathId& path : record.trees.paths) path = ids[path.index()];
  trees = std::move(record.trees);
}

void set_pixels(const TileRect& rect, const std::vector<Rgba>& colors, std::uint32_t samples, Frame& frame) {
  const Rgba* color = colors.data();
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
    Rgba* row = &frame.pixels[std::size_t{y} * frame.width];
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x, color += samples) row[x] = pixel_color(color, samples);
  }
}

/// Renders some tiles; `keep`: also the paths, trees and sample colours.
void render_tiles(const Scene& scene, Image& image, std::span<const std::size_t> tiles, bool keep, RenderStats& stats,
                  const Progress& progress, const MemoryMonitor& monitor = {}) {
  const auto start = Clock::now();
  const RayScene ray_scene(scene);
  const std::uint32_t shadow_bits = keep ? image.view.shadow_bits : 0;  // colours do not depend on counters
  Tracer tracer(shadow_bits > 0, monitor);
  const Tracer::TopLevel level = tracer.build(ray_scene);
  stats.build_seconds = seconds_since(start);

  const auto render_start = Clock::now();
  const GrowScene grow{ray_scene, &level, image.view.max_depth, shadow_bits};
  ProgramTable programs;
  std::vector<GrowCounters> counters(tiles.size());
  std::vector<TileRecord> records(keep ? tiles.size() : 0);
  Pool<TileRenderer> renderers;
  std::atomic<std::size_t> done = 0;
  std::mutex progress_mutex;
  parallel_for(tiles.size(), [&](std::size_t i) {
    const TileRect rect = tile_rect(tiles[i], image.frame.width, image.frame.height);
    std::vector<Rgba> colors;
    const auto renderer = renderers.take([&] { return std::make_unique<TileRenderer>(grow, image.view, programs); });
    renderer->render(rect, colors, keep ? &records[i] : nullptr, counters[i]);
    set_pixels(rect, colors, image.view.samples, image.frame);
    if (keep) image.sample_colors[tiles[i]] = std::move(colors);
    const std::size_t finished = ++done;
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(static_cast<double>(finished) / static_cast<double>(tiles.size()));
  });
  for (std::size_t i = 0; keep && i < tiles.size(); ++i) merge(records[i], image.paths, image.trees[tiles[i]]);
  for (const GrowCounters& c : counters) {
    stats.counters.ray_updates += c.ray_updates;
    stats.counters.shadow_updates += c.shadow_updates;
  }
  std::uint64_t samples = 0;
  for (const std::size_t tile : tiles)
    samples += sample_count(tile_rect(tile, image.frame.width, image.frame.height), image.view);
  stats.counters.samples_total = stats.counters.samples_affected = samples;
  stats.counters.color_trees_evaluated = samples;
  stats.render_seconds = seconds_since(render_start);
}

/// Renders every tile of a new image.
Image render_image(const Scene& scene, const ViewOptions& view, bool keep, RenderStats& stats,
                   const Progress& progress, const MemoryMonitor& monitor = {}) {
  const std::uint32_t width = scene.camera.width, height = scene.camera.height;
  Image image;
  image.view = view;
  image.frame = {width, height, std::vector<Rgba>(std::size_t{width} * height)};
  std::vector<std::size_t> tiles(tile_count(width, height));
  std::iota(tiles.begin(), tiles.end(), std::size_t{0});
  image.trees.resize(keep ? tiles.size() : 0);
  image.sample_colors.resize(keep ? tiles.size() : 0);
  render_tiles(scene, image, tiles, keep, stats, progress, monitor);
  return image;
}

}  // namespace

Frame render(const Scene& scene, const ViewOptions& view, RenderStats& stats, const Progress& progress,
             const MemoryMonitor& monitor) {
  return std::move(render_image(scene, view, false, stats, progress, monitor).frame);
}

Image preprocess(const Scene& scene, const ViewOptions& view, RenderStats& stats, const Progress& progress) {
  return render_image(scene, view, true, stats, progress);
}

void rebuild_tiles(const Scene& scene, Image& image, std::span<const std::size_t> tiles, RenderStats& stats,
                   const Progress& progress) {
  render_tiles(scene, image, tiles, true, stats, progress);
}

}  // namespace relook
