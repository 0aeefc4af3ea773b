#include "trace/grow.h"

#include <cmath>

#include "base/error.h"

namespace relook {
namespace {

FilterNode filter_of(const Crossing& crossing) {
  FilterNode filter;
  filter.object = crossing.object;
  filter.hit = crossing.hit;
  return filter;
}

/// Appends nodes to a block; the scene and the sample stay the same.
class Grower {
 public:
  Grower(const GrowScene& grow, std::uint32_t sample, TreeBlock& block) : g_(grow), sample_(sample), b_(block) {}

  std::uint32_t append(const SpawnedRay& ray, std::uint32_t parent) {
    b_.nodes.emplace_back(parent, sample_, ray);
    return static_cast<std::uint32_t>(b_.nodes.size() - 1);
  }

  void set_hit(std::uint32_t index, ObjectId object, const Hit& hit) {
    RayNode& node = b_.nodes[index];
    node.object = object;
    node.hit = hit;
    complete(node, g_.scene.object(object));
    node.first_light = static_cast<std::uint32_t>(b_.lights.size());
    b_.lights.resize(b_.lights.size() + lights().size());
  }

  Spawned spawned(std::uint32_t index) {
    RayNode& node = b_.nodes[index];
    const Spawned rays = spawn(node, g_.scene.object(node.object), g_.max_depth);
    node.cut_mask = rays.cut_mask;
    return rays;
  }

  /// Calls grow_child(branch, ray) -> index for each spawned ray, in order.
  template <class GrowChild>
  void for_each_child(std::uint32_t index, const Spawned& rays, const GrowChild& grow_child) {
    for (std::size_t branch = 0; branch < kBranches; ++branch) {
      if ((rays.mask >> branch & 1U) == 0) continue;
      const std::uint32_t child = grow_child(static_cast<Branch>(branch), rays.rays[branch]);
      b_.nodes[index].child[branch] = child;
    }
  }

  void set_link(std::uint32_t index, std::size_t light, ShadowState state) {
    b_.lights[b_.nodes[index].first_light + light].state = state;
  }
  void set_filters(std::uint32_t index, std::size_t light, const ShadowSegment& segment,
                   std::span<const FilterNode> filters) {
    LightLink& link = b_.lights[b_.nodes[index].first_light + light];
    link.state = filters.empty() ? ShadowState::open : ShadowState::filtered;
    link.first_filter = static_cast<std::uint32_t>(b_.filters.size());
    link.filters = static_cast<std::uint32_t>(filters.size());
    b_.filters.insert(b_.filters.end(), filters.begin(), filters.end());
    complete_filters(g_.scene, b_.nodes[index], segment, b_.filters.data() + link.first_filter, filters.size());
  }

  /// The segment to a light, if light is gathered here at all.
  bool gathers(std::uint32_t index, std::size_t light, ShadowSegment& segment) const {
    const RayNode& node = b_.nodes[index];
    if (is_interface_only(g_.scene.object(node.object), node.point)) return false;
    segment = shadow_segment(node.point, g_.scene.scene().light(lights()[light]));
    return segment.faces;
  }

  /// Traces one shadow segment against the whole scene.
  void trace_light(std::uint32_t index, std::size_t light, const ShadowSegment& segment, GrowCounters& counters) {
    ++counters.shadow_updates;
    if (!Tracer::passes(*g_.level, {segment.origin, segment.direction, segment.t_max}, crossings_)) {
      set_link(index, light, ShadowState::blocked);
      return;
    }
    filters_.clear();
    for (const Crossing& crossing : crossings_) filters_.push_back(filter_of(crossing));
    set_filters(index, light, segment, filters_);
  }

  /// Traces the shadow segments of all nodes from `first` on: apart from the rays, since like work in a row runs
  /// faster.
  void trace_lights(std::uint32_t first, GrowCounters& counters) {
    ShadowSegment segment;
    for (std::uint32_t index = first; index < b_.nodes.size(); ++index) {
      if (b_.nodes[index].object.is_none()) continue;
      for (std::size_t light = 0; light < lights().size(); ++light)
        if (gathers(index, light, segment)) trace_light(index, light, segment, counters);
    }
  }

  /// Appends a node and everything below it, traced, but for the lights.
  std::uint32_t trace(const SpawnedRay& ray, std::uint32_t parent, GrowCounters& counters) {
    const std::uint32_t index = append(ray, parent);
    ++counters.ray_updates;
    trace_from(index, Tracer::intersect(*g_.level, {ray.origin, ray.direction}), counters);
    return index;
  }

  /// Everything below a node whose ray met `meeting`.
  void trace_from(std::uint32_t index, const Meeting& meeting, GrowCounters& counters) {
    if (meeting.object.is_none()) return;
    set_hit(index, meeting.object, meeting.hit);
    if (!g_.scene.object(meeting.object).optics.spawns()) return;
    for_each_child(index, spawned(index), [&](Branch, const SpawnedRay& ray) { return trace(ray, index, counters); });
  }

  [[nodiscard]] const std::vector<LightId>& lights() const { return g_.scene.scene().light_order; }
  [[nodiscard]] TreeBlock& block() { return b_; }
  [[nodiscard]] const GrowScene& grow() const { return g_; }
  std::vector<Crossing> crossings_;
  std::vector<FilterNode> filters_;

 private:
  const GrowScene& g_;
  std::uint32_t sample_;
  TreeBlock& b_;
};

/// Reads the filters that follow a stored node's hit, light by light.
class StoredFilters {
 public:
  StoredFilters(const PathNode& node, const Hit* hits) : words_(node.filters), hits_(hits) {}
  /// The next filtered light's list.
  void next(std::vector<FilterNode>& filters) {
    const std::uint32_t count = words_[word_++];
    filters.clear();
    for (std::uint32_t f = 0; f < count; ++f) {
      FilterNode filter;
      filter.object = ObjectId(words_[word_++]);
      filter.hit = *hits_++;
      filters.push_back(filter);
    }
  }

 private:
  std::span<const std::uint32_t> words_;
  std::size_t word_ = 0;
  const Hit* hits_;
};

/// Takes the next node and its hits off a stored tree.
PathNode take(StoredTree& stored, const Hit*& hits) {
  const PathNode node = stored.cursor.next();
  hits = stored.hits;
  if (!node.is_miss()) stored.hits += 1 + node.filter_hits;
  return node;
}

void skip_children(StoredTree& stored, const PathNode& node) {
  for (unsigned owed = node.children(); owed > 0; --owed) {
    const Hit* hits = nullptr;
    owed += take(stored, hits).children();
  }
}

void skip_tree(StoredTree& stored) {
  const Hit* hits = nullptr;
  const PathNode node = take(stored, hits);
  skip_children(stored, node);
}

class Expander {
 public:
  Expander(const GrowScene& grow, std::uint32_t sample, StoredTree stored, TreeBlock& block)
      : grower_(grow, sample, block), stored_(stored) {}

  std::uint32_t expand(const SpawnedRay& ray, std::uint32_t parent) {
    const std::uint32_t index = grower_.append(ray, parent);
    const Hit* hits = nullptr;
    const PathNode node = take(stored_, hits);
    if (node.is_miss()) return index;
    grower_.set_hit(index, node.object(), *hits);
    StoredFilters filters(node, hits + 1);
    ShadowSegment segment;
    for (std::size_t light = 0; light < grower_.lights().size(); ++light) {
      const ShadowState state = shadow_state(node.lights, light);
      if (state != ShadowState::filtered) {
        grower_.set_link(index, light, state);
        continue;
      }
      filters.next(grower_.filters_);
      grower_.gathers(index, light, segment);
      grower_.set_filters(index, light, segment, grower_.filters_);
    }
    if (!grower_.grow().scene.object(node.object()).optics.spawns() && node.children() == 0) return index;
    const Spawned rays = grower_.spawned(index);
    if (rays.mask != (node.flags & 0xFU))
      throw Error(ExitCode::damaged_cache, "", "", "stored ray trees do not fit the scene; preprocess again");
    grower_.for_each_child(index, rays, [&](Branch, const SpawnedRay& child) { return expand(child, index); });
    return index;
  }

 private:
  Grower grower_;
  StoredTree stored_;
};

class Updater {
 public:
  Updater(const GrowScene& grow, const RayChange& change, std::uint32_t sample, StoredTree stored, TreeBlock& block,
          GrowCounters& counters)
      : grower_(grow, sample, block), change_(change), stored_(stored), counters_(counters) {}

  std::uint32_t update(const SpawnedRay& ray, std::uint32_t parent) {
    const Hit* hits = nullptr;
    const PathNode node = take(stored_, hits);
    if (!node.is_miss() && (change_.flags(node.object()) & RayChange::moved) != 0) {
      // The selection is removed: what lies behind it shows (paper 2.2).
      skip_children(stored_, node);
      changed_ = true;
      return trace(ray, parent);
    }
    const std::uint32_t index = grower_.append(ray, parent);
    if (!node.is_miss()) grower_.set_hit(index, node.object(), *hits);
    if (!change_.moved_after.empty() && test(index, node)) return index;
    if (node.is_miss()) return index;
    update_lights(index, node, hits);
    update_children(index, node);
    return index;
  }
  [[nodiscard]] bool changed() const { return changed_; }

 private:
  std::uint32_t trace(const SpawnedRay& ray, std::uint32_t parent) {
    const std::uint32_t index = grower_.trace(ray, parent, counters_);
    grower_.trace_lights(index, counters_);
    return index;
  }

  /// The ray test: does the selection, where it is now, come before what is stored? If so, regrows the node.
  bool test(std::uint32_t index, const PathNode& node) {
    TreeBlock& block = grower_.block();
    const SpawnedRay ray = block.nodes[index].ray;
    ++counters_.ray_tests;
    Ray segment{ray.origin, ray.direction};
    float slack = 0;
    if (!node.is_miss()) {
      slack = distance_slack(block.nodes[index]);
      segment.t_max = block.nodes[index].length + slack;
    }
    const Meeting meeting = Tracer::intersect(change_.moved_after, segment);
    if (meeting.object.is_none()) return false;
    if (!node.is_miss() && meeting.t > block.nodes[index].length - slack) {
      ++counters_.ray_updates;
      const Meeting nearest = Tracer::intersect(*grower_.grow().level, {ray.origin, ray.direction});
      if (nearest.object == node.object() && nearest.hit == block.nodes[index].hit) return false;
      return regrow(index, node, nearest);
    }
    return regrow(index, node, meeting);
  }

  /// The stored hit's distance is known up to rounding, the more so the flatter the ray meets its triangle. What the
  /// selection has nearer than this band is in front; within it the whole scene decides.
  [[nodiscard]] float distance_slack(const RayNode& node) const {
    constexpr float kUlps = 0x1p-17F;  // 128 units in the last place
    const Point& o = node.ray.origin;
    const float coordinates = std::fabs(o.x) + std::fabs(o.y) + std::fabs(o.z);
    const float cosine = std::fmax(-node.ray.direction.dot(node.point.geometric), 1e-4F);
    const float condition = grower_.grow().scene.object(node.object).condition;
    return (kUlps * (node.length + coordinates) + 8 * node.point.offset) * condition / cosine;
  }

  bool regrow(std::uint32_t index, const PathNode& node, const Meeting& meeting) {
    changed_ = true;
    TreeBlock& block = grower_.block();
    if (!node.is_miss()) block.lights.resize(block.nodes[index].first_light);
    skip_children(stored_, node);
    require(!meeting.object.is_none(), "a tested ray meets at least the selection");
    grower_.trace_from(index, meeting, counters_);
    grower_.trace_lights(index, counters_);
    return true;
  }

  void update_lights(std::uint32_t index, const PathNode& node, const Hit* hits) {
    // Stored filters by old light, since lights may have changed places.
    StoredFilters filters(node, hits + 1);
    stored_filters_.resize(change_.old_lights.size());
    for (std::size_t old = 0; old < change_.old_lights.size(); ++old)
      if (shadow_state(node.lights, old) == ShadowState::filtered) filters.next(stored_filters_[old]);
    for (std::size_t light = 0; light < grower_.lights().size(); ++light) {
      const std::uint32_t old = change_.old_light_index[light];
      const ShadowState before = old == kNoNode ? ShadowState::facing_away : shadow_state(node.lights, old);
      update_light(index, light, before, old == kNoNode ? 0 : old);
    }
    if (change_.lights_changed) note_lost_lights(node);
  }

  /// A light that lit the node and is no more, or has moved, changes its colour even if nothing else does.
  void note_lost_lights(const PathNode& node) {
    std::vector<bool> kept(change_.old_lights.size(), false);
    for (std::uint32_t old : change_.old_light_index)
      if (old != kNoNode) kept[old] = true;
    for (std::size_t old = 0; old < kept.size(); ++old)
      if (!kept[old] && shadow_state(node.lights, old) != ShadowState::facing_away) changed_ = true;
  }

  void update_light(std::uint32_t index, std::size_t light, ShadowState before, std::size_t old) {
    ShadowSegment segment;
    if (!grower_.gathers(index, light, segment)) {
      changed_ = changed_ || before != ShadowState::facing_away;
      return;
    }
    if (before == ShadowState::facing_away) {  // a new or moved light, or a surface that gathered none
      changed_ = true;
      grower_.trace_light(index, light, segment, counters_);
      return;
    }
    const bool was_filtered = before == ShadowState::filtered;
    if (change_.shadows_before.empty() && change_.shadows_after.empty()) {
      keep(index, light, segment, before, was_filtered ? &stored_filters_[old] : nullptr);
      return;
    }
    ++counters_.ray_tests;
    const Ray ray{segment.origin, segment.direction, segment.t_max};
    const bool blocked_now = !Tracer::passes(change_.shadows_after, ray, grower_.crossings_);
    if (before == ShadowState::blocked) {
      if (!blocked_now && !Tracer::passes(change_.shadows_before, ray, crossings_before_)) {
        grower_.trace_light(index, light, segment, counters_);
        changed_ = changed_ || state(index, light) != before;
      } else {
        grower_.set_link(index, light, before);
      }
      return;
    }
    if (blocked_now) {
      changed_ = true;
      grower_.set_link(index, light, ShadowState::blocked);
      return;
    }
    if (!was_filtered) stored_filters_[old].clear();
    update_filters(index, light, segment, before, stored_filters_[old]);
  }

  /// No opaque blockers before or now: takes the selection's filters out and those it has now in.
  void update_filters(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
                      std::vector<FilterNode>& filters) {
    const std::size_t removed = std::erase_if(
        filters, [&](const FilterNode& f) { return (change_.flags(f.object) & RayChange::shadows) != 0; });
    if (removed == 0 && grower_.crossings_.empty()) {
      keep(index, light, segment, before, &filters);
      return;
    }
    changed_ = true;
    if (grower_.crossings_.empty()) {
      grower_.set_filters(index, light, segment, filters);
    } else if (filters.empty()) {
      for (const Crossing& crossing : grower_.crossings_) filters.push_back(filter_of(crossing));
      grower_.set_filters(index, light, segment, filters);
    } else {
      grower_.trace_light(index, light, segment, counters_);  // the order among the others is not known
    }
  }

  void keep(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState state,
            const std::vector<FilterNode>* filters) {
    if (state == ShadowState::filtered)
      grower_.set_filters(index, light, segment, *filters);
    else
      grower_.set_link(index, light, state);
  }
  [[nodiscard]] ShadowState state(std::uint32_t index, std::size_t light) {
    return grower_.block().lights[grower_.block().nodes[index].first_light + light].state;
  }

  void update_children(std::uint32_t index, const PathNode& node) {
    const Spawned now = grower_.spawned(index);
    changed_ = changed_ || now.cut_mask != node.flags >> kCutShift;
    const RayNode parent = grower_.block().nodes[index];
    const bool respawns = (change_.flags(node.object()) & RayChange::respawns) != 0;
    Spawned before;
    if (respawns)
      before = spawn(parent, change_.before[change_.before_index[node.object().index()]], grower_.grow().max_depth);
    for (std::size_t b = 0; b < kBranches; ++b) {
      const bool is_stored = node.has_child(static_cast<Branch>(b)), is_now = (now.mask >> b & 1U) != 0;
      changed_ = changed_ || is_stored != is_now;
      if (!is_now) {
        if (is_stored) skip_tree(stored_);
        continue;
      }
      const SpawnedRay& ray = now.rays[b];
      const bool same_ray = !respawns || ((before.mask >> b & 1U) != 0 && before.rays[b].origin == ray.origin &&
                                          before.rays[b].direction == ray.direction);
      std::uint32_t child = kNoNode;
      if (is_stored && same_ray) {
        child = update(ray, index);
      } else {
        if (is_stored) skip_tree(stored_);
        changed_ = true;
        child = trace(ray, index);
      }
      grower_.block().nodes[index].child[b] = child;
    }
  }

  Grower grower_;
  const RayChange& change_;
  StoredTree stored_;
  GrowCounters& counters_;
  bool changed_ = false;
  std::vector<std::vector<FilterNode>> stored_filters_;  // by old light
  std::vector<Crossing> crossings_before_;
};

}  // namespace

void trace_trees(const GrowScene& grow, std::span<const SpawnedRay> primaries, std::uint32_t first_sample,
                 TreeBlock& block, std::vector<std::uint32_t>& roots, GrowCounters& counters) {
  std::vector<Meeting> meetings;
  meetings.reserve(primaries.size());
  for (const SpawnedRay& ray : primaries)
    meetings.push_back(Tracer::intersect(*grow.level, {ray.origin, ray.direction}));
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
                          TreeBlock& block) {
  return Expander(grow, sample, stored, block).expand(primary, kNoNode);
}

std::uint32_t update_tree(const GrowScene& grow, const RayChange& change, const SpawnedRay& primary,
                          std::uint32_t sample, StoredTree stored, TreeBlock& block, GrowCounters& counters,
                          bool& changed) {
  Updater updater(grow, change, sample, stored, block, counters);
  const std::uint32_t root = updater.update(primary, kNoNode);
  changed = updater.changed();
  return root;
}

}  // namespace relook
