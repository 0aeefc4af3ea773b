#include "replay/image_pass.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {
namespace {

/// What the tiles of a pass were looked at for. `works`: by tile.
void count_works(const std::vector<TileWork>& works, StepResult& result) {
  result.dependent.resize(works.size());
  result.touched.resize(works.size());
  for (std::size_t tile = 0; tile < works.size(); ++tile) {
    const TileWork& work = works[tile];
    result.dependent[tile] |= work.by_path;
    result.touched[tile] |= work.leaves & ~work.by_path;
    for (const CellTouches& touches : work.touched)
      for_each_leaf_of(work.tunnel_grid, touches.cell, [&](std::uint32_t leaf) { result.touched[tile].set(leaf); });
    result.counters.by_groups += work.by_groups;
    result.counters.by_tunnels += work.by_tunnels;
  }
}

/// Stored segments that no tile looked at were ruled out by tunnels if the change `touches_segments`, otherwise by its
/// class.
void count_updates(const std::vector<TileUpdate>& updates, const StoredImage& stored, bool touches_segments,
                   Counters& counters) {
  std::uint64_t tests = 0, left_out = stored.segments();
  CulledSegments culled;
  for (const TileUpdate& update : updates) {
    const std::size_t shaded = update.fresh.shaded.samples.size();
    counters.samples_affected += shaded;
    counters.color_trees_evaluated += shaded;
    const std::uint64_t walked = update.counters.ray_tests + update.counters.culled.sum();
    require(walked == update.walked_segments, "each stored segment is tested, or culled for one reason");
    require(walked <= stored.segments(update.fresh.tile), "each stored segment is counted once");
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

class ImagePass {
 public:
  ImagePass(ReplayParts& parts, StepChange& change, const PassKind& kind, StepResult& result)
      : parts_(parts), stored_(parts.stored), change_(change), kind_(kind), result_(result) {}

  std::vector<NewSamples> run(StopWatch& watch) {
    const std::vector<Leaves>* known_leaves = parts_.selection.leaves(change_);
    PathTasks tasks = parts_.selection.find_tasks(change_, search_in(stored_, parts_.rays), parts_.programs);
    watch.lap(result_.seconds.select);
    const GrowScene grow = parts_.grow(build_levels());
    ChangeBoxes boxes;
    if (change_.touches_segments()) boxes = find_boxes();
    const std::vector<LightEnd> ends = light_ends(parts_.rays);
    const TunnelTest tunnel_test{boxes, ends};
    const UpdatePass pass{.stored = stored_,
                          .programs = parts_.programs,
                          .what = {.change = change_,
                                   .tasks = tasks,
                                   .scene = parts_.rays,
                                   .grow = grow,
                                   .keeps_trees = kind_.keeps_trees},
                          .where = find_where(known_leaves, tasks, tunnel_test)};
    std::vector<TileWork> works(parts_.image().trees.size());
    parallel_for(works.size(), [&](std::size_t tile) { works[tile] = find_tile_work(pass, tile); });
    watch.lap(result_.seconds.test);
    std::vector<TileUpdate> updates = update_tiles(pass, works);
    watch.lap(change_.touches_rays() ? result_.seconds.update : result_.seconds.evaluate);
    count_works(works, result_);
    count_updates(updates, stored_, change_.touches_segments(), result_.counters);
    std::vector<Leaves> leaves;
    for (const TileWork& work : works) leaves.push_back(work.by_path);
    parts_.selection.keep(change_, std::move(tasks), std::move(leaves), result_.seconds.select + result_.seconds.test);
    std::vector<NewSamples> fresh;
    for (TileUpdate& update : updates) fresh.push_back(std::move(update.fresh));
    return fresh;
  }

 private:
  /// That of the scene, null if no ray is traced, and those of the selection.
  const Tracer::TopLevel* build_levels() {
    if (!change_.touches_rays()) return nullptr;
    const Tracer::TopLevel& scene_level = parts_.current_level(kind_.absent);
    parts_.residency.require_floor();
    build_selection(change_, parts_.rays, kind_.absent, parts_.level->tracer());
    return &scene_level;
  }

  ChangeBoxes find_boxes() {
    ChangeBoxes boxes = boxes_of(change_, parts_.rays, kind_.absent);
    boxes.count_blockers = parts_.image().view.shadow_bits > 0;
    change_.rays.bounds = {boxes.moved.all, boxes.shadows_before.all, boxes.shadows_after.all, boxes.condition};
    return boxes;
  }

  UpdatePass::Where find_where(const std::vector<Leaves>* known_leaves, const PathTasks& tasks,
                               const TunnelTest& tunnel_test) {
    const ImageRegions& regions = stored_.regions();
    UpdatePass::Where where{.known_leaves = known_leaves};
    if (change_.rays.lights_changed) return where;
    if (regions.may_have_tunnels(parts_.image()) && change_.touches_segments()) {
      where.tunnel_test = &tunnel_test;
      where.near_tiles = regions.find_tiles(tunnel_test, result_.counters.by_tunnels);
    }
    if (known_leaves == nullptr) where.grouped_tiles = tiles_with_tasks(regions, tasks, result_.counters.by_groups);
    return where;
  }

  std::vector<TileUpdate> update_tiles(const UpdatePass& pass, const std::vector<TileWork>& works) {
    Pool<TileTools> tools;
    std::vector<TileUpdate> updates = updates_to_do(works);
    const std::vector<std::size_t> order = by_work(updates, works);
    std::vector<std::size_t> tiles;
    for (const std::size_t place : order) tiles.push_back(updates[place].fresh.tile);
    for (std::size_t i = 0; i < std::min(kTilesAhead, tiles.size()); ++i) expect(tiles[i]);
    parallel_for(tiles.size(), [&](std::size_t i) {
      if (i + kTilesAhead < tiles.size()) expect(tiles[i + kTilesAhead]);
      const std::size_t tile = tiles[i];
      TileUpdate& update = updates[order[i]];
      const auto lease = parts_.residency.use(PieceKind::ray_trees, tile);
      const GrowCounters found = bring_back_hits(pass, tile, works[tile].leaves);
      update = update_tile(pass, tile, works[tile], tools);
      update.counters += found;
      if (kind_.keeps_trees) stored_.keep_hits(update.fresh);
    });
    return updates;
  }

  /// The tile's turn comes soon.
  void expect(std::size_t tile) {
    parts_.residency.expect(PieceKind::ray_trees, tile);
    parts_.residency.expect(PieceKind::sample_colors, tile);
  }

  ReplayParts& parts_;
  StoredImage& stored_;
  StepChange& change_;
  const PassKind& kind_;
  StepResult& result_;
};

}  // namespace

std::vector<NewSamples> run_pass(ReplayParts& parts, StepChange& change, const PassKind& kind, StepResult& result,
                                 StopWatch& watch) {
  return ImagePass(parts, change, kind, result).run(watch);
}

void keep_trees(ReplayParts& parts, std::span<const NewSamples> fresh, const StepChange& change) {
  if (!change.touches_rays()) return;
  parts.stored.keep_paths(fresh, parts.grow(), change.rays.lights_changed);
  parts.stored.bring_back_tunnels(fresh, parts.grow());
  for (const NewSamples& of_tile : fresh)  // other shadow counters alone change no colour
    if (!of_tile.packed.samples.empty() && !of_tile.shaded.samples.empty()) parts.color_trees.note_trees(of_tile.tile);
}

void refresh_pixels(StoredImage& stored, std::span<const NewSamples> fresh, std::span<const SampleColors> others,
                    std::span<const SampleColors> on_top, StepResult& result) {
  std::vector<std::size_t> tiles;
  for (const NewSamples& of_tile : fresh)
    if (!of_tile.shaded.samples.empty()) tiles.push_back(of_tile.tile);
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
    if (const NewSamples* of_tile = find_tile(fresh, tile)) refresh(of_tile->shaded.samples);
    if (!others.empty()) refresh(others[tile].samples);
  });
  for (std::size_t i = 0; i < tiles.size(); ++i) result.changed_pixels.add(tiles[i], changed[i]);
}

}  // namespace relook
