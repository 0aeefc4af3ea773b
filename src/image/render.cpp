#include "image/render.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "base/pool.h"
#include "image/path_classes.h"
#include "image/sampling.h"
#include "image/tile_light.h"
#include "region/cell_tunnels.h"
#include "trace/tree/grow.h"
#include "trace/tree/pack.h"

namespace relook {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// What is kept of one tile: its ray trees in their stored form, with paths and their classes numbered within the tile,
/// and its tunnels.
struct TileRecord {
  PathTable paths;
  TileTrees trees;
  std::optional<PathClasses> classes;  // where a tunnel can be of one path
  std::optional<CellTunnels> cells;    // while they are filled
  Sections around;
  TileTunnels tunnels;
};

class TileRenderer {
 public:
  /// `tunnels`: null, or which to build.
  TileRenderer(const GrowScene& grow, const TilePrograms& programs, const ViewOptions& view,
               const TunnelRecord* tunnels)
      : grow_(grow),
        view_(view),
        primary_(grow.scene.camera(), view),
        shading_(programs, view.samples),
        tunnels_(tunnels) {}

  /// Traces and shades all samples of a tile. `record`: where to keep the trees, or null.
  void render(const TileRect& rect, TileLight& light, TileRecord* record, GrowCounters& counters) {
    const std::uint32_t samples = sample_count(rect, view_.samples);
    ChunkSize chunk(grow_.layout().lights);
    shading_.begin(rect, light);
    if (record != nullptr) record->trees.first_hit.push_back(0);
    for (std::uint32_t first = 0, last = 0; first < samples; first = last) {
      last = std::min(first + chunk.samples(), samples);
      block_.clear();
      roots_.clear();
      rays_.clear();
      primary_.append(rect, first, last, rays_);
      trace_trees(grow_, rays_, first, block_, roots_, counters);
      shading_.add(block_, roots_, first, light);
      if (record != nullptr) keep(*record, rect.width());
      chunk.learn(block_, last - first);
    }
  }

 private:
  /// `width`: of the tile in pixels.
  void keep(TileRecord& record, std::uint32_t width) {
    for (std::uint32_t root : roots_) {
      words_.clear();
      pack(block_, root, grow_.layout(), words_, record.trees.hits);
      const PathId path = record.paths.intern(words_);
      record.trees.paths.push_back(path);
      record.trees.first_hit.push_back(hit_place(record.trees.hits.size()));
      if (!record.cells) continue;
      PathId path_class = path;
      if (record.classes) {
        record.classes->extend(record.paths, grow_.layout(), tunnels_->atoms);
        path_class = record.classes->of(path);
      }
      record.cells->enclose(block_.nodes[root].sample / view_.samples, width, path_class, grow_.scene, block_, root);
    }
  }

  const GrowScene& grow_;
  const ViewOptions& view_;
  PrimaryRays primary_;
  TileShading shading_;
  const TunnelRecord* tunnels_;
  TreeBlock block_;
  std::vector<SpawnedRay> rays_;
  std::vector<std::uint32_t> roots_, words_;
};

/// Puts the records of tiles together to an image, in the order of the tiles, whatever thread made them.
class Merger {
 public:
  /// `tunnels`: null, or where those of the records go.
  Merger(const PathLayout& layout, Image& image, TunnelRecord* tunnels)
      : layout_(layout), image_(image), tunnels_(tunnels), classes_(tunnels != nullptr && !tunnels->atoms.empty()) {}

  void merge(TileRecord& record, std::size_t tile) {
    std::vector<PathId> ids;
    for (std::uint32_t i = 0; i < record.paths.size(); ++i)
      ids.push_back(image_.paths.intern(record.paths.words(PathId(i))));
    for (PathId& path : record.trees.paths) path = ids[path.index()];
    record.trees.hits.shrink_to_fit();  // most of what is kept of an image
    image_.trees[tile] = std::move(record.trees);
    if (tunnels_ == nullptr || tunnels_->around.empty()) return;
    if (record.classes) rename_classes(record, ids);
    tunnels_->around[tile] = std::move(record.around);
    tunnels_->of_tiles[tile] = std::move(record.tunnels);
  }

 private:
  /// `ids`: of the record's paths in the image.
  void rename_classes(TileRecord& record, const std::vector<PathId>& ids) {
    classes_.extend(image_.paths, layout_, tunnels_->atoms);
    std::vector<PathId> of_class(record.classes->size());
    for (std::uint32_t i = 0; i < ids.size(); ++i)
      of_class[record.classes->of(PathId(i)).index()] = classes_.of(ids[i]);
    record.tunnels.rename_paths([&](PathId path_class) { return of_class[path_class.index()]; });
  }

  PathLayout layout_;
  Image& image_;
  TunnelRecord* tunnels_;
  PathClasses classes_;
};

void begin_tunnels(TileRecord& record, const TileGrid& grid, const TunnelRecord& tunnels) {
  record.cells.emplace(grid, tunnels.shape.of_region);
  if (tunnels.shape.of_region > 1) record.classes.emplace(!tunnels.atoms.empty());
}

void end_tunnels(TileRecord& record) {
  record.around = record.cells->around();
  record.tunnels = record.cells->tunnels();
  record.cells.reset();
}

/// Renders some tiles; `keep`: also the paths, trees and sample colours. `tunnels`: null, or which to keep, too.
void render_tiles(const Scene& scene, Image& image, std::span<const std::size_t> tiles, bool keep, RenderStats& stats,
                  const Progress& progress, TunnelRecord* tunnels = nullptr, const MemoryMonitor& monitor = {}) {
  const auto start = Clock::now();
  const ColorScene color_scene(scene);
  const std::uint32_t shadow_bits = keep ? image.view.shadow_bits : 0;  // colours do not depend on counters
  Tracer tracer(shadow_bits > 0, monitor);
  const Tracer::TopLevel level = tracer.build(color_scene);
  stats.build_seconds = seconds_since(start);

  const auto render_start = Clock::now();
  const GrowScene grow = grow_scene(color_scene, &level, image.view, shadow_bits);
  const TilePrograms programs(color_scene);
  std::vector<GrowCounters> counters(tiles.size());
  std::vector<TileRecord> records(keep ? tiles.size() : 0);
  const std::vector<std::uint8_t> levels = tunnels != nullptr
                                               ? cell_levels(tunnels->shape, image.frame.width, image.frame.height)
                                               : std::vector<std::uint8_t>();
  Pool<TileRenderer> renderers;
  std::atomic<std::size_t> done = 0;
  std::mutex progress_mutex;
  parallel_for(tiles.size(), [&](std::size_t i) {
    const TileRect rect = tile_rect(tiles[i], image.frame.width, image.frame.height);
    TileLight light;
    const auto renderer =
        renderers.take([&] { return std::make_unique<TileRenderer>(grow, programs, image.view, tunnels); });
    if (!levels.empty()) begin_tunnels(records[i], TileGrid(levels[tiles[i]]), *tunnels);
    renderer->render(rect, light, keep ? &records[i] : nullptr, counters[i]);
    if (!levels.empty()) end_tunnels(records[i]);
    programs.set_pixels(rect, light, image.view.samples, image.frame);
    if (image.view.integrator == Integrator::path)
      image.light_sums[tiles[i]] = PackedSums::pack(light.sums);
    else if (keep)
      image.sample_colors[tiles[i]] = std::move(light.colors);
    const std::size_t finished = ++done;
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(static_cast<double>(finished) / static_cast<double>(tiles.size()));
  });
  if (!levels.empty()) {
    tunnels->around.resize(tiles.size());
    tunnels->of_tiles.resize(tiles.size());
  }
  Merger merger(grow.layout(), image, tunnels);
  for (std::size_t i = 0; keep && i < tiles.size(); ++i) merger.merge(records[i], tiles[i]);
  for (const GrowCounters& c : counters) {
    stats.counters.ray_updates += c.ray_updates;
    stats.counters.shadow_updates += c.shadow_updates;
  }
  std::uint64_t samples = 0;
  for (const std::size_t tile : tiles)
    samples += sample_count(tile_rect(tile, image.frame.width, image.frame.height), image.view.samples);
  stats.counters.samples_total = stats.counters.samples_affected = samples;
  stats.counters.color_trees_evaluated = samples;
  stats.render_seconds = seconds_since(render_start);
}

/// Renders every tile of a new image.
Image render_image(const Scene& scene, const ViewOptions& view, bool keep, RenderStats& stats, const Progress& progress,
                   TunnelRecord* tunnels, const MemoryMonitor& monitor = {}) {
  const std::uint32_t width = scene.camera.width, height = scene.camera.height;
  Image image;
  image.view = view;
  image.frame = {width, height, std::vector<Rgba>(std::size_t{width} * height)};
  std::vector<std::size_t> tiles(tile_count(width, height));
  std::iota(tiles.begin(), tiles.end(), std::size_t{0});
  image.trees.resize(keep ? tiles.size() : 0);
  const bool has_sums = view.integrator == Integrator::path;
  image.sample_colors.resize(keep && !has_sums ? tiles.size() : 0);
  image.light_sums.resize(has_sums ? tiles.size() : 0);
  render_tiles(scene, image, tiles, keep, stats, progress, tunnels, monitor);
  return image;
}

}  // namespace

Frame render(const Scene& scene, const ViewOptions& view, RenderStats& stats, const Progress& progress,
             const MemoryMonitor& monitor) {
  return std::move(render_image(scene, view, false, stats, progress, nullptr, monitor).frame);
}

Image render_with_sums(const Scene& scene, const ViewOptions& view, RenderStats& stats, const Progress& progress,
                       const MemoryMonitor& monitor) {
  return render_image(scene, view, false, stats, progress, nullptr, monitor);
}

Image preprocess(const Scene& scene, const ViewOptions& view, RenderStats& stats, const Progress& progress,
                 TunnelRecord* tunnels) {
  return render_image(scene, view, true, stats, progress, tunnels);
}

void rebuild_tiles(const Scene& scene, Image& image, std::span<const std::size_t> tiles, RenderStats& stats,
                   const Progress& progress) {
  render_tiles(scene, image, tiles, true, stats, progress);
}

}  // namespace relook
