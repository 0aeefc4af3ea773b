#include "replay/path/path_tile.h"

#include <memory>

#include "base/parallel.h"
#include "image/sampling.h"
#include "replay/path/ray_recorder.h"
#include "replay/path/relight_tile.h"
#include "replay/path/segment_recorder.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/pack.h"

namespace relook {
namespace {

/// Trees that are shaded together, and where their terms go.
struct Batch {
  TreeBlock block;
  std::vector<std::uint32_t> roots;
  std::vector<std::uint8_t> is_recorded;  // by root: its weights are to be kept
  std::vector<Color> weights;             // by node, as kept; empty: to be found

  void clear() {
    block.clear();
    roots.clear();
    is_recorded.clear();
    weights.clear();
  }
};

bool is_usable(const TileRays& rays, RayUse use) {
  return use != RayUse::none && !rays.empty() && (use != RayUse::lights || rays.has_weights());
}

Pool<PathShader>::Loan shader_of(const TilePrograms& programs, Pool<PathShader>& shaders) {
  return shaders.take(
      [&] { return std::make_unique<PathShader>(programs.scene(), programs.path(), programs.places()); });
}

Pool<TermMemory>::Loan term_memory_of(const PathPass& pass) {
  return pass.term_memory.take([] { return std::make_unique<TermMemory>(); });
}

/// Have sums other places, or are there others?
bool is_reordered(const PathPass& pass) {
  return pass.before.places().count != pass.after.places().count || !std::ranges::is_sorted(pass.change.old_of_new);
}

SegmentRecorder::Mode record_mode(const PathPass& pass, const KeptOfTile& kept) {
  const StepChange& step = pass.change.step;
  if (!step.touches_rays() || step.rays.lights_changed) return SegmentRecorder::Mode::none;
  if (!pass.segment_grid.empty() && kept.touched.empty()) return SegmentRecorder::Mode::all;
  return kept.segments.empty() ? SegmentRecorder::Mode::none : SegmentRecorder::Mode::changes;
}

bool is_left_alone(const PathPass& pass, std::span<const std::uint8_t> touched, std::uint32_t sample, PathId path) {
  return !touched.empty() && touched[sample] == 0 && pass.named_path[path.index()] == 0 &&
         pass.shade_path[path.index()] == 0;
}
void count_left_alone(const PathPass& pass, const TileSegments& segments, std::uint32_t sample,
                      CulledSegments& culled) {
  for (std::size_t kind = 0; kind < kSegmentKinds; ++kind) {
    const bool is_tested = !pass.selection.of[kind].all.isEmpty();
    (is_tested ? culled.boxes : culled.by_class) += segments.count(static_cast<SegmentKind>(kind), sample);
  }
}

class PathTileUpdater {
 public:
  /// `records_all`: every sample will be grown, unless it is known to be left alone.
  PathTileUpdater(const PathPass& pass, std::size_t tile, const KeptOfTile& kept, bool records_all)
      : pass_(pass),
        kept_(kept),
        rays_(kept.rays),
        use_(is_usable(kept.rays, pass.ray_use) ? pass.ray_use : RayUse::none),
        recorder_(kept.rays, records_all && use_ == RayUse::none && kept.touched.empty()),
        segments_(record_mode(pass, kept), kept.segments, pass.segment_grid),
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
        takes_(pass.change.any_taken()),
        is_shared_(!pass.change.step.touches_rays()),
        takes_or_shades_(takes_ || !pass.change.shaded.empty() || !pass.change.step.colors.reassigned.empty()),
        misses_are_dark_(are_misses_dark(pass)) {
    if (use_ == RayUse::lights && kept.makes_vertices) result_.vertices.emplace();
    result_.fresh.tile = tile;
    if (pass.term_parameters) terms_.parameters = *pass.term_parameters;
    changed_.block.keeps_lines = segments_.is_on();
  }

  PathTileResult update() {
    for (std::uint32_t sample = 0; sample < trees_.paths.size(); ++sample) update_sample(sample);
    flush();
    result_.keeps_vertices = !recorder_.has_news() && std::ranges::find(whole_, std::uint8_t{1}) == whole_.end();
    if (result_.vertices) result_.vertices->shrink();
    if (recorder_.has_news()) result_.rays = recorder_.take();
    take_segments();
    const bool is_remapped = is_reordered(pass_);
    // Terms say by number into which sum they go: a light that is gone may leave no sample to be shaded, but others'
    // places.
    const bool is_other = result_.samples > 0 || is_remapped || pass_.change.step.rays.lights_changed;
    if (pass_.term_parameters || is_other) result_.terms = std::move(terms_);
    if (result_.samples == 0 && !pass_.change.any_afresh() && !is_remapped) {
      result_.sums = kept_.sums;
      return std::move(result_);
    }
    TileSums all = kept_.sums.unpack();
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
    result_.terms = TileTerms();
    std::vector<SpawnedRay> rays;
    const auto count = static_cast<std::uint32_t>(trees_.paths.size());
    ChunkSize chunk(pass_.grow_after.layout().lights);
    for (std::uint32_t first = 0, last = 0; first < count; first = last) {
      last = std::min(first + chunk.samples(), count);
      rays.clear();
      primaries_.append(rect_, first, last, rays);
      trace_trees(pass_.grow_after, rays, first, changed_.block, changed_.roots, result_.counters);
      for (std::uint32_t k = 0; k < changed_.roots.size(); ++k) {
        pack_sample(changed_, changed_.roots[k], first + k);
        recorder_.record(changed_.block, changed_.roots[k], first + k);
        if (segments_.records_all()) record_segments(changed_.roots[k]);
      }
      changed_.is_recorded.assign(changed_.roots.size(), 1);
      result_.samples += last - first;
      chunk.learn(changed_.block, last - first);
      shade(changed_, *shader_after_, TermSign::add, new_terms_, {});
    }
    result_.rays = recorder_.take();
    if (!segments_.records_all() && pass_.change.step.touches_rays()) result_.segments = TileSegments();
    take_segments();
    result_.sums = PackedSums::pack(new_terms_);
    result_.has_changed = true;
    return std::move(result_);
  }

 private:
  void update_sample(std::uint32_t sample) {
    const PathId path = trees_.paths[sample];
    if (is_left_alone(pass_, kept_.touched, sample, path))
      return count_left_alone(pass_, kept_.segments, sample, result_.counters.culled);
    const bool updates = pass_.update_path[path.index()] != 0, shades = pass_.shade_path[path.index()] != 0;
    const bool relights = (adds_ || takes_) && (pass_.relight_path.empty() || pass_.relight_path[path.index()] != 0);
    if (!updates && !shades && !relights) return;
    const bool is_named = pass_.named_path[path.index()] != 0;
    const SpawnedRay primary = primaries_.ray(rect_, sample);
    StoredTree stored{PathCursor(pass_.image.paths.words(path), {pass_.change.step.rays.old_lights.size(), 0}),
                      trees_.hits_of(sample)};
    if (use_ == RayUse::lights && !result_.vertices && is_dark(stored.cursor)) return;
    const bool is_along_kept = use_ != RayUse::none && !(use_ == RayUse::tests && shades) && !is_named;
    if (is_along_kept) stored.kept = rays_.rays.data() + rays_.first[sample];
    if (use_ == RayUse::tests && stored.kept != nullptr) {
      if (stays(primary, sample, stored)) return;
      stored.kept = nullptr;
    }
    const TreeBlock::Mark mark = changed_.block.mark();
    TreeChange what = TreeChange::none;
    std::uint32_t root = 0;
    if (updates || stored.kept != nullptr)
      root = update_tree(pass_.grow_after, pass_.change.step.rays, nullptr, primary, sample, stored, changed_.block,
                         result_.counters, what);
    else
      root = expand_tree(pass_.grow_after, primary, sample, stored, changed_.block, result_.counters);
    if (what != TreeChange::none || !pass_.change.step.rays.keeps_places) pack_sample(changed_, root, sample);
    const bool is_whole = shades || what == TreeChange::all;
    const bool is_recorded = recorder_.is_on() && (recorder_.records_all() || is_whole || is_named);
    if (is_recorded) recorder_.record(changed_.block, root, sample);
    if (segments_.records_all() || (segments_.is_on() && updates && (is_named || what != TreeChange::none)))
      record_segments(root);
    const bool adds = is_whole || (relights && adds_), takes = is_whole || (relights && takes_);
    if (adds || (takes && is_shared_)) {
      changed_.roots.push_back(root);
      changed_.is_recorded.push_back(is_recorded ? 1 : 0);
      if (stored.kept != nullptr) complete_kept(root, sample);
    } else {
      changed_.block.rewind(mark);
    }
    if (!adds && !takes) return;
    ++result_.samples;
    whole_[sample] = is_whole ? 1 : 0;
    if (takes && !is_shared_)
      old_.roots.push_back(expand_tree(pass_.grow_before, primary, sample, stored, old_.block, result_.counters));
    if (ChunkSize::is_full(changed_.block, changed_.roots.size()) || ChunkSize::is_full(old_.block, old_.roots.size()))
      flush();
  }

  /// Does the tree stay as it is? Told along its kept rays.
  bool stays(const SpawnedRay& primary, std::uint32_t sample, const StoredTree& stored) {
    const TreeBlock::Mark mark = changed_.block.mark();
    GrowCounters counters;
    TreeChange what = TreeChange::none;
    update_tree(pass_.grow_after, pass_.change.step.rays, nullptr, primary, sample, stored, changed_.block, counters,
                what);
    const bool is_kept = what != TreeChange::all;
    if (is_kept && segments_.records_all()) record_segments(static_cast<std::uint32_t>(mark.nodes));
    changed_.block.rewind(mark);
    if (is_kept) result_.counters += counters;
    return is_kept;
  }

  void record_segments(std::uint32_t root) { segments_.record(pass_.grow_after.scene, changed_.block, root); }
  void take_segments() {
    if (segments_.has_news())
      result_.segments = segments_.take();
    else if (pass_.change.step.rays.lights_changed)
      result_.segments = TileSegments();
  }

  /// Is a sample whose ray from the eye meets nothing none of those that lights bring terms to?
  [[nodiscard]] bool is_dark(PathCursor cursor) const { return misses_are_dark_ && cursor.next().is_miss(); }

  /// Of a tree of kept rays that is to be shaded: weights, and the lobes of hits that lights reach.
  void complete_kept(std::uint32_t root, std::uint32_t sample) {
    if (use_ == RayUse::lights) {
      changed_.weights.emplace_back(1, 1, 1);
      const auto weights = rays_.weights_of(sample);
      changed_.weights.insert(changed_.weights.end(), weights.begin(), weights.end());
    }
    TreeBlock& block = changed_.block;
    for (std::size_t i = root; i < block.nodes.size(); ++i) {
      if (!is_lit(block.nodes[i])) continue;
      const VertexLobes lobes = find_lobes(block.nodes[i], pass_.grow_after.scene.object(block.nodes[i].object));
      if (!lobes.any()) continue;
      block.nodes[i].lobes = static_cast<std::uint32_t>(block.lobes.size());
      block.lobes.push_back(lobes);
    }
  }
  /// By a light that is looked at, or, where vertices are kept, by any.
  [[nodiscard]] bool is_lit(const RayNode& node) const {
    if (node.object.is_none()) return false;
    if (result_.vertices) return relook::is_lit(pass_.grow_after.scene.object(node.object), node);
    for (std::size_t light = 0; light < pass_.change.given.size(); ++light)
      if ((use_ == RayUse::colors || pass_.change.given[light] != 0) &&
          reaches(changed_.block.lights[node.first_light + light].state))
        return true;
    return false;
  }

  void pack_sample(const Batch& batch, std::uint32_t root, std::uint32_t sample) {
    SampleTrees& packed = result_.fresh.packed;
    words_.clear();
    const std::size_t first = packed.hits.size();
    pack(batch.block, root, pass_.grow_after.layout(), words_, packed.hits);
    if (is_as_stored(sample, std::span(packed.hits).subspan(first))) {
      packed.hits.resize(first);
      return;
    }
    packed.samples.push_back(sample);
    packed.path_of.push_back(packed.paths.intern(words_));
    packed.first_hit.push_back(hit_place(packed.hits.size()));
  }
  [[nodiscard]] bool is_as_stored(std::uint32_t sample, std::span<const Hit> hits) const {
    return pass_.change.step.rays.keeps_places && has_hits(trees_) &&
           std::ranges::equal(hits, trees_.hits_of(sample)) &&
           std::ranges::equal(words_, pass_.image.paths.words(trees_.paths[sample]));
  }

  void shade(Batch& batch, PathShader& shader, TermSign sign, TileSums& terms, PathShader::Wanted wanted) {
    if (batch.roots.empty()) return;
    wanted.weights = batch.weights;
    shader.shade(batch.block, samples_, sign, terms, wanted);
    note_weights(batch, shader);
    batch.clear();
  }
  void flush() {
    stop_if_interrupted();
    if (pass_.term_parameters) return exchange();
    const PathShader::Wanted taken{no_sums_, pass_.change.taken, whole_, {}};
    if (is_shared_ && takes_or_shades_ && !changed_.roots.empty())
      shader_before_->shade(changed_.block, samples_, TermSign::subtract, old_terms_, taken);
    shade(old_, *shader_before_, TermSign::subtract, old_terms_, taken);
    const PathShader::Wanted given{pass_.change.afresh, pass_.change.given, whole_, {}};
    if (result_.vertices)
      keep_vertices(given);
    else
      shade(changed_, *shader_after_, TermSign::add, new_terms_, given);
  }
  void keep_vertices(PathShader::Wanted wanted) {
    if (changed_.roots.empty()) return;
    wanted.weights = changed_.weights;
    shader_after_->shade_keeping(changed_.block, samples_, new_terms_, wanted, *result_.vertices);
    changed_.clear();
  }

  /// What does not change of terms is worked out once for both, and kept.
  void exchange() {
    if (changed_.roots.empty()) return;
    const auto memory = term_memory_of(pass_);
    KeptTerms kept;
    shader_after_->keep(changed_.block, samples_, *pass_.term_parameters, kept);
    exchange_terms(kept, pass_.before.scene().scene(), pass_.after.scene().scene(), pass_.after.places(), *memory,
                   new_terms_);
    note_weights(changed_, *shader_after_);
    terms_.samples += changed_.roots.size();
    terms_.blocks.push_back(std::move(kept));
    changed_.clear();
  }
  void note_weights(const Batch& batch, const PathShader& shader) {
    for (std::size_t k = 0; k < batch.is_recorded.size(); ++k)
      if (batch.is_recorded[k] != 0) recorder_.add_weights(batch.block, batch.roots[k], shader.weights());
  }

  const PathPass& pass_;
  const KeptOfTile& kept_;
  const TileRays& rays_;
  RayUse use_;
  RayRecorder recorder_;
  SegmentRecorder segments_;
  const TileTrees& trees_;
  TileRect rect_;
  std::uint32_t samples_;
  PrimaryRays primaries_;
  Pool<PathShader>::Loan shader_before_, shader_after_;
  TileSums old_terms_, new_terms_;
  std::vector<std::uint8_t> no_sums_;
  bool adds_, takes_;     // terms of some lights, beside those of samples whose terms all change
  bool is_shared_;        // trees as they were are those as they are
  bool takes_or_shades_;  // terms are taken out
  bool misses_are_dark_;  // rays from the eye that meet nothing bring nothing of the lights that are looked at
  Batch old_;             // trees as they were, of samples whose terms change, or of which some lights' are taken out
  Batch changed_;         // the same as they are now, and those of which only some lights are worked out afresh
  std::vector<std::uint8_t> whole_ = std::vector<std::uint8_t>(trees_.paths.size(), 0);  // by sample: of the first kind
  std::vector<std::uint32_t> words_;
  TileTerms terms_;
  PathTileResult result_;
};

}  // namespace

PathTileResult update_path_tile(const PathPass& pass, std::size_t tile, const KeptOfTile& kept) {
  return PathTileUpdater(pass, tile, kept, pass.updates_all).update();
}

std::optional<PathTileResult> leave_path_tile(const PathPass& pass, std::size_t tile, const TileSegments& segments,
                                              std::span<const std::uint8_t> touched) {
  if (touched.empty() || is_reordered(pass) || pass.change.any_afresh()) return std::nullopt;
  PathTileResult result;
  result.fresh.tile = tile;
  result.keeps_vertices = true;
  const std::vector<PathId>& paths = pass.image.trees[tile].paths;
  for (std::uint32_t sample = 0; sample < paths.size(); ++sample) {
    if (!is_left_alone(pass, touched, sample, paths[sample])) return std::nullopt;
    count_left_alone(pass, segments, sample, result.counters.culled);
  }
  return result;
}

PathTileResult recolor_path_tile(const PathPass& pass, std::size_t tile, const PackedSums& sums,
                                 const TileTerms& terms) {
  PathTileResult result;
  result.fresh.tile = tile;
  result.sums = sums;
  result.samples = result.reused = terms.samples;
  result.keeps_vertices = terms.samples == 0;
  if (terms.samples == 0) return result;
  TileSums all = sums.unpack();
  const auto memory = term_memory_of(pass);
  for (const KeptTerms& block : terms.blocks)
    exchange_terms(block, pass.before.scene().scene(), pass.after.scene().scene(), pass.after.places(), *memory, all);
  result.sums = PackedSums::pack(all);
  result.has_changed = result.has_other_weights = true;
  return result;
}

PathTileResult trace_path_tile(const PathPass& pass, std::size_t tile) {
  const PackedSums no_sums;
  const TileRays no_rays;
  const TileSegments no_segments;
  const KeptOfTile nothing{no_sums, no_rays, no_segments};
  return PathTileUpdater(pass, tile, nothing, true).trace();
}

}  // namespace relook
