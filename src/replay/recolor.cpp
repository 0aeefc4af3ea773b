#include "replay/recolor.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "base/parallel.h"
#include "image/image_pieces.h"
#include "image/sampling.h"
#include "replay/tile_update.h"

namespace relook {
namespace {

/// Trees are compressed in blocks of about this many: long runs for evaluation, few enough to stay in the cache.
constexpr std::size_t kBlockSamples = 4096;

class TreeCompressor {
 public:
  TreeCompressor(const UpdatePass& pass, std::size_t tile, ColorTreeSet& set, TileTools& tools)
      : stored_(pass.stored),
        image_(pass.stored.image()),
        what_(pass.what),
        trees_(image_.trees[tile]),
        rect_(tile_rect(tile, image_.frame.width, image_.frame.height)),
        primaries_(what_.grow.scene.camera(), image_.view),
        set_(set),
        shader_(tools.shader),
        block_(tools.block) {}

  TileColorTrees compress(const Leaves& leaves) {
    const auto start = std::chrono::steady_clock::now();
    for_each_sample(rect_, image_.view.samples, leaves, [&](std::uint32_t sample, std::uint32_t) {
      const PathId path = trees_.paths[sample];
      if ((what_.tasks.of_path[path.index()] & kShade) == 0) return;
      const StoredTree stored{PathCursor(image_.paths.words(path), {stored_.lights().size(), what_.grow.shadow_bits}),
                              trees_.kept_hits_of(sample)};
      roots_.push_back(expand_tree(what_.grow, primaries_.ray(rect_, sample), sample, stored, block_, counters_));
      if (roots_.size() == kBlockSamples) flush();
    });
    flush();
    for (const std::uint32_t sample : tile_.samples)
      tile_.leaves.set(leaf_of(sample / image_.view.samples, rect_.width()));
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

  const StoredImage& stored_;
  const Image& image_;
  const UpdatePass::What& what_;
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

/// What became of a tile.
struct Outcome {
  TileMask changed{};
  std::size_t samples = 0, reused = 0;  // reused: of trees that were compressed before
  GrowCounters grown;
  Moves rebuilt, evicted;
};

/// Compresses the trees of a tile that are not valid. `leaves`: with samples that may depend on the parameters.
void compress_tile(const UpdatePass& pass, ReplayParts& parts, std::size_t tile, const Leaves& leaves,
                   ColorTreeSet& kept, Pool<TileTools>& tools, Outcome& outcome) {
  const auto own = tools.take([&] { return std::make_unique<TileTools>(parts.rays, parts.programs); });
  const auto lease = parts.residency.use(PieceKind::ray_trees, tile);
  outcome.grown = bring_back_hits(pass, tile, leaves);
  TreeCompressor compressor(pass, tile, kept, *own);
  TileColorTrees& trees = kept.tiles[tile];
  parts.color_trees.keep(trees, compressor.compress(leaves));
  outcome.grown += compressor.counters();
  if (std::exchange((*kept.were_built)[tile], std::uint8_t{1}) == 0) return;
  outcome.rebuilt.color_trees = trees.samples.size();
  outcome.rebuilt.bytes = trees.bytes;
}

void count_outcomes(const std::vector<Outcome>& outcomes, std::span<const std::size_t> tiles, StepResult& result) {
  Counters& counters = result.counters;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    result.changed_pixels.add(tiles[i], outcome.changed);
    counters.samples_affected += outcome.samples;
    counters.color_trees_reused += outcome.reused;
    counters.object_rays += outcome.grown.object_rays;
    counters.rebuilt += rebuilt_trees(outcome.grown);
    counters.rebuilt += outcome.rebuilt;
    counters.evicted += outcome.evicted;
  }
  counters.color_trees_evaluated = counters.samples_affected;
}

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
    search.tasks = parts_.selection.find_tasks(change, search_in(parts_.stored, parts_.rays), parts_.programs);
    search.works.resize(kept.tiles.size());
  }
  watch.lap(result.seconds.select);
  return search;
}

void Recolorer::expect(const ColorTreeSet& kept, std::size_t tile) const {
  if (!kept.tiles[tile].is_valid) parts_.residency.expect(PieceKind::ray_trees, tile);
  parts_.residency.expect(PieceKind::sample_colors, tile);
}

void Recolorer::run(const StepChange& change, bool evaluates, StepResult& result, StopWatch& watch) {
  ColorTreeSet& kept = parts_.color_trees.of(change.colors.parameters, parts_.residency.change());
  const std::vector<Leaves>* known_leaves = parts_.selection.leaves(change);
  Search found = search(change, kept, result, watch);
  const GrowScene grow = parts_.grow();
  UpdatePass::Where where{.known_leaves = known_leaves};
  if (!found.works.empty() && known_leaves == nullptr)
    where.grouped_tiles = tiles_with_tasks(parts_.stored.regions(), found.tasks, result.counters.by_groups);
  const UpdatePass pass{.stored = parts_.stored,
                        .programs = parts_.programs,
                        .what = {.change = change, .tasks = found.tasks, .scene = parts_.rays, .grow = grow},
                        .where = std::move(where)};
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

  std::vector<Outcome> outcomes(tiles.size());
  result.dependent.resize(kept.tiles.size());
  result.touched.resize(kept.tiles.size());
  Room room(parts_.color_trees.most_samples());
  Pool<TileTools> tools;
  for (std::size_t i = 0; i < std::min(kTilesAhead, tiles.size()); ++i) expect(kept, tiles[i]);
  parallel_for(tiles.size(), [&](std::size_t i) {
    if (i + kTilesAhead < tiles.size()) expect(kept, tiles[i + kTilesAhead]);
    const std::size_t tile = tiles[i];
    TileColorTrees& trees = kept.tiles[tile];
    Outcome& outcome = outcomes[i];
    if (trees.is_valid)
      outcome.reused = trees.samples.size();
    else
      compress_tile(pass, parts_, tile, found.works[tile].leaves, kept, tools, outcome);
    if (evaluates) {
      const auto memory = memory_.take([] { return std::make_unique<ColorMemory>(); });
      outcome.changed = recolor_tile(trees, tile, parts_.rays.scene(), parts_.stored, *memory);
    }
    parts_.residency.note_use_of_other("color_trees", kept.number * kept.tiles.size() + tile, trees.bytes,
                                       trees.build_seconds);
    outcome.samples = trees.samples.size();
    result.dependent[tile] = trees.leaves;
    if (room.take(outcome.samples) && parts_.residency.make_room(0)) return;
    outcome.evicted.color_trees = outcome.samples;
    outcome.evicted.bytes = trees.bytes;
    parts_.color_trees.drop(trees);  // at once, so that what cannot be kept does not pile up
  });
  count_outcomes(outcomes, tiles, result);
  if (!found.works.empty())
    parts_.selection.keep(change, std::move(found.tasks), result.dependent,
                          result.seconds.select + result.seconds.test);
  const std::uint64_t bytes_before = parts_.color_trees.bytes();
  result.counters.evicted.color_trees += parts_.color_trees.trim();
  result.counters.evicted.bytes += bytes_before - parts_.color_trees.bytes();
  watch.lap(result.seconds.evaluate);
}

}  // namespace relook
