#include "engine/replay.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "base/parallel.h"
#include "base/pool.h"
#include "color/shade.h"
#include "engine/change.h"
#include "engine/sampling.h"

namespace relook {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time since the last call to a field of Seconds.
class StopWatch {
 public:
  void lap(double& seconds) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

/// What a step has to do with the samples of one path.
struct PathTask {
  bool update = false;  // their ray trees may change
  bool shade = false;   // their colours may
};

/// What became of the samples of one tile.
struct TileUpdate {
  std::vector<std::uint32_t> shaded;  // samples with new colours, increasing
  std::vector<Rgba> colors;           // of `shaded`
  std::vector<std::uint32_t> packed;  // samples with new trees, increasing
  PathTable paths;                    // of `packed`, numbered within the tile
  std::vector<PathId> packed_paths;
  std::vector<Hit> hits;
  std::vector<std::uint32_t> first_hit{0};
  GrowCounters counters;
};

std::uint64_t segments_of(std::span<const std::uint32_t> path, std::size_t lights) {
  std::uint64_t segments = 0;
  for (PathCursor cursor(path, lights); !cursor.at_end();) {
    const PathNode node = cursor.next();
    ++segments;
    for (std::size_t light = 0; !node.is_miss() && light < lights; ++light)
      segments += shadow_state(node.lights, light) != ShadowState::facing_away ? 1U : 0U;
  }
  return segments;
}

bool same_bits(const Rgba& a, const Rgba& b) { return std::memcmp(&a, &b, sizeof(Rgba)) == 0; }

constexpr std::size_t kChunkSamples = 2048;

}  // namespace

struct Replayer::Impl {
  SceneState state;
  Image image;
  RayScene rays;
  std::vector<LightId> lights;  // light order of the stored paths
  std::uint64_t segments = 0;
  std::size_t compact_paths;  // size of the path table when it last held no unused paths
  ProgramTable programs;
  std::unique_ptr<Tracer> tracer;  // made when a step first needs rays
  Tracer::TopLevel level;
  bool level_is_current = false;

  Impl(SceneState s, Image i)
      : state(std::move(s)),
        image(std::move(i)),
        rays(state.scene()),
        lights(state.scene().light_order),
        compact_paths(image.paths.size()) {
    segments = count_segments();
  }

  [[nodiscard]] std::uint64_t count_segments() const {
    std::vector<std::uint64_t> of_path(image.paths.size());
    for (std::uint32_t p = 0; p < of_path.size(); ++p)
      of_path[p] = segments_of(image.paths.words(PathId(p)), lights.size());
    std::uint64_t sum = 0;
    for (const TileTrees& tile : image.trees)
      for (PathId path : tile.paths) sum += of_path[path.index()];
    return sum;
  }

  void forget_programs(const StepChange& change) {
    if (change.rays.lights_changed) {
      programs.clear();
      return;
    }
    for (const auto& [material, fields] : change.colors.materials) programs.forget(material);
    if (change.colors.environment) programs.forget_environment();
  }

  void prepare_rays(StepChange& change) {
    if (!change.touches_rays()) return;
    if (!tracer) tracer = std::make_unique<Tracer>();
    if (!level_is_current) level = tracer->build(rays);
    level_is_current = true;
    build_selection(change, rays, *tracer);
  }

  [[nodiscard]] PathTask task_of(std::span<const std::uint32_t> path, const StepChange& change) {
    PathTask task;
    task.update = change.touches_all_paths();
    if (!task.update && change.any_respawns) task.update = mentions(path, change);
    if (!change.colors.empty()) task.shade = depends(path, change.colors);
    return task;
  }

  [[nodiscard]] bool mentions(std::span<const std::uint32_t> path, const StepChange& change) const {
    for (PathCursor cursor(path, lights.size()); !cursor.at_end();) {
      const PathNode node = cursor.next();
      if (!node.is_miss() && change.rays.flags(node.object()) != 0) return true;
    }
    return false;
  }

  [[nodiscard]] bool depends(std::span<const std::uint32_t> path, const ColorChange& colors) {
    const Scene& scene = state.scene();
    const std::vector<ObjectId> objects = objects_of(path);
    const auto is_reassigned = [&](ObjectId id) {
      return std::ranges::find(colors.reassigned, id) != colors.reassigned.end();
    };
    if (!colors.reassigned.empty() && std::ranges::any_of(objects, is_reassigned)) return true;
    const bool is_global = !colors.lights.empty() || colors.ambient || colors.environment;
    const auto has_changed_material = [&](ObjectId id) { return colors.fields_of(scene.object(id).material) != 0; };
    return (is_global || std::ranges::any_of(objects, has_changed_material)) && reaches_any_program(path, colors);
  }

  [[nodiscard]] bool reaches_any_program(std::span<const std::uint32_t> path, const ColorChange& colors) {
    std::vector<NodeKey> keys;
    append_keys(rays, path, lights, keys);
    return std::ranges::any_of(keys,
                               [&](const NodeKey& key) { return colors.reaches(programs.get(state.scene(), key)); });
  }

  /// Every object of a path, filters included.
  [[nodiscard]] std::vector<ObjectId> objects_of(std::span<const std::uint32_t> path) const {
    std::vector<ObjectId> objects;
    for (PathCursor cursor(path, lights.size()); !cursor.at_end();) {
      const PathNode node = cursor.next();
      if (node.is_miss()) continue;
      objects.push_back(node.object());
      for (std::size_t i = 0; i < node.filters.size(); i += 1 + node.filters[i])
        for (std::uint32_t f = 0; f < node.filters[i]; ++f) objects.emplace_back(node.filters[i + 1 + f]);
    }
    return objects;
  }

  [[nodiscard]] std::vector<PathTask> find_tasks(const StepChange& change) {
    std::vector<PathTask> tasks(image.paths.size());
    constexpr std::size_t kGrain = 256;
    parallel_for(
        tasks.size(),
        [&](std::size_t p) { tasks[p] = task_of(image.paths.words(PathId(static_cast<std::uint32_t>(p))), change); },
        kGrain);
    return tasks;
  }

  void update_tile(std::size_t tile, const StepChange& change, const std::vector<PathTask>& tasks,
                   Pool<Shader>& shaders, TileUpdate& update) {
    const Frame& frame = image.frame;
    const TileRect rect = tile_rect(tile, frame.width, frame.height);
    const TileTrees& trees = image.trees[tile];
    const GrowScene grow{rays, &level, image.view.max_depth};
    const PrimaryRays primaries(state.scene().camera, image.view);
    const auto shader = shaders.take([&] { return std::make_unique<Shader>(rays, programs); });
    TreeBlock block;
    std::vector<std::uint32_t> roots, chunk, words;
    const auto flush = [&] {
      if (roots.empty()) return;
      const std::size_t first = update.colors.size();
      update.shaded.insert(update.shaded.end(), chunk.begin(), chunk.end());
      update.colors.resize(first + chunk.size());
      shader->shade(block, roots, std::span(update.colors).subspan(first));
      block.clear();
      roots.clear();
      chunk.clear();
    };
    for (std::uint32_t sample = 0; sample < trees.paths.size(); ++sample) {
      const PathTask task = tasks[trees.paths[sample].index()];
      if (!task.update && !task.shade) continue;
      const SpawnedRay primary = primaries.ray(rect, sample);
      const StoredTree stored{PathCursor(image.paths.words(trees.paths[sample]), lights.size()),
                              trees.hits_of(sample).data()};
      const TreeBlock::Mark mark = block.mark();
      bool changed = false;
      std::uint32_t root = 0;
      if (task.update)
        root = update_tree(grow, change.rays, primary, sample, stored, block, update.counters, changed);
      else
        root = expand_tree(grow, primary, sample, stored, block);
      if (changed || (task.update && change.rays.lights_changed)) pack_sample(block, root, sample, words, update);
      if (changed || task.shade) {
        roots.push_back(root);
        chunk.push_back(sample);
        if (chunk.size() == kChunkSamples) flush();
      } else {
        block.rewind(mark);
      }
    }
    flush();
  }

  void pack_sample(const TreeBlock& block, std::uint32_t root, std::uint32_t sample, std::vector<std::uint32_t>& words,
                   TileUpdate& update) const {
    words.clear();
    update.packed.push_back(sample);
    pack(block, root, state.scene().light_order.size(), words, update.hits);
    update.packed_paths.push_back(update.paths.intern(words));
    update.first_hit.push_back(static_cast<std::uint32_t>(update.hits.size()));
  }

  /// Puts the new trees of a tile in place of the old ones; paths are numbered in the order of tiles and samples.
  void store_trees(TileTrees& trees, const TileUpdate& update) {
    if (update.packed.empty()) return;
    std::vector<PathId> ids;
    for (std::uint32_t i = 0; i < update.paths.size(); ++i)
      ids.push_back(image.paths.intern(update.paths.words(PathId(i))));
    TileTrees next;
    next.paths = trees.paths;
    next.first_hit.reserve(trees.first_hit.size());
    next.first_hit.push_back(0);
    next.hits.reserve(trees.hits.size());
    std::size_t k = 0;
    for (std::uint32_t sample = 0; sample < trees.paths.size(); ++sample) {
      std::span<const Hit> hits = trees.hits_of(sample);
      if (k < update.packed.size() && update.packed[k] == sample) {
        next.paths[sample] = ids[update.packed_paths[k].index()];
        hits = std::span(update.hits).subspan(update.first_hit[k], update.first_hit[k + 1] - update.first_hit[k]);
        ++k;
      }
      next.hits.insert(next.hits.end(), hits.begin(), hits.end());
      next.first_hit.push_back(static_cast<std::uint32_t>(next.hits.size()));
    }
    trees = std::move(next);
  }

  void store_colors(std::size_t tile, const TileUpdate& update, std::vector<std::uint32_t>& changed_pixels) {
    Frame& frame = image.frame;
    const TileRect rect = tile_rect(tile, frame.width, frame.height);
    std::vector<Rgba>& colors = image.sample_colors[tile];
    std::uint32_t last_pixel = kNoNode;
    for (std::size_t k = 0; k < update.shaded.size(); ++k) colors[update.shaded[k]] = update.colors[k];
    for (std::uint32_t sample : update.shaded) {
      const std::uint32_t pixel = sample / image.view.samples;
      if (pixel == last_pixel) continue;
      last_pixel = pixel;
      const std::size_t index = frame_index(rect, pixel, frame.width);
      const Rgba color = pixel_color(&colors[std::size_t{pixel} * image.view.samples], image.view.samples);
      if (same_bits(color, frame.pixels[index])) continue;
      frame.pixels[index] = color;
      changed_pixels.push_back(static_cast<std::uint32_t>(index));
    }
  }

  void store(const std::vector<TileUpdate>& updates, const StepChange& change, StepResult& result) {
    // Another light order means another form of every path: all samples have been packed anew.
    if (change.rays.lights_changed) image.paths = PathTable();
    for (std::size_t tile = 0; tile < updates.size(); ++tile) {
      store_trees(image.trees[tile], updates[tile]);
      store_colors(tile, updates[tile], result.changed_pixels);
    }
    std::ranges::sort(result.changed_pixels);
    lights = state.scene().light_order;
    if (!change.touches_rays()) return;
    if (image.paths.size() > 4 * compact_paths + 4096) drop_unused_paths();
    segments = count_segments();
  }

  /// Numbers the paths in use afresh, in the order of tiles and samples.
  void drop_unused_paths() {
    PathTable used;
    std::vector<PathId> ids(image.paths.size(), PathId::none());
    for (TileTrees& tile : image.trees)
      for (PathId& path : tile.paths) {
        PathId& id = ids[path.index()];
        if (id.is_none()) id = used.intern(image.paths.words(path));
        path = id;
      }
    image.paths = std::move(used);
    compact_paths = image.paths.size();
  }

  StepResult step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
    StepResult result;
    StopWatch watch;
    const SceneDelta delta = apply_edit(state, edit, file, folder);
    result.classification = classify(state.scene(), delta);
    StepChange change = find_change(rays, state.scene(), delta, lights);
    rays.update(state.scene(), delta);
    if (change.any_shadows) level_is_current = false;
    forget_programs(change);
    watch.lap(result.seconds.classify);

    Counters& counters = result.counters;
    for (const TileTrees& tile : image.trees) counters.samples_total += tile.paths.size();
    const std::uint64_t segments_before = segments;
    if (change.touches_rays() || !change.colors.empty()) {
      const std::vector<PathTask> tasks = find_tasks(change);
      watch.lap(result.seconds.select);
      prepare_rays(change);
      watch.lap(result.seconds.test);
      std::vector<TileUpdate> updates(image.trees.size());
      Pool<Shader> shaders;
      parallel_for(updates.size(), [&](std::size_t tile) { update_tile(tile, change, tasks, shaders, updates[tile]); });
      watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
      store(updates, change, result);
      watch.lap(result.seconds.evaluate);
      for (const TileUpdate& update : updates) {
        counters.samples_affected += update.shaded.size();
        counters.ray_tests += update.counters.ray_tests;
        counters.ray_updates += update.counters.ray_updates;
        counters.shadow_updates += update.counters.shadow_updates;
      }
    }
    counters.color_trees_evaluated = counters.samples_affected;
    counters.pixels_changed = result.changed_pixels.size();
    counters.ray_tests_culled = segments_before - counters.ray_tests;
    return result;
  }
};

Replayer::Replayer(SceneState state, Image image) : impl_(std::make_unique<Impl>(std::move(state), std::move(image))) {}
Replayer::~Replayer() = default;
Replayer::Replayer(Replayer&&) noexcept = default;

const SceneState& Replayer::state() const { return impl_->state; }
const Image& Replayer::image() const { return impl_->image; }
std::uint64_t Replayer::segments() const { return impl_->segments; }

Resident Replayer::resident() const {
  Resident resident;
  resident.ray_paths = impl_->image.paths.bytes();
  for (const TileTrees& tile : impl_->image.trees) {
    resident.ray_paths += tile.paths.size() * sizeof(PathId);
    resident.ray_trees += tile.first_hit.size() * sizeof(std::uint32_t) + tile.hits.size() * sizeof(Hit);
  }
  // Until colour trees are kept, what is kept of them is their result: a colour a sample.
  for (const std::vector<Rgba>& colors : impl_->image.sample_colors)
    resident.color_trees += colors.size() * sizeof(Rgba);
  const std::uint64_t frame = impl_->image.frame.pixels.size() * sizeof(Rgba);
  resident.total = resident.ray_paths + resident.ray_trees + resident.color_trees + frame;
  return resident;
}

StepResult Replayer::step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return impl_->step(edit, file, folder);
}

}  // namespace relook
