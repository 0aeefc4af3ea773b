// What growing and updating of ray trees share, inside src/trace: appending nodes to a block, tracing them against the
// whole scene, and walking stored trees.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <span>
#include <vector>

#include "trace/shadow/shadow_counter.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/grow.h"
#include "trace/tree/spawn.h"

namespace relook {

[[nodiscard]] inline FilterNode filter_of(const Crossing& crossing) {
  FilterNode filter;
  filter.object = crossing.object;
  filter.hit = crossing.hit;
  return filter;
}

/// Asks for what is read of a node to sample lights.
inline void prefetch(const RayNode& node) {
  __builtin_prefetch(&node.object);
  __builtin_prefetch(&node.ray.path);
  __builtin_prefetch(&node.coverage);
  __builtin_prefetch(&node.point.geometric);
}

/// Appends nodes to a block; the scene and the sample stay the same.
class Grower {
 public:
  Grower(const GrowScene& grow, std::uint32_t sample, TreeBlock& block) : g_(grow), sample_(sample), b_(block) {}

  std::uint32_t append(const SpawnedRay& ray, std::uint32_t parent) {
    b_.nodes.emplace_back(parent, sample_, ray);
    return static_cast<std::uint32_t>(b_.nodes.size() - 1);
  }

  /// `coverage`: its choice, or null: it is found.
  void set_hit(std::uint32_t index, ObjectId object, const Hit& hit, const CoverageChoice* coverage = nullptr) {
    RayNode& node = b_.nodes[index];
    node.object = object;
    node.hit = hit;
    complete(node, g_.scene.object(object), coverage);
    node.first_light = static_cast<std::uint32_t>(b_.lights.size());
    if (b_.lights.size() + lights().size() > kNoNode) throw std::bad_alloc();  // more than first_light can tell
    b_.resize_lights(b_.lights.size() + lights().size());
  }

  /// The ray as it is traced: behind the hit that it goes straight on from.
  [[nodiscard]] Ray whole_ray(const SpawnedRay& ray, GrowCounters& counters) const {
    Ray whole = ray_of(ray);
    if (!ray.goes_on() || !std::isnan(ray.behind.t)) return whole;
    ++counters.object_rays;
    whole.behind.t =
        Tracer::distance(g_.objects->of(ray.behind.object), {ray.origin, ray.direction}, ray.behind.hit.primitive);
    return whole;
  }

  /// `rays`: empty.
  void find_spawned(std::uint32_t index, Spawned& rays) {
    RayNode& node = b_.nodes[index];
    spawn(node, g_.scene.object(node.object), g_.rule(), rays);
    node.cut = rays.cut;
    if (rays.lobes) {
      node.lobes = static_cast<std::uint32_t>(b_.lobes.size());
      b_.lobes.push_back(*rays.lobes);
    }
  }

  /// Calls grow_child(branch, ray) -> index for each spawned ray, in order.
  template <class GrowChild>
  void for_each_child(std::uint32_t index, const Spawned& rays, const GrowChild& grow_child) {
    for (std::size_t b = 0; b < kBranches; ++b) {
      const auto branch = static_cast<Branch>(b);
      if (!rays.branches().has(branch)) continue;
      const std::uint32_t child = grow_child(branch, rays.ray(branch));
      b_.nodes[index].child[b] = child;
    }
  }

  void set_link(std::uint32_t index, std::size_t light, ShadowState state) {
    b_.lights[b_.nodes[index].first_light + light].state = state;
  }
  /// The same with the surfaces that a segment crosses.
  void set_crossings(std::uint32_t index, std::size_t light, const ShadowSegment& segment,
                     std::span<const Crossing> crossings) {
    filters_.clear();
    for (const Crossing& crossing : crossings) filters_.push_back(filter_of(crossing));
    set_filters(index, light, segment, filters_);
  }
  void set_filters(std::uint32_t index, std::size_t light, const ShadowSegment& segment,
                   std::span<const FilterNode> filters) {
    LightLink& link = b_.lights[b_.nodes[index].first_light + light];
    link.state = filters.empty() ? ShadowState::open : ShadowState::filtered;
    link.first = static_cast<std::uint32_t>(b_.filters.size());
    link.filters = static_cast<std::uint32_t>(filters.size());
    if (segment.sample) {
      link.sample = static_cast<std::uint32_t>(b_.samples.size());
      b_.samples.push_back(*segment.sample);
    }
    b_.filters.insert(b_.filters.end(), filters.begin(), filters.end());
    complete_filters(g_.scene, b_.nodes[index], segment, b_.filters.data() + link.first, filters.size());
  }

  /// `entry`: as in paths.
  void set_blocked(std::uint32_t index, std::size_t light, std::span<const std::uint32_t> entry) {
    std::ranges::copy(entry, append_entry(index, light, entry.size()).begin());
  }

  /// The segment to a light, if light is gathered here at all.
  bool gathers(std::uint32_t index, std::size_t light, ShadowSegment& segment) const {
    const RayNode& node = b_.nodes[index];
    if (!is_lit(g_.scene.object(node.object), node)) return false;
    segment = shadow_segment(node, g_.scene.light(light));
    if (segment.faces) keep_line(node, light, segment);
    return segment.faces;
  }

  /// Traces one shadow segment against the whole scene.
  void trace_light(std::uint32_t index, std::size_t light, const ShadowSegment& segment, GrowCounters& counters) {
    ++counters.shadow_updates;
    const Ray ray = segment.ray();
    if (g_.shadow_bits > 0) {
      Tracer::blockers(*g_.level, ray, crossings_);
      if (std::ranges::any_of(crossings_, [&](const Crossing& c) { return !passes_light(c); })) {
        count_blockers(index, light);
        return;
      }
    } else if (!Tracer::passes(*g_.level, ray, crossings_)) {
      set_link(index, light, ShadowState::blocked);
      return;
    }
    set_crossings(index, light, segment, crossings_);
  }

  /// Traces the shadow segments of all nodes from `first` on: apart from the rays, and some hits at a time sampled, light
  /// by light, before they are traced, since like work in a row runs faster.
  void trace_lights(std::uint32_t first, GrowCounters& counters) {
    std::array<std::uint32_t, kMostTogether> hits;
    std::array<const RayNode*, kMostTogether> nodes;
    std::vector<ShadowSegment> segments(kMostTogether * lights().size());  // light by light
    for (std::uint32_t index = first; index < b_.nodes.size();) {
      std::size_t count = 0;
      for (; index < b_.nodes.size() && count < kMostTogether; ++index) {
        const RayNode& node = b_.nodes[index];
        if (node.object.is_none() || !is_lit(g_.scene.object(node.object), node)) continue;
        nodes[count] = &node;
        hits[count++] = index;
      }
      for (std::size_t light = 0; light < lights().size(); ++light)
        shadow_segments(std::span(nodes).first(count), g_.scene.light(light),
                        std::span(segments).subspan(light * kMostTogether, count));
      // The block is larger than the nearest caches, and tracing uses them, too.
      for (std::size_t ahead = index; ahead < std::min(index + kMostTogether, b_.nodes.size()); ++ahead)
        prefetch(b_.nodes[ahead]);
      for (std::size_t k = 0; k < count; ++k)
        for (std::size_t light = 0; light < lights().size(); ++light) {
          const ShadowSegment& segment = segments[light * kMostTogether + k];
          if (!segment.faces) continue;
          keep_line(*nodes[k], light, segment);
          trace_light(hits[k], light, segment, counters);
        }
    }
  }

  /// Appends a node and everything below it, traced, but for the lights.
  std::uint32_t trace(const SpawnedRay& ray, std::uint32_t parent, GrowCounters& counters) {
    const std::uint32_t index = append(ray, parent);
    ++counters.ray_updates;
    trace_from(index, Tracer::intersect(*g_.level, whole_ray(ray, counters)), counters);
    return index;
  }

  /// Everything below a node whose ray met `meeting`.
  void trace_from(std::uint32_t index, const Meeting& meeting, GrowCounters& counters) {
    if (meeting.object.is_none()) return;
    set_hit(index, meeting.object, meeting.hit);
    b_.nodes[index].t = meeting.t;
    if (!g_.rule().may_spawn(g_.scene.object(meeting.object))) return;
    Spawned rays;
    find_spawned(index, rays);
    for_each_child(index, rays, [&](Branch, const SpawnedRay& ray) { return trace(ray, index, counters); });
  }

  [[nodiscard]] const std::vector<LightId>& lights() const { return g_.scene.light_order(); }
  [[nodiscard]] TreeBlock& block() { return b_; }
  [[nodiscard]] const GrowScene& grow() const { return g_; }
  std::vector<Crossing> crossings_;
  std::vector<FilterNode> filters_;

 private:
  void keep_line(const RayNode& node, std::size_t light, const ShadowSegment& segment) const {
    if (b_.keeps_lines) b_.lines[node.first_light + light] = {segment.origin, segment.direction, segment.t_max};
  }

  [[nodiscard]] bool passes_light(const Crossing& crossing) const {
    return g_.scene.object(crossing.object).optics.passes_light;
  }

  /// Makes a light blocked, with an entry of `size` words to be filled.
  std::span<std::uint32_t> append_entry(std::uint32_t index, std::size_t light, std::size_t size) {
    LightLink& link = b_.lights[b_.nodes[index].first_light + light];
    link.state = ShadowState::blocked;
    link.first = static_cast<std::uint32_t>(b_.blocker_words.size());
    b_.blocker_words.resize(b_.blocker_words.size() + size);
    return std::span(b_.blocker_words).subspan(link.first);
  }

  /// A light that opaque objects block, from all crossings of its segment (paper 4.2).
  void count_blockers(std::uint32_t index, std::size_t light) {
    const auto is_transparent = [&](const Crossing& crossing) { return passes_light(crossing); };
    const auto surfaces = static_cast<std::size_t>(std::ranges::count_if(crossings_, is_transparent));
    const std::span<std::uint32_t> entry = append_entry(index, light, entry_size(surfaces, ShadowState::blocked));
    entry[0] = static_cast<std::uint32_t>(surfaces);
    std::array<ObjectId, ShadowCounter::most(ShadowCounter::kMostBits) + 1> distinct;  // of an interval
    std::size_t blockers = 0, interval = 0;
    const auto end_interval = [&] {
      entry[1 + surfaces + interval++] = ShadowCounter::of(blockers, g_.shadow_bits).word();
      blockers = 0;
    };
    for (const Crossing& crossing : crossings_) {
      if (passes_light(crossing)) {
        entry[1 + interval] = crossing.object.index();
        end_interval();
      } else if (blockers < distinct.size() &&
                 std::ranges::count(std::span(distinct).first(blockers), crossing.object) == 0) {
        distinct[blockers++] = crossing.object;
      }
    }
    end_interval();
  }

  const GrowScene& g_;
  std::uint32_t sample_;
  TreeBlock& b_;
};

/// Reads the filters of a stored node, light by light. `hits`: those after the node's own.
class FilterReader {
 public:
  explicit FilterReader(std::span<const Hit> hits) : hits_(hits) {}
  /// Those of the next filtered light, whose objects are `objects`.
  void next(std::span<const std::uint32_t> objects, std::vector<FilterNode>& filters) {
    filters.clear();
    for (const std::uint32_t object : objects) {
      FilterNode filter;
      filter.object = ObjectId(object);
      filter.hit = hits_[next_++];
      filters.push_back(filter);
    }
  }

 private:
  std::span<const Hit> hits_;
  std::size_t next_ = 0;
};

/// Takes the next node and its hits off a stored tree: its own, then those of its filters. A node
/// that is a hit has none if hits are not kept.
[[nodiscard]] inline PathNode take(StoredTree& stored, std::span<const Hit>& hits) {
  const PathNode node = stored.cursor.next();
  hits = {};
  if (node.is_miss() || !stored.hits) return node;
  const std::size_t count = 1 + node.filter_hits;
  hits = stored.hits->first(count);
  stored.hits = stored.hits->subspan(count);
  return node;
}

/// Leaves out what is below a node. Returns the number of segments left out.
inline std::uint64_t skip_children(StoredTree& stored, const PathNode& node) {
  std::uint64_t segments = 0;
  for (unsigned owed = node.children(); owed > 0; --owed) {
    std::span<const Hit> hits;
    const PathNode below = take(stored, hits);
    segments += below.segments();
    owed += below.children();
  }
  return segments;
}

inline std::uint64_t skip_tree(StoredTree& stored) {
  std::span<const Hit> hits;
  const PathNode node = take(stored, hits);
  return node.segments() + skip_children(stored, node);
}

}  // namespace relook
