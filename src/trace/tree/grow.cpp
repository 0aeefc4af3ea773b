#include "trace/tree/grow.h"

#include "base/parallel.h"
#include "trace/object_rays.h"
#include "trace/tree/grower.h"

namespace relook {
namespace {

class Expander {
 public:
  Expander(const GrowScene& grow, std::uint32_t sample, StoredTree stored, TreeBlock& block, GrowCounters& counters)
      : grower_(grow, sample, block),
        stored_(stored),
        is_kept_(stored.hits.has_value()),
        rays_(grow.objects, counters) {}

  std::uint32_t expand(const SpawnedRay& ray, std::uint32_t parent) {
    const std::uint32_t index = grower_.append(ray, parent);
    std::span<const Hit> hits;
    const PathNode node = take(stored_, hits);
    if (node.is_miss()) return index;
    if (is_kept_) {
      grower_.set_hit(index, node.object, hits.front());
    } else {
      const Meeting meeting = rays_.meeting(node.object, ray_of(ray));  // what it goes on behind was found before
      grower_.set_hit(index, node.object, meeting.hit);
      grower_.block().nodes[index].t = meeting.t;
    }
    EntryReader entries(node.entries, grower_.grow().shadow_bits);
    FilterReader filters(is_kept_ ? hits.subspan(1) : hits);
    ShadowSegment segment;
    for (std::size_t light = 0; light < grower_.lights().size(); ++light) {
      const ShadowState state = shadow_state(node.lights, light);
      const LightEntry entry = entries.next(state);
      if (entry.words.empty()) {
        grower_.set_link(index, light, state);
      } else if (state == ShadowState::blocked) {
        grower_.set_blocked(index, light, entry.words);
      } else {
        grower_.gathers(index, light, segment);
        if (is_kept_)
          filters.next(entry.objects, grower_.filters_);
        else
          find_filters(entry.objects, segment);
        grower_.set_filters(index, light, segment, grower_.filters_);
      }
    }
    if (!grower_.grow().rule().may_spawn(grower_.grow().scene.object(node.object)) && node.children() == 0) return index;
    Spawned rays;
    grower_.find_spawned(index, rays);
    if (rays.branches() != node.branches()) refuse_trees();
    grower_.for_each_child(index, rays, [&](Branch, const SpawnedRay& child) { return expand(child, index); });
    return index;
  }
  [[nodiscard]] std::uint64_t found() const { return rays_.found(); }

 private:
  void find_filters(std::span<const std::uint32_t> objects, const ShadowSegment& segment) {
    grower_.filters_.clear();
    for (const Crossing& crossing : rays_.filters(objects, segment)) grower_.filters_.push_back(filter_of(crossing));
  }

  Grower grower_;
  StoredTree stored_;
  bool is_kept_;
  ObjectRays rays_;
};

}  // namespace

void trace_trees(const GrowScene& grow, std::span<const SpawnedRay> primaries, std::uint32_t first_sample,
                 TreeBlock& block, std::vector<std::uint32_t>& roots, GrowCounters& counters) {
  stop_if_interrupted();
  std::vector<Meeting> meetings;
  meetings.reserve(primaries.size());
  for (const SpawnedRay& ray : primaries) meetings.push_back(Tracer::intersect(*grow.level, ray_of(ray)));
  counters.ray_updates += primaries.size();
  const auto first_node = static_cast<std::uint32_t>(block.nodes.size());
  for (std::size_t k = 0; k < primaries.size(); ++k) {
    Grower grower(grow, first_sample + static_cast<std::uint32_t>(k), block);
    roots.push_back(grower.append(primaries[k], kNoNode));
    grower.trace_from(roots.back(), meetings[k], counters);
  }
  Grower(grow, first_sample, block).trace_lights(first_node, counters);
}

std::uint32_t expand_tree(const GrowScene& grow, const SpawnedRay& primary, std::uint32_t sample, StoredTree stored,
                          TreeBlock& block, GrowCounters& counters) {
  Expander expander(grow, sample, stored, block, counters);
  const std::uint32_t root = expander.expand(primary, kNoNode);
  if (expander.found() > 0) ++counters.trees_rebuilt;
  counters.hits_rebuilt += expander.found();
  return root;
}

}  // namespace relook
