#include "replay/recolor.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "base/parallel.h"
#include "image/image_pieces.h"
#include "image/sampling.h"

namespace relook {
namespace {

/// Trees are compressed in blocks of about this many: long runs for evaluation, few enough to stay in the cache.
constexpr std::size_t kBlockSamples = 4096;

class TreeCompressor {
 public:
  TreeCompressor(const UpdatePass& pass, std::size_t tile, ColorTreeSet& set, TileTools& tools)
      : p_(pass),
        trees_(pass.image.trees[tile]),
        rect_(tile_rect(tile, pass.image.frame.width, pass.image.frame.height)),
        primaries_(pass.grow.scene.scene().camera, pass.image.view),
        set_(set),
        shader_(tools.shader),
        block_(tools.block) {}

  TileColorTrees compress(const Leaves& leaves) {
    const auto start = std::chrono::steady_clock::now();
    for_each_sample(rect_, p_.image.view, leaves, [&](std::uint32_t sample, std::uint32_t) {
      const PathId path = trees_.paths[sample];
      if ((p_.tasks.of_path[path.index()] & kShade) == 0) return;
      const StoredTree stored{PathCursor(p_.image.paths.words(path), {p_.lights.size(), p_.grow.shadow_bits}),
                              trees_.kept_hits_of(sample)};
      roots_.push_back(expand_tree(p_.grow, primaries_.ray(rect_, sample), sample, stored, block_, counters_));
      if (roots_.size() == kBlockSamples) flush();
    });
    flush();
    for (const std::uint32_t sample : tile_.samples)
      tile_.leaves.set(leaf_of(sample / p_.image.view.samples, rect_.x1 - rect_.x0));
    tile_.is_valid = true;
    tile_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(tile_);
  }
  [[nodiscard]] const GrowCounters& counters() const { return counters_; }

 private:
  void flush() {
    if (roots_.empty()) return;
    CompressedBlock block = shader_.compress(block_, roots_, set_.parameters, set_.splits);
    for (const std::uint32_t root : block.roots) tile_.samples.push_back(block_.nodes[roots_[root]].sample);
    tile_.bytes += block.bytes();
    if (!block.roots.empty()) tile_.blocks.push_back(std::move(block));
    block_.clear();
    roots_.clear();
  }

  const UpdatePass& p_;
  const TileTrees& trees_;
  TileRect rect_;
  PrimaryRays primaries_;
  ColorTreeSet& set_;
  Shader& shader_;
  TreeBlock& block_;
  std::vector<std::uint32_t> roots_;
  GrowCounters counters_;
  TileColorTrees tile_;
};

/// Evaluates a valid tile and brings colours and frame up to date: the mask of its changed pixels.
TileMask recolor_tile(const TileColorTrees& compressed, std::size_t tile, const Scene& scene, StoredImage& stored,
                      ColorMemory& memory) {
  const auto lease = stored.residency().use(PieceKind::sample_colors, tile);
  std::span<const std::uint32_t> samples(compressed.samples);
  for (const CompressedBlock& block : compressed.blocks) {
    stored.keep_colors(tile, samples.first(block.roots.size()), block.evaluate(scene, memory));
    samples = samples.subspan(block.roots.size());
  }
  TileMask changed{};
  stored.refresh_pixels(tile, compressed.samples, nullptr, changed);
  return changed;
}

/// How many of some samples may still be kept, asked from several tiles at once.
class Room {
 public:
  explicit Room(std::uint64_t samples) : left_(static_cast<std::int64_t>(samples)) {}
  /// False, and nothing taken, if they do not fit.
  bool take(std::size_t samples) {
    const auto count = static_cast<std::int64_t>(samples);
    if (left_.fetch_sub(count) >= count) return true;
    left_.fetch_add(count);
    return false;
  }

 private:
  std::atomic<std::int64_t> left_;
};

}  // namespace

/// What invalid tiles are built from; empty if there are none.
struct Recolorer::Search {
  PathTasks tasks;
  std::vector<TileWork> works;  // by tile
};

Recolorer::Search Recolorer::search(const StepChange& change, const ColorTreeSet& kept, StepResult& result,
                                    StopWatch& watch) {
  Search search;
  if (!kept.is_valid()) {
    search.tasks = selection_.find_tasks(change, stored_.search(rays_), programs_);
    search.works.resize(kept.tiles.size());
  }
  watch.lap(result.seconds.select);
  return search;
}

void Recolorer::expect(const ColorTreeSet& kept, std::size_t tile) const {
  if (!kept.tiles[tile].is_valid) stored_.residency().expect(PieceKind::ray_trees, tile);
  stored_.residency().expect(PieceKind::sample_colors, tile);
}

void Recolorer::run(const StepChange& change, bool evaluates, StepResult& result, StopWatch& watch) {
  ColorTreeSet& kept = compressed_.of(change.colors.parameters, stored_.residency().change());
  const std::vector<Leaves>* known_leaves = selection_.leaves(change);
  Search found = search(change, kept, result, watch);
  const Image& image = stored_.image();
  const GrowScene grow{rays_, nullptr, image.view.max_depth, image.view.shadow_bits, &objects_};
  const std::vector<bool> near_tiles;
  std::vector<bool> grouped_tiles;
  if (!found.works.empty() && known_leaves == nullptr)
    grouped_tiles = tiles_with_tasks(stored_.regions(), found.tasks, result.counters.by_groups);
  const UpdatePass pass{image,           stored_.lights(),   grow,    change,     found.tasks,   stored_.classes(),
                        stored_.index(), stored_.regions(),  nullptr, near_tiles, grouped_tiles, known_leaves,
                        programs_,       stored_.residency()};
  parallel_for(found.works.size(), [&](std::size_t tile) {
    if (!kept.tiles[tile].is_valid) found.works[tile] = find_tile_work(pass, tile);
  });
  std::vector<std::size_t> tiles;
  for (std::size_t tile = 0; tile < kept.tiles.size(); ++tile) {
    const bool has_work = !found.works.empty() && found.works[tile].leaves.any();
    if (has_work || !kept.tiles[tile].samples.empty())
      tiles.push_back(tile);
    else
      kept.tiles[tile].is_valid = true;  // none of its samples depends on the parameters
    if (!found.works.empty()) result.counters.by_groups += found.works[tile].by_groups;
  }
  watch.lap(result.seconds.test);

  std::vector<TileMask> changed(tiles.size());
  std::vector<std::size_t> samples(tiles.size());
  std::vector<GrowCounters> grown(tiles.size());
  std::vector<Moves> rebuilt(tiles.size()), evicted(tiles.size());
  result.dependent.resize(kept.tiles.size());
  result.touched.resize(kept.tiles.size());
  Room room(compressed_.most_samples());
  Pool<TileTools> tools;
  for (std::size_t i = 0; i < std::min(kTilesAhead, tiles.size()); ++i) expect(kept, tiles[i]);
  parallel_for(tiles.size(), [&](std::size_t i) {
    if (i + kTilesAhead < tiles.size()) expect(kept, tiles[i + kTilesAhead]);
    TileColorTrees& tile = kept.tiles[tiles[i]];
    if (!tile.is_valid) {
      const auto own = tools.take([&] { return std::make_unique<TileTools>(rays_, programs_); });
      const auto lease = stored_.residency().use(PieceKind::ray_trees, tiles[i]);
      grown[i] = stored_.bring_back_hits(tiles[i], found.works[tiles[i]].leaves, found.tasks, grow);
      TreeCompressor compressor(pass, tiles[i], kept, *own);
      compressed_.keep(tile, compressor.compress(found.works[tiles[i]].leaves));
      grown[i] += compressor.counters();
      if (std::exchange((*kept.were_built)[tiles[i]], std::uint8_t{1}) != 0)
        rebuilt[i] = {0, 0, tile.samples.size(), 0, tile.bytes};
    }
    if (evaluates) {
      const auto memory = memory_.take([] { return std::make_unique<ColorMemory>(); });
      changed[i] = recolor_tile(tile, tiles[i], rays_.scene(), stored_, *memory);
    }
    stored_.residency().note_use_of_other("color_trees", kept.number * kept.tiles.size() + tiles[i], tile.bytes,
                                          tile.build_seconds);
    samples[i] = tile.samples.size();
    result.dependent[tiles[i]] = tile.leaves;
    if (room.take(samples[i]) && stored_.residency().make_room(0)) return;
    evicted[i] = {0, 0, samples[i], 0, tile.bytes};
    compressed_.drop(tile);  // at once, so that what cannot be kept does not pile up
  });
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    result.changed_pixels.add(tiles[i], changed[i]);
    result.counters.samples_affected += samples[i];
    result.counters.object_rays += grown[i].object_rays;
    result.counters.rebuilt += rebuilt_trees(grown[i]);
    result.counters.rebuilt += rebuilt[i];
    result.counters.evicted += evicted[i];
  }
  result.counters.color_trees_evaluated = result.counters.samples_affected;
  if (!found.works.empty())
    selection_.keep(change, std::move(found.tasks), result.dependent, result.seconds.select + result.seconds.test);
  const std::uint64_t bytes_before = compressed_.bytes();
  result.counters.evicted.color_trees += compressed_.trim();
  result.counters.evicted.bytes += bytes_before - compressed_.bytes();
  watch.lap(result.seconds.evaluate);
}

}  // namespace relook
