#include "engine/replay.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "engine/sampling.h"
#include "engine/scene_level.h"
#include "engine/tile_update.h"

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

bool same_bits(const Rgba& a, const Rgba& b) { return std::memcmp(&a, &b, sizeof(Rgba)) == 0; }

/// Colours of single samples in place of the stored ones: those of an intermediate frame of a drag.
struct Overlay {
  std::vector<std::uint32_t> samples;  // increasing
  std::vector<Rgba> colors;
};

/// Puts the new trees of a tile in place of the old ones. `ids`: of the update's paths in the image's table.
void store_trees(TileTrees& trees, const TileUpdate& update, const std::vector<PathId>& ids) {
  TileTrees next;
  next.paths = std::move(trees.paths);
  next.first_hit.reserve(trees.first_hit.size());
  next.first_hit.push_back(0);
  next.hits.reserve(trees.hits.size());
  std::size_t k = 0;
  for (std::uint32_t sample = 0; sample < next.paths.size(); ++sample) {
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

/// The tiles with anything to do, most work first, so that threads end together.
std::vector<std::size_t> by_work(const std::vector<TileWork>& works) {
  std::vector<std::size_t> tiles;
  for (std::size_t tile = 0; tile < works.size(); ++tile)
    if (works[tile].leaves.any()) tiles.push_back(tile);
  std::ranges::stable_sort(tiles, std::greater(), [&](std::size_t tile) { return works[tile].leaves.count(); });
  return tiles;
}

}  // namespace

struct Replayer::Impl {
  SceneState state;
  Image image;
  RayScene rays;
  std::vector<LightId> lights;  // light order of the stored paths
  PathIndex index;
  PathClasses classes;
  std::vector<ObjectId> atoms;  // see atoms_of(); empty without atoms
  ImageRegions regions;
  std::vector<std::uint64_t> tile_segments;
  std::uint64_t segments = 0, samples_total = 0;
  std::size_t compact_paths;  // size of the path table when it last held no unused paths
  ProgramTable programs;
  std::unique_ptr<SceneLevel> level;  // made when a step first needs rays
  std::vector<ObjectId> lifted;       // objects that a drag has taken out of the ray trees, increasing
  std::vector<Overlay> overlays;      // by tile, while objects are lifted

  Impl(SceneState s, Image i, const RegionOptions& options)
      : state(std::move(s)),
        image(std::move(i)),
        rays(state.scene()),
        lights(state.scene().light_order),
        regions(options),
        compact_paths(image.paths.size()) {
    if (regions.options().atoms > 0) atoms = atoms_of(state, regions.options().atoms);
    for (const TileTrees& tile : image.trees) samples_total += tile.paths.size();
    index_paths();
    count_segments();
    regions.build_groups(image, class_of());
  }

  /// Of the stored paths.
  [[nodiscard]] PathLayout layout() const { return {lights.size(), image.view.shadow_bits}; }
  [[nodiscard]] ClassOf class_of() const {
    return [this](PathId path) { return classes.of(path); };
  }
  [[nodiscard]] GrowScene grow(const Tracer::TopLevel* scene_level) const {
    return {rays, scene_level, image.view.max_depth, image.view.shadow_bits};
  }

  void index_paths() {
    index.extend(image.paths, layout());
    classes.extend(image.paths, layout(), atoms);
  }

  void count_segments() {
    tile_segments.assign(image.trees.size(), 0);
    parallel_for(image.trees.size(), [&](std::size_t tile) {
      for (PathId path : image.trees[tile].paths) tile_segments[tile] += index.segments(path);
    });
    segments = 0;
    for (std::uint64_t count : tile_segments) segments += count;
  }

  void forget_programs(const StepChange& change) {
    if (change.rays.lights_changed) {
      programs.clear();
      return;
    }
    for (const auto& [material, fields] : change.colors.materials) programs.forget(material);
    if (change.colors.environment) programs.forget_environment();
  }

  // ---- one pass over the image

  /// What one pass did, for the report.
  struct PassResult {
    std::vector<TileUpdate> updates;  // by tile
    std::vector<TileWork> works;
  };

  /// Works `change` out against the stored trees; `absent`: objects that are in no ray tree afterwards.
  PassResult run(StepChange& change, std::span<const ObjectId> absent, bool keeps_trees, StepResult& result,
                 StopWatch& watch) {
    const PathTasks tasks = find_path_tasks(
        {rays, image.paths, index, lights, image.view.shadow_bits, classes}, change, programs);
    watch.lap(result.seconds.select);
    const Tracer::TopLevel* scene_level = nullptr;
    if (change.touches_rays()) {
      if (!level) level = std::make_unique<SceneLevel>(image.view.shadow_bits > 0);
      scene_level = &level->current(rays, absent);
      build_selection(change, rays, absent, level->tracer());
    }
    const GrowScene scene = grow(scene_level);
    ChangeBoxes boxes;
    const std::vector<LightEnd> ends = light_ends(state.scene());
    const bool uses_tunnels =
        regions.options().tunnels > 0 && change.touches_segments() && !change.rays.lights_changed;
    if (uses_tunnels) {
      boxes = boxes_of(change, rays, absent);
      boxes.count_blockers = image.view.shadow_bits > 0;
    }
    const TunnelTest tunnel_test{boxes, ends};
    const UpdatePass pass{image,   lights,  scene,    change,
                          tasks,   classes, regions,  uses_tunnels ? &tunnel_test : nullptr,
                          programs, keeps_trees};
    PassResult done;
    done.updates.resize(image.trees.size());
    done.works.resize(image.trees.size());
    parallel_for(image.trees.size(), [&](std::size_t tile) { done.works[tile] = find_tile_work(pass, tile); });
    watch.lap(result.seconds.test);
    Pool<Shader> shaders;
    const std::vector<std::size_t> tiles = by_work(done.works);
    parallel_for(tiles.size(), [&](std::size_t i) {
      done.updates[tiles[i]] = update_tile(pass, tiles[i], done.works[tiles[i]], shaders);
    });
    watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
    count(done, result);
    return done;
  }

  static void count(const PassResult& done, StepResult& result) {
    Counters& counters = result.counters;
    result.dependent.resize(done.works.size());
    result.touched.resize(done.works.size());
    for (std::size_t tile = 0; tile < done.updates.size(); ++tile) {
      const TileUpdate& update = done.updates[tile];
      const TileWork& work = done.works[tile];
      result.dependent[tile] |= work.by_path;
      for (const LeafTouches& leaf : work.touched) result.touched[tile].set(leaf.leaf);
      counters.samples_affected += update.shaded.size();
      counters.ray_tests += update.counters.ray_tests;
      counters.ray_updates += update.counters.ray_updates;
      counters.shadow_updates += update.counters.shadow_updates;
      counters.regions_visited += work.by_groups.visited + work.by_tunnels.visited;
      counters.regions_culled += work.by_groups.culled + work.by_tunnels.culled;
    }
  }

  // ---- keeping what a pass found

  /// Stores new trees and keeps the regions equal to what would be built from them.
  void keep_trees(const std::vector<TileUpdate>& updates, const StepChange& change) {
    if (!change.touches_rays()) return;
    // Another light order means another form of every path: all samples have been packed anew.
    const bool is_new_table = change.rays.lights_changed;
    if (is_new_table) {
      image.paths = PathTable();
      index.clear();
      classes.clear();
    }
    lights = state.scene().light_order;
    std::vector<std::vector<PathId>> ids(updates.size());
    for (std::size_t tile = 0; tile < updates.size(); ++tile)
      for (std::uint32_t i = 0; i < updates[tile].paths.size(); ++i)
        ids[tile].push_back(image.paths.intern(updates[tile].paths.words(PathId(i))));
    index_paths();
    const GrowScene scene = grow(nullptr);
    parallel_for(updates.size(), [&](std::size_t tile) {
      if (updates[tile].packed.empty()) return;
      store_trees(image.trees[tile], updates[tile], ids[tile]);
      tile_segments[tile] = 0;
      for (PathId path : image.trees[tile].paths) tile_segments[tile] += index.segments(path);
      regions.update(image, scene, tile, leaves_of(tile, updates[tile].packed), class_of());
    });
    segments = 0;
    for (std::uint64_t count : tile_segments) segments += count;
    if (image.paths.size() > 4 * compact_paths + 4096) drop_unused_paths();
  }

  [[nodiscard]] Leaves leaves_of(std::size_t tile, const std::vector<std::uint32_t>& samples) const {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    Leaves leaves;
    for (std::uint32_t sample : samples) leaves.set(leaf_of(sample / image.view.samples, rect.x1 - rect.x0));
    return leaves;
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
    index.clear();
    classes.clear();
    index_paths();
    regions.build_groups(image, class_of());
    if (regions.has_tunnels() && regions.options().tunnels > 1) regions.build_tunnels(image, grow(nullptr), class_of());
  }

  void keep_colors(const std::vector<TileUpdate>& updates) {
    for (std::size_t tile = 0; tile < updates.size(); ++tile)
      for (std::size_t k = 0; k < updates[tile].shaded.size(); ++k)
        image.sample_colors[tile][updates[tile].shaded[k]] = updates[tile].colors[k];
  }

  /// Works the pixels of some samples out again and notes those that differ.
  void refresh_pixels(std::size_t tile, const std::vector<std::uint32_t>& samples,
                      std::vector<std::uint32_t>& changed_pixels) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    const std::vector<Rgba>& stored = image.sample_colors[tile];
    const Overlay* overlay = overlays.empty() ? nullptr : &overlays[tile];
    std::vector<Rgba> colors(image.view.samples);
    std::uint32_t last_pixel = kNoNode;
    for (std::uint32_t sample : samples) {
      const std::uint32_t pixel = sample / image.view.samples;
      if (pixel == last_pixel) continue;
      last_pixel = pixel;
      const std::uint32_t first = pixel * image.view.samples;
      std::copy_n(stored.begin() + first, image.view.samples, colors.begin());
      if (overlay != nullptr) {
        auto at = std::ranges::lower_bound(overlay->samples, first) - overlay->samples.begin();
        for (; at < std::ssize(overlay->samples) && overlay->samples[static_cast<std::size_t>(at)] < first + colors.size(); ++at)
          colors[overlay->samples[static_cast<std::size_t>(at)] - first] = overlay->colors[static_cast<std::size_t>(at)];
      }
      const std::size_t place = frame_index(rect, pixel, image.frame.width);
      const Rgba color = pixel_color(colors.data(), image.view.samples);
      if (same_bits(color, image.frame.pixels[place])) continue;
      image.frame.pixels[place] = color;
      changed_pixels.push_back(static_cast<std::uint32_t>(place));
    }
  }

  // ---- steps

  /// Applies the edit to the scene and finds what it means.
  StepChange begin(const Edit& edit, std::string_view file, const std::filesystem::path& folder, StepResult& result) {
    const SceneDelta delta = apply_edit(state, edit, file, folder);
    result.classification = classify(state.scene(), delta);
    // Tunnels hold for the scene in which the trees were made; they are built when a change first needs them.
    StepChange change = find_change(rays, state.scene(), delta, lights);
    if (change.touches_segments() && !change.rays.lights_changed && !regions.has_tunnels())
      regions.build_tunnels(image, grow(nullptr), class_of());
    rays.update(state.scene(), delta);
    if (regions.options().atoms > 0 && atoms.size() != state.scene().objects.size()) atoms = atoms_of(state, regions.options().atoms);
    if (level) level->note_changed(selection_of(change));
    forget_programs(change);
    result.counters.samples_total = samples_total;
    return change;
  }

  StepResult step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
    require(lifted.empty(), "a drag is released before the next step");
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, file, folder, result);
    watch.lap(result.seconds.classify);
    update(change, result, watch);
    return result;
  }

  /// Brings trees, colours and frame up to date with the scene.
  void update(StepChange& change, StepResult& result, StopWatch& watch) {
    const std::uint64_t segments_before = segments;
    if (change.touches_rays() || !change.colors.empty()) {
      const PassResult done = run(change, {}, true, result, watch);
      keep_trees(done.updates, change);
      watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
      keep_colors(done.updates);
      for (std::size_t tile = 0; tile < done.updates.size(); ++tile)
        refresh_pixels(tile, done.updates[tile].shaded, result.changed_pixels);
      watch.lap(result.seconds.evaluate);
    }
    finish(result, segments_before);
  }

  static void finish(StepResult& result, std::uint64_t segments_before) {
    std::ranges::sort(result.changed_pixels);
    Counters& counters = result.counters;
    counters.color_trees_evaluated = counters.samples_affected;
    counters.pixels_changed = result.changed_pixels.size();
    counters.ray_tests_culled = segments_before - std::min(segments_before, counters.ray_tests);
  }

  /// The change that puts the lifted objects, where they are now, back into the ray trees.
  [[nodiscard]] StepChange put_back() const {
    StepChange change;
    RayChange& r = change.rays;
    r.objects.assign(state.scene().objects.size(), 0);
    r.before_index.assign(state.scene().objects.size(), kNoNode);
    for (ObjectId id : lifted) r.objects[id.index()] = RayChange::moved | RayChange::shadows;
    r.old_lights = lights;
    for (std::uint32_t i = 0; i < lights.size(); ++i) r.old_light_index.push_back(i);
    change.any_moved = change.any_shadows = !lifted.empty();
    return change;
  }

  StepResult drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, file, folder, result);
    watch.lap(result.seconds.classify);
    const std::uint64_t segments_before = segments;
    if (!is_movement(change)) {
      // Lights move with the selection, say: not the paper's kind of drag. All that is lifted goes back, too.
      for (ObjectId id : lifted) {
        change.rays.objects[id.index()] |= RayChange::moved | RayChange::shadows;
        change.rays.before_index[id.index()] = kNoNode;  // in no tree
      }
      change.any_moved = change.any_shadows = change.any_shadows || !lifted.empty();
      const std::vector<Overlay> shown = std::exchange(overlays, {});
      lifted.clear();
      update(change, result, watch);
      for (std::size_t tile = 0; tile < shown.size(); ++tile)
        refresh_pixels(tile, shown[tile].samples, result.changed_pixels);
      finish(result, segments_before);
      return result;
    }
    const std::vector<TileUpdate> removed = remove_selection(change, result, watch);
    show_selection(removed, result, watch);
    finish(result, segments_before);
    return result;
  }

  /// Only objects that are elsewhere now, or gone.
  static bool is_movement(const StepChange& change) {
    if (!change.colors.empty() || change.rays.lights_changed || change.any_respawns) return false;
    return std::ranges::all_of(change.rays.objects, [](std::uint8_t flags) {
      return flags == 0 || flags == (RayChange::moved | RayChange::shadows);
    });
  }

  /// First step of a drag (paper 2.2): what moves and is still in the ray trees is taken out of them. The frame is not
  /// brought up to date yet.
  std::vector<TileUpdate> remove_selection(StepChange& change, StepResult& result, StopWatch& watch) {
    std::vector<ObjectId> all;
    std::ranges::set_union(lifted, selection_of(change), std::back_inserter(all));
    if (all.size() == lifted.size()) return {};
    if (overlays.empty()) overlays.resize(image.trees.size());
    for (ObjectId id : lifted) change.rays.objects[id.index()] = 0;  // not in any tree
    lifted = std::move(all);
    PassResult done = run(change, lifted, true, result, watch);
    keep_trees(done.updates, change);
    keep_colors(done.updates);
    watch.lap(result.seconds.update);
    return std::move(done.updates);
  }

  /// Second step: the selection is rendered where it is; the ray trees stay without it. `removed`: what the first step
  /// has changed.
  void show_selection(const std::vector<TileUpdate>& removed, StepResult& result, StopWatch& watch) {
    if (lifted.empty()) return;  // nothing has moved yet
    StepChange change = put_back();
    const PassResult done = run(change, {}, false, result, watch);
    for (std::size_t tile = 0; tile < done.updates.size(); ++tile) {
      const TileUpdate& update = done.updates[tile];
      const std::vector<std::uint32_t> shown = std::exchange(overlays[tile].samples, update.shaded);
      overlays[tile].colors = update.colors;
      if (!removed.empty()) refresh_pixels(tile, removed[tile].shaded, result.changed_pixels);
      refresh_pixels(tile, shown, result.changed_pixels);
      refresh_pixels(tile, update.shaded, result.changed_pixels);
    }
    watch.lap(result.seconds.evaluate);
  }

  /// Last step: the selection goes into the ray trees; the frame stays as it is.
  StepResult release() {
    StepResult result;
    StopWatch watch;
    result.counters.samples_total = samples_total;
    if (lifted.empty()) return result;
    StepChange change = put_back();
    lifted.clear();
    overlays.clear();
    update(change, result, watch);
    return result;
  }
};

Replayer::Replayer(SceneState state, Image image, const RegionOptions& options)
    : impl_(std::make_unique<Impl>(std::move(state), std::move(image), options)) {}
Replayer::~Replayer() = default;
Replayer::Replayer(Replayer&&) noexcept = default;

const SceneState& Replayer::state() const { return impl_->state; }
const Image& Replayer::image() const { return impl_->image; }
const ImageRegions& Replayer::regions() const { return impl_->regions; }
std::uint64_t Replayer::segments() const { return impl_->segments; }

Resident Replayer::resident() const {
  Resident resident;
  resident.ray_paths = impl_->image.paths.bytes() + impl_->index.bytes();
  for (const TileTrees& tile : impl_->image.trees) {
    resident.ray_paths += tile.paths.size() * sizeof(PathId);
    resident.ray_trees += tile.first_hit.size() * sizeof(std::uint32_t) + tile.hits.size() * sizeof(Hit);
  }
  resident.tunnels = impl_->regions.group_bytes() + impl_->regions.tunnel_bytes();
  // Until colour trees are kept, what is kept of them is their result: a colour a sample.
  for (const std::vector<Rgba>& colors : impl_->image.sample_colors)
    resident.color_trees += colors.size() * sizeof(Rgba);
  const std::uint64_t frame = impl_->image.frame.pixels.size() * sizeof(Rgba);
  resident.total = resident.ray_paths + resident.ray_trees + resident.color_trees + resident.tunnels + frame;
  return resident;
}

StepResult Replayer::step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return impl_->step(edit, file, folder);
}
StepResult Replayer::drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return impl_->drag(edit, file, folder);
}
StepResult Replayer::release() { return impl_->release(); }

}  // namespace relook
