#include "replay/replay.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "image/stored_image.h"
#include "replay/kept_selection.h"
#include "replay/recolor.h"
#include "trace/scene_level.h"

namespace relook {
namespace {

/// How many values two increasing lists have in common.
std::size_t common(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both.size();
}

}  // namespace

struct Replayer::Impl {
  SceneState state;
  RayScene rays;
  std::unique_ptr<Residency> owned_residency;
  Residency& residency{*owned_residency};
  StoredImage stored;
  ObjectLevels objects{rays, monitor()};
  ProgramTable programs;
  KeptSelection selection{stored.samples()};  // a byte a sample
  ColorTreeStore compressed;
  Recolorer recolorer{stored, rays, objects, programs, selection, compressed};
  std::unique_ptr<SceneLevel> level;  // made when a step first needs rays
  std::vector<ObjectId> lifted;       // objects that a drag has taken out of the ray trees, increasing
  std::vector<ShownSamples> on_top;   // by tile, while objects are lifted: where they are seen

  Impl(SceneState s, Image i, const RegionOptions& options, std::unique_ptr<Residency> pieces,
       std::shared_ptr<StoredTunnels> tunnels)
      : state(std::move(s)),
        rays(state.scene()),
        owned_residency(with_tracking(std::move(pieces), options.ray_trees < 1 || tunnels)),
        stored(std::move(i), state.scene().light_order, atoms(options.atoms), options, residency),
        compressed(image().trees.size(),
                   static_cast<std::uint64_t>(static_cast<double>(stored.samples()) * options.color_trees)) {
    residency.set_others([this] { return compressed.bytes(); },
                         [this](std::vector<Victim>& victims) {
                           compressed.list_victims(residency.policy(), residency.change(), victims);
                         });
    stored.forget_hits(options.ray_trees);
    if (tunnels && options.has_tunnels_of(tunnels->shape())) stored.offer_tunnels(std::move(tunnels));
  }

  static std::unique_ptr<Residency> with_tracking(std::unique_ptr<Residency> pieces, bool may_miss_pieces) {
    if (!pieces) pieces = std::make_unique<Residency>(ResidencyOptions());
    if (may_miss_pieces) pieces->track();
    return pieces;
  }

  /// Of acceleration structures: what they take has no other place to go.
  [[nodiscard]] MemoryMonitor monitor() {
    if (!residency.is_limited()) return {};
    return [this](std::int64_t bytes) { residency.claim(bytes); };
  }

  [[nodiscard]] const Image& image() const { return stored.image(); }
  [[nodiscard]] std::vector<ObjectId> atoms(std::uint32_t depth) const {
    return depth > 0 ? atoms_of(state, depth) : std::vector<ObjectId>();
  }
  [[nodiscard]] bool has_atoms() const { return stored.regions().options().atoms > 0; }
  [[nodiscard]] GrowScene grow(const Tracer::TopLevel* scene_level) const {
    return {rays, scene_level, image().view.max_depth, image().view.shadow_bits, &objects};
  }

  void forget_programs(const StepChange& change) {
    if (change.rays.lights_changed) {
      programs.clear();
      compressed.clear();
      return;
    }
    compressed.note_colors(change.colors);
    for (const MaterialId material : change.colors.restructured) programs.forget(material);
    if (change.colors.new_environment) programs.forget_environment();
  }

  /// Works `change` out against the stored trees; `absent`: objects that are in no ray tree afterwards. Returns the
  /// updates of the tiles that it may reach, in their order.
  std::vector<TileUpdate> run(StepChange& change, std::span<const ObjectId> absent, bool keeps_trees,
                              StepResult& result, StopWatch& watch) {
    const std::vector<Leaves>* known_leaves = selection.leaves(change);
    PathTasks tasks = find_tasks(change);
    watch.lap(result.seconds.select);
    const Tracer::TopLevel* scene_level = nullptr;
    if (change.touches_rays()) {
      if (!level) level = std::make_unique<SceneLevel>(image().view.shadow_bits > 0, monitor());
      scene_level = &level->current(rays, absent);
      residency.require_floor();
      build_selection(change, rays, absent, level->tracer());
    }
    const GrowScene scene = grow(scene_level);
    ChangeBoxes boxes;
    const std::vector<LightEnd> ends = light_ends(state.scene());
    const bool uses_tunnels =
        stored.regions().may_have_tunnels(image()) && change.touches_segments() && !change.rays.lights_changed;
    if (change.touches_segments()) {
      boxes = boxes_of(change, rays, absent);
      boxes.count_blockers = image().view.shadow_bits > 0;
      change.rays.bounds = {boxes.moved.all, boxes.shadows_before.all, boxes.shadows_after.all, boxes.condition};
    }
    const TunnelTest tunnel_test{boxes, ends};
    std::vector<bool> near_tiles;
    if (uses_tunnels) near_tiles = stored.regions().find_tiles(tunnel_test, result.counters.by_tunnels);
    std::vector<bool> grouped_tiles;
    if (known_leaves == nullptr && !change.rays.lights_changed)
      grouped_tiles = tiles_with_tasks(stored.regions(), tasks, result.counters.by_groups);
    const UpdatePass pass{image(),
                          stored.lights(),
                          scene,
                          change,
                          tasks,
                          stored.classes(),
                          stored.index(),
                          stored.regions(),
                          uses_tunnels ? &tunnel_test : nullptr,
                          near_tiles,
                          grouped_tiles,
                          known_leaves,
                          programs,
                          residency,
                          keeps_trees};
    std::vector<TileWork> works(image().trees.size());
    parallel_for(works.size(), [&](std::size_t tile) { works[tile] = find_tile_work(pass, tile); });
    watch.lap(result.seconds.test);
    Pool<TileTools> tools;
    std::vector<TileUpdate> updates = updates_to_do(works);
    const std::vector<std::size_t> order = by_work(updates, works);
    for (std::size_t i = 0; i < std::min(kTilesAhead, order.size()); ++i) expect(updates[order[i]].tile);
    parallel_for(order.size(), [&](std::size_t i) {
      if (i + kTilesAhead < order.size()) expect(updates[order[i + kTilesAhead]].tile);
      TileUpdate& update = updates[order[i]];
      const auto lease = residency.use(PieceKind::ray_trees, update.tile);
      const GrowCounters found = stored.bring_back_hits(update.tile, works[update.tile].leaves, tasks, scene);
      update = update_tile(pass, update.tile, works[update.tile], tools);
      update.counters += found;
      if (keeps_trees) stored.keep_hits(update);
    });
    watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
    count(updates, works, change.touches_segments(), result);
    std::vector<Leaves> leaves;
    for (const TileWork& work : works) leaves.push_back(work.by_path);
    selection.keep(change, std::move(tasks), std::move(leaves), result.seconds.select + result.seconds.test);
    return updates;
  }

  void expect(std::size_t tile) {
    residency.expect(PieceKind::ray_trees, tile);
    residency.expect(PieceKind::sample_colors, tile);
  }

  /// `works`: by tile. `touches_segments`: what of them nobody looked at, tunnels have ruled out.
  void count(const std::vector<TileUpdate>& updates, const std::vector<TileWork>& works, bool touches_segments,
             StepResult& result) const {
    Counters& counters = result.counters;
    result.dependent.resize(works.size());
    result.touched.resize(works.size());
    for (std::size_t tile = 0; tile < works.size(); ++tile) {
      const TileWork& work = works[tile];
      result.dependent[tile] |= work.by_path;
      result.touched[tile] |= work.leaves & ~work.by_path;
      for (const CellTouches& touches : work.touched)
        for_each_leaf_of(work.tunnel_grid, touches.cell, [&](std::uint32_t leaf) { result.touched[tile].set(leaf); });
      counters.by_groups += work.by_groups;
      counters.by_tunnels += work.by_tunnels;
    }
    std::uint64_t tests = 0, left_out = stored.segments();
    CulledSegments culled;
    for (const TileUpdate& update : updates) {
      counters.samples_affected += update.shaded.size();
      counters.color_trees_evaluated += update.shaded.size();
      const std::uint64_t walked = update.counters.ray_tests + update.counters.culled.sum();
      require(walked == update.walked_segments, "each stored segment is tested, or culled for one reason");
      require(walked <= stored.segments(update.tile), "each stored segment is counted once");
      left_out -= walked;
      tests += update.counters.ray_tests;
      culled += update.counters.culled;
      counters.ray_updates += update.counters.ray_updates;
      counters.shadow_updates += update.counters.shadow_updates;
      counters.object_rays += update.counters.object_rays;
      counters.rebuilt += rebuilt_trees(update.counters);
    }
    (touches_segments ? culled.tunnels : culled.by_class) += left_out;
    counters.ray_tests += tests;
    counters.ray_tests_culled += culled.sum();
    counters.culled += culled;
  }

  /// Applies the edit to the scene and finds what it means.
  StepChange begin(const Edit& edit, std::string_view file, const std::filesystem::path& folder, StepResult& result) {
    residency.begin_change();
    const SceneDelta delta = apply_edit(state, edit, file, folder);
    result.classification = classify(state.scene(), delta);
    if (has_atoms()) stored.extend_atoms(atoms(stored.regions().options().atoms));
    // Tunnels hold for the scene in which the trees were made; they are built when a change first needs them.
    StepChange change = find_change(rays, state.scene(), delta, stored.lights());
    if (change.touches_segments() && !change.rays.lights_changed && !stored.regions().has_tunnels())
      stored.build_tunnels(grow(nullptr));
    rays.update(state.scene(), delta);
    const std::vector<ObjectId> changed = selection_of(change);
    if (level) level->note_changed(changed);
    objects.note_changed(changed);
    forget_programs(change);
    result.counters.samples_total = stored.samples();
    return change;
  }

  StepResult step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
    require(lifted.empty(), "a drag is released before the next step");
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, file, folder, result);
    watch.lap(result.seconds.classify);
    update(change, result, watch);
    finish(result);
    return result;
  }

  void keep_trees(const std::vector<TileUpdate>& updates, const StepChange& change) {
    if (!change.touches_rays()) return;
    stored.keep_paths(updates, grow(nullptr), change.rays.lights_changed);
    stored.bring_back_tunnels(updates, grow(nullptr));
    for (const TileUpdate& update : updates)  // other shadow counters alone change no colour
      if (!update.packed.empty() && !update.shaded.empty()) compressed.note_trees(update.tile);
  }
  /// Works pixels out again that lie under the samples with new colours or, by tile, under `others`.
  void refresh_pixels(const std::vector<TileUpdate>& updates, const std::vector<ShownSamples>& others,
                      StepResult& result) {
    std::vector<std::size_t> tiles;
    for (const TileUpdate& update : updates)
      if (!update.shaded.empty()) tiles.push_back(update.tile);
    for (std::size_t tile = 0; tile < others.size(); ++tile)
      if (!others[tile].samples.empty()) tiles.push_back(tile);
    std::ranges::sort(tiles);
    tiles.erase(std::ranges::unique(tiles).begin(), tiles.end());
    std::vector<TileMask> changed(tiles.size());
    parallel_for(tiles.size(), [&](std::size_t i) {
      const std::size_t tile = tiles[i];
      const auto refresh = [&](std::span<const std::uint32_t> samples) {
        stored.refresh_pixels(tile, samples, on_top.empty() ? nullptr : &on_top[tile], changed[i]);
      };
      if (const TileUpdate* update = find_update(updates, tile)) refresh(update->shaded);
      if (!others.empty()) refresh(others[tile].samples);
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) result.changed_pixels.add(tiles[i], changed[i]);
  }

  /// With more lights, what a sample would keep of them takes more room than its tree.
  [[nodiscard]] bool may_compress() const {
    return compressed.most_samples() > 0 && state.scene().light_order.size() <= kMostTellingLights;
  }

  /// The parameters whose colour trees an edit of colours is to use; null: none.
  [[nodiscard]] const ParameterSet* set_to_keep(const ColorChange& colors) const {
    if (!may_compress() || !is_compressible(colors)) return nullptr;
    return compressed.set_for(colors.parameters);
  }

  void choose_parameters(const std::vector<ParameterSet>& sets) {
    compressed.choose(sets);
    for (const ParameterSet& set : sets) {
      if (!may_compress()) return;
      StepChange change = no_change(stored.lights());
      change.colors.parameters = set;
      recolorer.compress(change);
    }
  }

  /// Brings trees, colours and frame up to date with the scene, where `also_shown` was seen on top so far; finish()
  /// follows.
  void update(StepChange& change, StepResult& result, StopWatch& watch,
              const std::vector<ShownSamples>& also_shown = {}) {
    if (!change.touches_rays() && also_shown.empty()) {
      if (change.colors.empty()) return;
      if (const ParameterSet* set = set_to_keep(change.colors)) {
        change.colors.parameters = *set;
        recolorer.recolor(change, result, watch);
        return;
      }
    }
    const std::vector<TileUpdate> updates = run(change, {}, true, result, watch);
    keep_trees(updates, change);
    watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
    refresh_pixels(updates, also_shown, result);
    watch.lap(result.seconds.evaluate);
  }

  [[nodiscard]] PathTasks find_tasks(const StepChange& change) {
    return selection.find_tasks(change, stored.search(rays), programs);
  }

  void finish(StepResult& result) {
    if (has_atoms()) stored.set_atoms(atoms(stored.regions().options().atoms), grow(nullptr));
    Counters& counters = result.counters;
    counters.pixels_changed = result.changed_pixels.size();
    const PieceCounts moves = residency.take_counts();
    const auto of = [](const auto& counts, PieceKind kind) { return counts[static_cast<std::size_t>(kind)]; };
    counters.evicted += {of(moves.evicted, PieceKind::ray_trees), of(moves.evicted, PieceKind::sample_colors),
                         moves.others_evicted, of(moves.evicted, PieceKind::tunnels), moves.evicted_bytes};
    counters.tunnels_read += of(moves.fetched, PieceKind::tunnels);
    counters.reloaded += {of(moves.reloaded, PieceKind::ray_trees), of(moves.reloaded, PieceKind::sample_colors), 0,
                          of(moves.reloaded, PieceKind::tunnels), moves.reloaded_bytes};
    counters.rebuilt += stored.take_rebuilt();
    if (counters.ray_tests + counters.ray_tests_culled > 0) return;
    counters.ray_tests_culled = counters.culled.by_class = stored.segments();  // no pass looked at any
  }

  /// Makes a change also put the lifted objects, where they are now, back into the ray trees.
  void put_back_with(StepChange& change) const {
    if (!lifted.empty()) change.rays.reserve(state.scene().objects.size());
    for (ObjectId id : lifted) {
      change.rays.objects[id.index()] |= RayChange::moved | RayChange::shadows;
      change.rays.before_index[id.index()] = kNoNode;  // in no tree
    }
    if (lifted.empty()) return;
    change.any_moved = true;
    change.any_shadows = true;
  }
  /// A change that does nothing else.
  [[nodiscard]] StepChange put_back() const {
    StepChange change = no_change(stored.lights());
    put_back_with(change);
    return change;
  }

  StepResult drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, file, folder, result);
    watch.lap(result.seconds.classify);
    if (!is_movement(change)) {
      put_back_with(change);  // lights move with the selection, say: not the paper's kind of drag
      const std::vector<ShownSamples> shown = std::exchange(on_top, {});
      lifted.clear();
      update(change, result, watch, shown);
      finish(result);
      return result;
    }
    const std::vector<TileUpdate> removed = remove_selection(change, result, watch);
    show_selection(removed, result, watch);
    finish(result);
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
    if (on_top.empty()) on_top.resize(image().trees.size());
    for (ObjectId id : lifted) change.rays.objects[id.index()] = 0;  // not in any tree
    lifted = std::move(all);
    std::vector<TileUpdate> updates = run(change, lifted, true, result, watch);
    keep_trees(updates, change);
    watch.lap(result.seconds.update);
    return updates;
  }

  /// Second step: the selection is rendered where it is; the ray trees stay without it. `removed`: what the first step
  /// has changed.
  void show_selection(const std::vector<TileUpdate>& removed, StepResult& result, StopWatch& watch) {
    if (lifted.empty()) return;  // nothing has moved yet
    StepChange change = put_back();
    std::vector<TileUpdate> updates = run(change, {}, false, result, watch);
    std::vector<ShownSamples> others = std::exchange(on_top, std::vector<ShownSamples>(image().trees.size()));
    for (const TileUpdate& update : removed) {
      std::vector<std::uint32_t>& other = others[update.tile].samples;
      std::vector<std::uint32_t> both;
      std::ranges::set_union(other, update.shaded, std::back_inserter(both));
      other = std::move(both);
    }
    for (TileUpdate& update : updates) {
      if (const TileUpdate* also = find_update(removed, update.tile))
        result.counters.samples_affected -= common(also->shaded, update.shaded);
      on_top[update.tile] = {update.shaded, std::move(update.colors)};
    }
    refresh_pixels(updates, others, result);
    watch.lap(result.seconds.evaluate);
    stored.bring_back_tunnels(updates, grow(nullptr));
    watch.lap(result.seconds.update);
  }

  /// Last step: the selection goes into the ray trees; the frame stays as it is.
  StepResult release() {
    StepResult result;
    StopWatch watch;
    result.counters.samples_total = stored.samples();
    StepChange change = put_back();
    lifted.clear();
    on_top.clear();
    update(change, result, watch);
    finish(result);
    return result;
  }
};

Replayer::Replayer(SceneState state, Image image, const RegionOptions& options, std::unique_ptr<Residency> residency,
                   std::shared_ptr<StoredTunnels> tunnels)
    : impl_(std::make_unique<Impl>(std::move(state), std::move(image), options, std::move(residency),
                                   std::move(tunnels))) {}
Replayer::~Replayer() = default;
Replayer::Replayer(Replayer&&) noexcept = default;

const SceneState& Replayer::state() const { return impl_->state; }
const Image& Replayer::image() const { return impl_->image(); }
const ImageRegions& Replayer::regions() const { return impl_->stored.regions(); }
const Residency& Replayer::residency() const { return impl_->residency; }
Residency& Replayer::residency() { return impl_->residency; }
std::uint64_t Replayer::segments() const { return impl_->stored.segments(); }

Resident Replayer::resident() const {
  Resident resident = impl_->stored.resident();
  resident.color_trees += impl_->compressed.bytes();
  resident.total += impl_->compressed.bytes();
  return resident;
}

void Replayer::choose_parameters(const std::vector<ParameterSet>& sets) { impl_->choose_parameters(sets); }
StepResult Replayer::step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return impl_->step(edit, file, folder);
}
StepResult Replayer::drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return impl_->drag(edit, file, folder);
}
StepResult Replayer::release() { return impl_->release(); }

}  // namespace relook
