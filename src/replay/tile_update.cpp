#include "replay/tile_update.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "cache/residency/residency.h"
#include "image/sampling.h"
#include "trace/tree/find_hits.h"
#include "trace/tree/pack.h"
#include "trace/tree/probe.h"

namespace relook {
namespace {

class TileUpdater {
 public:
  TileUpdater(const UpdatePass& pass, std::size_t tile, TileTools& tools)
      : stored_(pass.stored),
        image_(pass.stored.image()),
        what_(pass.what),
        trees_(image_.trees[tile]),
        rect_(tile_rect(tile, image_.frame.width, image_.frame.height)),
        primaries_(what_.grow.scene.camera(), image_.view),
        shader_(tools.shader),
        block_(tools.block),
        finder_(what_.grow, what_.change.rays, result_.counters) {
    fresh_.tile = tile;
  }

  TileUpdate update(const TileWork& work) {
    tests_all_ = work.tests_all;
    fresh_.missed_tunnels = work.misses_tunnels;
    tunnel_grid_ = work.tunnel_grid;
    if (!work.touched.empty()) by_cell_.resize(tunnel_grid_.cells());
    for (const CellTouches& touches : work.touched) by_cell_[touches.cell] = &touches;
    for_each_sample(rect_, image_.view.samples, work.leaves,
                    [&](std::uint32_t sample, std::uint32_t leaf) { update_sample(sample, leaf); });
    flush();
    return std::move(result_);
  }

 private:
  void update_sample(std::uint32_t sample, std::uint32_t leaf) {
    const PathId path = trees_.paths[sample];
    const std::uint8_t task = what_.tasks.of_path[path.index()];
    const Touches* touches = touches_of(sample, path);
    if (task == 0 && touches == nullptr && !tests_all_) return;
    const SpawnedRay primary = primaries_.ray(rect_, sample);
    bool update = (task & kUpdateTree) != 0 || tests_all_;
    const StoredTree stored = stored_tree(path, primary, sample, update || touches != nullptr);
    // Where the last tree has changed, this one probably has, too: no use in asking first.
    if (!update && touches != nullptr) update = last_changed_.test(leaf) || probe(path, *touches, primary, stored);
    if (!update && (task & kShade) == 0) return;
    const TreeBlock::Mark mark = block_.mark();
    TreeChange what = TreeChange::none;
    std::uint32_t root = 0;
    if (update) {
      const bool tests_all = tests_all_ || !what_.change.touches_segments();  // then nothing is left to test
      const Touches* tested = tests_all ? nullptr : touches != nullptr ? touches : &no_touches_;
      result_.walked_segments += stored_.index().segments(path);
      root =
          update_tree(what_.grow, what_.change.rays, tested, primary, sample, stored, block_, result_.counters, what);
      last_changed_.set(leaf, what >= TreeChange::lights);
    } else {
      root = expand_tree(what_.grow, primary, sample, stored, block_, result_.counters);
    }
    if (what_.keeps_trees && (what != TreeChange::none || what_.change.rays.lights_changed)) pack_sample(root, sample);
    if (what < TreeChange::lights && (task & kShade) == 0) {
      block_.rewind(mark);
      return;
    }
    roots_.push_back(root);
    fresh_.shaded.samples.push_back(sample);
    if (ChunkSize::is_full(block_, roots_.size())) flush();
  }

  /// What to test of a sample's tree; null: nothing.
  [[nodiscard]] const Touches* touches_of(std::uint32_t sample, PathId path) const {
    if (by_cell_.empty()) return nullptr;
    const std::uint32_t pixel = sample / image_.view.samples;
    const CellTouches* touches = by_cell_[tunnel_grid_.cell_of(pixel, rect_.width())];
    return touches != nullptr ? touches->of(stored_.classes().of(path)) : nullptr;
  }

  /// Hits that are not kept are found first where the tree may be compared with the scene.
  StoredTree stored_tree(PathId path, const SpawnedRay& primary, std::uint32_t sample, bool may_update) {
    StoredTree stored{PathCursor(image_.paths.words(path), {stored_.lights().size(), what_.grow.shadow_bits}),
                      trees_.kept_hits_of(sample)};
    if (stored.hits || !may_update) return stored;
    found_hits_.clear();
    finder_.find(primary, stored.cursor, found_hits_);
    stored.hits = found_hits_;
    return stored;
  }

  /// The tests of a tree that is then updated are counted there.
  bool probe(PathId path, const Touches& touches, const SpawnedRay& primary, const StoredTree& stored) {
    GrowCounters counters;
    if (probe_tree(what_.grow, what_.change.rays, touches, primary, stored, counters)) return true;
    result_.counters += counters;
    result_.walked_segments += stored_.index().segments(path);
    return false;
  }

  void flush() {
    if (roots_.empty()) return;
    stop_if_interrupted();
    std::vector<Rgba>& colors = fresh_.shaded.colors;
    const std::size_t first = colors.size();
    colors.resize(first + roots_.size());
    shader_.shade(block_, roots_, std::span(colors).subspan(first));
    block_.clear();
    roots_.clear();
  }

  void pack_sample(std::uint32_t root, std::uint32_t sample) {
    SampleTrees& packed = fresh_.packed;
    words_.clear();
    packed.samples.push_back(sample);
    pack(block_, root, what_.grow.layout(), words_, packed.hits);
    packed.path_of.push_back(packed.paths.intern(words_));
    packed.first_hit.push_back(hit_place(packed.hits.size()));
  }

  const StoredImage& stored_;
  const Image& image_;
  const UpdatePass::What& what_;
  const TileTrees& trees_;
  TileRect rect_;
  bool tests_all_ = false;
  PrimaryRays primaries_;
  Shader& shader_;
  TileGrid tunnel_grid_ = kLeafGrid;
  std::vector<const CellTouches*> by_cell_;  // [cells of the tunnels] null: not touched; empty: none is
  const Touches no_touches_;
  Leaves last_changed_;  // leaves whose last updated tree has changed
  TreeBlock& block_;
  std::vector<std::uint32_t> roots_, words_;
  TileUpdate result_;
  NewSamples& fresh_ = result_.fresh;
  HitFinder finder_;
  std::vector<Hit> found_hits_;
};

}  // namespace

std::vector<bool> tiles_with_tasks(const ImageRegions& regions, const PathTasks& tasks, RegionCounters& counters) {
  if (!tasks.any || !regions.has_groups()) return {};
  return regions.find_tiles(tasks.of_class, counters);
}

TileWork find_tile_work(const UpdatePass& pass, std::size_t tile) {
  const StepChange& change = pass.what.change;
  const PathTasks& tasks = pass.what.tasks;
  const ImageRegions& regions = pass.stored.regions();
  const UpdatePass::Where& where = pass.where;
  TileWork work;
  if (change.rays.lights_changed || (change.touches_segments() && where.tunnel_test == nullptr)) {
    work.leaves.set();
    work.tests_all = true;
    return work;
  }
  if (where.known_leaves != nullptr) {
    work.by_path = (*where.known_leaves)[tile];
  } else if (tasks.any) {
    if (regions.has_groups()) {
      if (where.grouped_tiles[tile]) select_leaves(regions.groups(tile), tasks.of_class, work.by_path, work.by_groups);
    } else {
      work.by_path.set();
    }
  }
  work.leaves = work.by_path;
  if (change.touches_segments() && where.near_tiles[tile]) {
    const auto lease = pass.stored.residency().use(PieceKind::tunnels, tile);
    const TileTunnels& tunnels = regions.tunnels(tile);
    work.misses_tunnels = tunnels.empty();
    if (tunnels.empty() || tunnels.grid().regions() == 0) {
      work.leaves.set();
      work.tests_all = true;
      return work;
    }
    work.tunnel_grid = tunnels.grid();
    find_touched_cells(tunnels, *where.tunnel_test, work.touched, work.by_tunnels);
    for (const CellTouches& touches : work.touched)
      for_each_leaf_of(work.tunnel_grid, touches.cell, [&](std::uint32_t leaf) { work.leaves.set(leaf); });
  }
  return work;
}

GrowCounters bring_back_hits(const UpdatePass& pass, std::size_t tile, const Leaves& leaves) {
  if (!pass.stored.misses_hits(tile)) return {};
  const bool any_updates = std::ranges::any_of(pass.stored.image().trees[tile].paths, [&](PathId path) {
    return (pass.what.tasks.of_path[path.index()] & kUpdateTree) != 0;
  });
  return any_updates ? GrowCounters() : pass.stored.bring_back_hits(tile, leaves, pass.what.grow);
}

TileUpdate update_tile(const UpdatePass& pass, std::size_t tile, const TileWork& work, Pool<TileTools>& tools) {
  const auto own = tools.take([&] { return std::make_unique<TileTools>(pass.what.scene, pass.programs); });
  return TileUpdater(pass, tile, *own).update(work);
}

std::vector<TileUpdate> updates_to_do(const std::vector<TileWork>& works) {
  std::vector<TileUpdate> updates;
  for (std::size_t tile = 0; tile < works.size(); ++tile)
    if (works[tile].leaves.any()) updates.emplace_back().fresh.tile = tile;
  return updates;
}

std::vector<std::size_t> by_work(const std::vector<TileUpdate>& updates, const std::vector<TileWork>& works) {
  std::vector<std::size_t> order(updates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(),
                           [&](std::size_t i) { return works[updates[i].fresh.tile].leaves.count(); });
  return order;
}

const NewSamples* find_tile(std::span<const NewSamples> fresh, std::size_t tile) {
  const auto found = std::ranges::lower_bound(fresh, tile, {}, &NewSamples::tile);
  return found != fresh.end() && found->tile == tile ? &*found : nullptr;
}

}  // namespace relook
