#include "replay/path/path_tile.h"

#include <memory>

#include "base/parallel.h"
#include "image/sampling.h"
#include "trace/tree/pack.h"

namespace relook {
namespace {

/// Trees that are shaded together, and where their terms go.
struct Batch {
  TreeBlock block;
  std::vector<std::uint32_t> roots;
};

Pool<PathShader>::Loan shader_of(const TilePrograms& programs, Pool<PathShader>& shaders) {
  return shaders.take(
      [&] { return std::make_unique<PathShader>(programs.scene(), programs.path(), programs.places()); });
}

class PathTileUpdater {
 public:
  PathTileUpdater(const PathPass& pass, std::size_t tile)
      : pass_(pass),
        trees_(pass.image.trees[tile]),
        rect_(tile_rect(tile, pass.image.frame.width, pass.image.frame.height)),
        samples_(pass.image.view.samples),
        primaries_(pass.grow_after.scene.camera(), pass.image.view),
        shader_before_(shader_of(pass.before, pass.shaders_before)),
        shader_after_(shader_of(pass.after, pass.shaders_after)),
        old_terms_(pass.before.places().count, rect_.pixels()),
        new_terms_(pass.after.places().count, rect_.pixels()),
        no_sums_(pass.before.places().count, 0),
        adds_(pass.change.any_afresh() || pass.change.any_given()),
        takes_(pass.change.any_taken()) {
    result_.fresh.tile = tile;
  }

  PathTileResult update(const PackedSums& sums) {
    for (std::uint32_t sample = 0; sample < trees_.paths.size(); ++sample) update_sample(sample);
    flush();
    const bool is_reordered = pass_.before.places().count != pass_.after.places().count ||
                              !std::ranges::is_sorted(pass_.change.old_of_new);
    if (result_.samples == 0 && !pass_.change.any_afresh() && !is_reordered) {
      result_.sums = sums;
      return std::move(result_);
    }
    TileSums all = sums.unpack();
    all.add(old_terms_);
    all = all.remapped(pass_.change.old_of_new);
    for (std::size_t sum = 0; sum < pass_.change.afresh.size(); ++sum)
      if (pass_.change.afresh[sum] != 0) all.clear(sum);
    all.add(new_terms_);
    result_.sums = PackedSums::pack(all);
    result_.has_changed = true;
    return std::move(result_);
  }

  PathTileResult trace() {
    std::vector<SpawnedRay> rays;
    const auto count = static_cast<std::uint32_t>(trees_.paths.size());
    ChunkSize chunk(pass_.grow_after.layout().lights);
    for (std::uint32_t first = 0, last = 0; first < count; first = last) {
      last = std::min(first + chunk.samples(), count);
      rays.clear();
      primaries_.append(rect_, first, last, rays);
      trace_trees(pass_.grow_after, rays, first, changed_.block, changed_.roots, result_.counters);
      for (std::uint32_t k = 0; k < changed_.roots.size(); ++k) pack_sample(changed_, changed_.roots[k], first + k);
      result_.samples += last - first;
      chunk.learn(changed_.block, last - first);
      shade(changed_, *shader_after_, TermSign::add, new_terms_, {});
    }
    result_.sums = PackedSums::pack(new_terms_);
    result_.has_changed = true;
    return std::move(result_);
  }

 private:
  void update_sample(std::uint32_t sample) {
    const PathId path = trees_.paths[sample];
    const bool updates = pass_.update_path[path.index()] != 0, shades = pass_.shade_path[path.index()] != 0;
    const bool relights = (adds_ || takes_) && (pass_.relight_path.empty() || pass_.relight_path[path.index()] != 0);
    if (!updates && !shades && !relights) return;
    const SpawnedRay primary = primaries_.ray(rect_, sample);
    const std::span<const std::uint32_t> words = pass_.image.paths.words(path);
    const StoredTree stored{PathCursor(words, {pass_.change.step.rays.old_lights.size(), 0}), trees_.hits_of(sample)};
    const TreeBlock::Mark mark = changed_.block.mark();
    TreeChange what = TreeChange::none;
    std::uint32_t root = 0;
    if (updates)
      root = update_tree(pass_.grow_after, pass_.change.step.rays, nullptr, primary, sample, stored, changed_.block,
                         result_.counters, what);
    else
      root = expand_tree(pass_.grow_after, primary, sample, stored, changed_.block, result_.counters);
    if (what != TreeChange::none || pass_.change.step.rays.lights_changed) pack_sample(changed_, root, sample);
    const bool is_whole = shades || what == TreeChange::all;
    const bool adds = is_whole || (relights && adds_), takes = is_whole || (relights && takes_);
    if (adds)
      changed_.roots.push_back(root);
    else
      changed_.block.rewind(mark);
    if (!adds && !takes) return;
    ++result_.samples;
    whole_[sample] = is_whole ? 1 : 0;
    if (takes)
      old_.roots.push_back(expand_tree(pass_.grow_before, primary, sample, stored, old_.block, result_.counters));
    if (ChunkSize::is_full(changed_.block, changed_.roots.size()) || ChunkSize::is_full(old_.block, old_.roots.size()))
      flush();
  }

  void pack_sample(const Batch& batch, std::uint32_t root, std::uint32_t sample) {
    SampleTrees& packed = result_.fresh.packed;
    words_.clear();
    packed.samples.push_back(sample);
    pack(batch.block, root, pass_.grow_after.layout(), words_, packed.hits);
    packed.path_of.push_back(packed.paths.intern(words_));
    packed.first_hit.push_back(hit_place(packed.hits.size()));
  }

  void shade(Batch& batch, PathShader& shader, TermSign sign, TileSums& terms,
             const PathShader::Wanted& wanted) {
    if (batch.roots.empty()) return;
    shader.shade(batch.block, samples_, sign, terms, wanted);
    batch.block.clear();
    batch.roots.clear();
  }
  void flush() {
    stop_if_interrupted();
    shade(old_, *shader_before_, TermSign::subtract, old_terms_, {no_sums_, pass_.change.taken, whole_});
    shade(changed_, *shader_after_, TermSign::add, new_terms_, {pass_.change.afresh, pass_.change.given, whole_});
  }

  const PathPass& pass_;
  const TileTrees& trees_;
  TileRect rect_;
  std::uint32_t samples_;
  PrimaryRays primaries_;
  Pool<PathShader>::Loan shader_before_, shader_after_;
  TileSums old_terms_, new_terms_;
  std::vector<std::uint8_t> no_sums_;
  bool adds_, takes_;  // terms of some lights, beside those of samples whose terms all change
  Batch old_;      // trees as they were, of samples whose terms change, or of which some lights' are taken out
  Batch changed_;  // the same as they are now, and those of which only some lights are worked out afresh
  std::vector<std::uint8_t> whole_ = std::vector<std::uint8_t>(trees_.paths.size(), 0);  // by sample: of the first kind
  std::vector<std::uint32_t> words_;
  PathTileResult result_;
};

}  // namespace

PathTileResult update_path_tile(const PathPass& pass, std::size_t tile, const PackedSums& sums) {
  return PathTileUpdater(pass, tile).update(sums);
}

PathTileResult trace_path_tile(const PathPass& pass, std::size_t tile) { return PathTileUpdater(pass, tile).trace(); }

}  // namespace relook
