#include "replay/path/relight_tile.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "color/path/light_terms.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

/// What stands between hits of a tile and a light.
class HitStates {
 public:
  explicit HitStates(std::size_t hits) : words_(hits, 0) {}

  void set(std::uint32_t hit, ShadowState state) { words_[hit] = static_cast<std::uint32_t>(state); }
  void set_filters(std::uint32_t hit, std::span<const FilterNode> filters) {
    words_[hit] = static_cast<std::uint32_t>(ShadowState::filtered) | static_cast<std::uint32_t>(first_.size() - 1)
                                                                          << 2U;
    for (const FilterNode& filter : filters) {
      objects_.push_back(filter.object.index());
      hits_.push_back(filter.hit);
    }
    first_.push_back(hit_place(hits_.size()));
  }

  [[nodiscard]] ShadowState state(std::uint32_t hit) const { return static_cast<ShadowState>(words_[hit] & 3U); }
  struct Filters {
    std::span<const std::uint32_t> objects;
    std::span<const Hit> hits;
  };
  /// Of a filtered light.
  [[nodiscard]] Filters filters(std::uint32_t hit) const {
    const std::size_t at = words_[hit] >> 2U, first = first_[at], count = first_[at + 1] - first;
    return {std::span(objects_).subspan(first, count), std::span(hits_).subspan(first, count)};
  }

 private:
  std::vector<std::uint32_t> words_;  // by hit: state, and place in first_
  std::vector<std::uint32_t> first_{0}, objects_;
  std::vector<Hit> hits_;
};

/// Paths of a tile with states of some lights that are new, the others as they are stored.
class Repacker {
 public:
  /// `states`: by place in the light order, of lights that are new; null: of others.
  Repacker(const PathPass& pass, std::size_t tile, std::span<const HitStates* const> states, PathTileResult& result)
      : pass_(pass),
        rays_(pass.change.step.rays),
        trees_(pass.image.trees[tile]),
        states_(states),
        old_filters_(rays_.old_lights.size()),
        misses_are_dark_(are_misses_dark(pass)),
        result_(result) {}

  void run() {
    for (std::uint32_t sample = 0; sample < trees_.paths.size(); ++sample) pack(sample);
  }

 private:
  void pack(std::uint32_t sample) {
    PathCursor cursor(pass_.image.paths.words(trees_.paths[sample]), {rays_.old_lights.size(), 0});
    SampleTrees& packed = result_.fresh.packed;
    const std::size_t first = packed.hits.size();
    words_.clear();
    stored_ = trees_.hits_of(sample);
    bool is_dark = misses_are_dark_;
    while (!cursor.at_end()) {
      const PathNode node = cursor.next();
      if (words_.empty()) is_dark = is_dark && node.is_miss();
      if (!is_dark) ++result_.counters.culled.by_class;
      if (node.is_miss())
        words_.push_back(PathTable::kMissWord);
      else
        pack(node, packed.hits);
    }
    if (!is_dark) ++result_.samples;
    if (rays_.keeps_places && std::ranges::equal(std::span(packed.hits).subspan(first), trees_.hits_of(sample)) &&
        std::ranges::equal(words_, pass_.image.paths.words(trees_.paths[sample]))) {
      packed.hits.resize(first);
      return;
    }
    packed.samples.push_back(sample);
    packed.path_of.push_back(packed.paths.intern(words_));
    packed.first_hit.push_back(hit_place(packed.hits.size()));
  }

  void pack(const PathNode& node, std::vector<Hit>& hits) {
    words_.push_back(node.object.index());
    words_.push_back(node.flags.word());
    take_hits(node, hits);
    const std::size_t at = words_.size();
    words_.resize(at + LightStates::words_of(states_.size()));
    for (std::size_t light = 0; light < states_.size(); ++light) {
      const std::uint32_t old = rays_.old_light_index[light];
      const bool is_new = old == kNoNode;
      const ShadowState state = is_new ? states_[light]->state(hit_) : shadow_state(node.lights, old);
      if (!is_new && state != ShadowState::facing_away) ++result_.counters.culled.by_class;
      std::uint32_t& word = words_[at + light / LightStates::kLights];
      LightStates with(word);
      with.set(light % LightStates::kLights, state);
      word = with.word();
      if (state != ShadowState::filtered) continue;
      const HitStates::Filters filters = is_new ? states_[light]->filters(hit_) : old_filters_[old];
      words_.push_back(static_cast<std::uint32_t>(filters.objects.size()));
      words_.insert(words_.end(), filters.objects.begin(), filters.objects.end());
      hits.insert(hits.end(), filters.hits.begin(), filters.hits.end());
    }
    for (const std::uint32_t lost : rays_.lost_lights)
      if (shadow_state(node.lights, lost) != ShadowState::facing_away) ++result_.counters.culled.dropped;
    ++hit_;
  }

  /// A node's stored hits: its own, and those of its filtered lights.
  void take_hits(const PathNode& node, std::vector<Hit>& hits) {
    hits.push_back(stored_[0]);
    stored_ = stored_.subspan(1);
    if (node.entries.empty()) return;
    EntryReader entries(node.entries, 0);
    for (std::size_t old = 0; old < old_filters_.size(); ++old) {
      const LightEntry entry = entries.next(shadow_state(node.lights, old));
      old_filters_[old] = {entry.objects, stored_.first(entry.objects.size())};
      stored_ = stored_.subspan(entry.objects.size());
    }
  }

  const PathPass& pass_;
  const RayChange& rays_;
  const TileTrees& trees_;
  std::span<const HitStates* const> states_;
  std::vector<HitStates::Filters> old_filters_;  // by old light, of the node at hand
  std::span<const Hit> stored_;                  // those to come of the sample at hand
  std::uint32_t hit_ = 0;                        // number of the next hit
  std::vector<std::uint32_t> words_;
  bool misses_are_dark_;
  PathTileResult& result_;
};

class TileRelighter {
 public:
  TileRelighter(const PathPass& pass, std::size_t tile, const TileVertices& vertices)
      : pass_(pass),
        tile_(tile),
        vertices_(vertices),
        scene_(pass.grow_after.scene),
        shader_(pass.vertex_shaders.take([&] {
          return std::make_unique<VertexShader>(pass.after.scene(), pass.after.path(), pass.after.places());
        })),
        terms_(pass.after.places().count, tile_rect(tile, pass.image.frame.width, pass.image.frame.height).pixels()),
        nodes_(kMostTogether, RayNode(kNoNode, 0, SpawnedRay{})) {
    result_.fresh.tile = tile;
    result_.keeps_vertices = true;
  }

  PathTileResult run(const PackedSums& sums) {
    const std::vector<std::uint32_t>& old_of = pass_.change.step.rays.old_light_index;
    std::vector<std::unique_ptr<HitStates>> owned;
    std::vector<const HitStates*> states(old_of.size(), nullptr);
    for (std::size_t light = 0; light < old_of.size(); ++light) {
      if (old_of[light] != kNoNode) continue;
      owned.push_back(std::make_unique<HitStates>(vertices_.hits));
      states[light] = owned.back().get();
      light_up(static_cast<std::uint32_t>(light), *owned.back());
    }
    meet();
    Repacker(pass_, tile_, states, result_).run();
    result_.terms = TileTerms();
    result_.segments = TileSegments();
    put_into(sums);
    return std::move(result_);
  }

 private:
  /// Vertices whose terms are worked out together: their columns stay in a processor's caches.
  static constexpr std::size_t kChunk = 1024;

  void light_up(std::uint32_t light, HitStates& states) {
    for (const TileVertices::Batch& batch : vertices_.batches)
      for (std::size_t first = 0; first < batch.vertices.size(); first += kChunk) {
        stop_if_interrupted();
        const std::size_t last = std::min(first + kChunk, batch.vertices.size());
        filters_.clear();
        lit_.clear();
        for (std::size_t k = first; k < last; k += kMostTogether)
          light_up(light, batch, k, std::min(kMostTogether, last - k), states);
        shader_->add_lit(batch, filters_, lit_, terms_);
      }
  }

  void light_up(std::uint32_t light, const TileVertices::Batch& batch, std::size_t first, std::size_t count,
                HitStates& states) {
    std::array<const RayNode*, kMostTogether> nodes;
    std::array<ShadowSegment, kMostTogether> segments;
    for (std::size_t k = 0; k < count; ++k) {
      batch.vertices[first + k].restore(nodes_[k]);
      nodes[k] = &nodes_[k];
    }
    shadow_segments(std::span(nodes).first(count), scene_.light(light), std::span(segments).first(count));
    for (std::size_t k = 0; k < count; ++k)
      if (segments[k].faces) shoot(light, batch, first + k, nodes_[k], segments[k], states);
  }

  void shoot(std::uint32_t light, const TileVertices::Batch& batch, std::size_t place, const RayNode& node,
             const ShadowSegment& segment, HitStates& states) {
    const LitVertex& vertex = batch.vertices[place];
    ++result_.counters.shadow_updates;
    if (!Tracer::passes(*pass_.grow_after.level, segment.ray(), crossings_)) {
      states.set(vertex.hit, ShadowState::blocked);
      return;
    }
    const std::size_t first_filter = filters_.filters.size();
    for (const Crossing& crossing : crossings_) {
      FilterNode& filter = filters_.filters.emplace_back();
      filter.object = crossing.object;
      filter.hit = crossing.hit;
    }
    const std::span<FilterNode> filters = std::span(filters_.filters).subspan(first_filter);
    if (filters.empty()) {
      states.set(vertex.hit, ShadowState::open);
    } else {
      complete_filters(scene_, node, segment, filters.data(), filters.size());
      states.set_filters(vertex.hit, filters);
    }
    if (vertex.weight == Color(0, 0, 0) || pass_.change.given[light] == 0) return;
    VertexLobes lobes;
    const bool has_lobes = vertex.has_lobes() && scene_.light(light).is_soft();
    if (has_lobes)
      lobes = vertex.other_lobes != kNoNode ? batch.other_lobes[vertex.other_lobes] : vertex.lobes.restored();
    auto term =
        light_term(pass_.after.scene(),
                   {node, has_lobes ? &lobes : nullptr, filters, segment.sample ? &*segment.sample : nullptr}, light);
    if (!term) return;
    term->columns = batch.values.data() + place * batch.columns;
    lit_.push_back({*term, vertex.weight, vertex.scale, vertex.pixel, static_cast<std::uint32_t>(first_filter),
                    static_cast<std::uint32_t>(filters.size())});
  }

  /// What rays bring of the lights, and of the sky.
  void meet() {
    const VertexShader::Wanted wanted{pass_.change.afresh, pass_.change.given};
    shader_->add_met(vertices_.leaving, true, wanted, terms_);
    bool crosses = false;
    for (std::size_t light = 0; light < pass_.change.given.size(); ++light)
      crosses = crosses || (pass_.change.given[light] != 0 && scene_.light(light).shape);
    if (crosses) shader_->add_met(vertices_.crossing, false, wanted, terms_);
  }

  void put_into(const PackedSums& sums) {
    TileSums all = sums.unpack().remapped(pass_.change.old_of_new);
    for (std::size_t sum = 0; sum < pass_.change.afresh.size(); ++sum)
      if (pass_.change.afresh[sum] != 0) all.clear(sum);
    all.add(terms_);
    result_.sums = PackedSums::pack(all);
    result_.has_changed = true;
  }

  const PathPass& pass_;
  std::size_t tile_;
  const TileVertices& vertices_;
  const RayScene& scene_;
  Pool<VertexShader>::Loan shader_;
  TileSums terms_;
  std::vector<RayNode> nodes_;  // of vertices at hand
  TreeBlock filters_;           // of the chunk at hand, and nothing else
  std::vector<LitTerm> lit_;    // of the chunk
  std::vector<Crossing> crossings_;
  PathTileResult result_;
};

}  // namespace

bool are_misses_dark(const PathPass& pass) {
  const auto& lights = pass.grow_after.scene.light_order();
  for (std::size_t place = 0; place < pass.change.given.size(); ++place) {
    if (pass.change.given[place] == 0) continue;
    const Light& light = pass.after.scene().scene().light(lights[place]);
    if (light.visible || !traits_of(light.kind).in_document) return false;
  }
  const SumPlaces& sums = pass.after.places();
  const auto is_afresh = [&](std::uint32_t source) { return pass.change.afresh[sums.sum_of[source]] != 0; };
  return !is_afresh(sums.sky) && !is_afresh(sums.background) && pass.change.step.rays.keeps_places;
}

bool may_use_vertices(const PathPass& pass) {
  const PathChange& change = pass.change;
  if (pass.ray_use != RayUse::lights || !pass.updates_all || !pass.relight_path.empty() ||
      pass.grow_after.level == nullptr || change.afresh[pass.after.places().background] != 0)
    return false;
  const auto& lights = pass.grow_after.scene.light_order();
  for (std::size_t place = 0; place < change.given.size(); ++place) {
    if (change.given[place] == 0) continue;
    const Light& light = pass.after.scene().scene().light(lights[place]);
    if (change.step.rays.old_light_index[place] != kNoNode ||
        (light.visible && pass.grow_after.scene.light(place).shape))
      return false;
  }
  return true;
}

PathTileResult relight_path_tile(const PathPass& pass, std::size_t tile, const PackedSums& sums,
                                 const TileVertices& vertices) {
  return TileRelighter(pass, tile, vertices).run(sums);
}

}  // namespace relook
