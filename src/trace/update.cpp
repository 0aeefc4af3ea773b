// Ray trees after a change of the scene (paper 2.2): stored segments are tested against the selection; only what it
// touches is traced against the whole scene.
#include <array>
#include <optional>

#include "trace/grower.h"
#include "trace/segment_tests.h"

namespace relook {
namespace {

class Updater {
 public:
  Updater(const GrowScene& grow, const RayChange& change, const Touches* touches, std::uint32_t sample,
          StoredTree stored, TreeBlock& block, GrowCounters& counters)
      : grower_(grow, sample, block),
        change_(change),
        touches_(touches),
        stored_(stored),
        counters_(counters),
        tests_(change, grow.shadow_bits, counters) {}

  std::uint32_t update(const SpawnedRay& ray, std::uint32_t parent, History history) {
    std::span<const Hit> hits;
    const PathNode node = take(stored_, hits);
    if (!node.is_miss() && (change_.flags(node.object()) & RayChange::moved) != 0) {
      // The selection is removed: what lies behind it shows (paper 2.2).
      counters_.culled.dropped += node.segments() + skip_children(stored_, node);
      changed_ = true;
      return trace(ray, parent);
    }
    const std::uint32_t index = grower_.append(ray, parent);
    if (!node.is_miss()) grower_.set_hit(index, node.object(), hits.front());
    const Touch touch = may_touch(history);
    if (test(index, node, touch.ray)) return index;
    if (node.is_miss()) return index;
    update_lights(index, node, hits, touch);
    update_children(index, node, history);
    return index;
  }
  [[nodiscard]] bool changed() const { return changed_; }

 private:
  /// What of a node's segments the selection may meet.
  [[nodiscard]] Touch may_touch(History history) const {
    constexpr std::uint32_t kAllLights = 0xFFFFFFFFU;
    if (touches_ == nullptr) return {history, true, true, kAllLights, kAllLights};
    const Touch* touch = touch_of(*touches_, history);
    return touch != nullptr ? *touch : Touch{history, false, false, 0, 0};
  }

  std::uint32_t trace(const SpawnedRay& ray, std::uint32_t parent) {
    const std::uint32_t index = grower_.trace(ray, parent, counters_);
    grower_.trace_lights(index, counters_);
    return index;
  }

  /// The ray test: does the selection, where it is now, come before what is stored? If so, regrows the node.
  bool test(std::uint32_t index, const PathNode& node, bool touched) {
    TreeBlock& block = grower_.block();
    const SpawnedRay ray = block.nodes[index].ray;
    Ray segment{ray.origin, ray.direction};
    float slack = 0;
    if (touched && !node.is_miss()) {
      slack = distance_slack(block.nodes[index], grower_.grow().scene.object(node.object()));
      segment.t_max = block.nodes[index].length + slack;
    }
    if (!tests_.tests_ray(touched, segment)) return false;
    const Meeting meeting = Tracer::intersect(change_.moved_after, segment);
    if (meeting.object.is_none()) return false;
    if (!node.is_miss() && meeting.t > block.nodes[index].length - slack) {
      ++counters_.ray_updates;
      const Meeting nearest = Tracer::intersect(*grower_.grow().level, {ray.origin, ray.direction});
      if (nearest.object == node.object() && nearest.hit == block.nodes[index].hit) return false;
      if (!nearest.object.is_none()) return regrow(index, node, nearest);
    }
    return regrow(index, node, meeting);
  }

  /// Requires: something is met.
  bool regrow(std::uint32_t index, const PathNode& node, const Meeting& meeting) {
    changed_ = true;
    TreeBlock& block = grower_.block();
    if (!node.is_miss()) block.lights.resize(block.nodes[index].first_light);
    counters_.culled.dropped += node.shadow_segments + skip_children(stored_, node);
    grower_.trace_from(index, meeting, counters_);
    grower_.trace_lights(index, counters_);
    return true;
  }

  void update_lights(std::uint32_t index, const PathNode& node, std::span<const Hit> hits, const Touch& touch) {
    // What is stored by old light, since lights may have changed places.
    EntryReader entries(node.entries, grower_.grow().shadow_bits);
    FilterReader filters(hits.subspan(1));
    stored_filters_.resize(change_.old_lights.size());
    stored_entries_.resize(change_.old_lights.size());
    for (std::size_t old = 0; old < change_.old_lights.size(); ++old) {
      const ShadowState state = shadow_state(node.lights, old);
      stored_entries_[old] = entries.next(state);
      if (state == ShadowState::filtered) filters.next(stored_entries_[old].objects, stored_filters_[old]);
    }
    for (std::size_t light = 0; light < grower_.lights().size(); ++light) {
      const std::uint32_t old = change_.old_light_index[light];
      const ShadowState before = old == kNoNode ? ShadowState::facing_away : shadow_state(node.lights, old);
      update_light(index, light, before, old == kNoNode ? 0 : old,
                   touch.touches(before == ShadowState::blocked, light));
    }
    if (change_.lights_changed) note_lost_lights(node);
  }

  /// A light that lit the node and is no more, or has moved, changes its colour even if nothing else does.
  void note_lost_lights(const PathNode& node) {
    std::vector<bool> kept(change_.old_lights.size(), false);
    for (std::uint32_t old : change_.old_light_index)
      if (old != kNoNode) kept[old] = true;
    for (std::size_t old = 0; old < kept.size(); ++old)
      if (!kept[old] && shadow_state(node.lights, old) != ShadowState::facing_away) {
        changed_ = true;
        ++counters_.culled.dropped;
      }
  }

  /// `touched`: may the selection cross the segment, or did it so before?
  void update_light(std::uint32_t index, std::size_t light, ShadowState before, std::size_t old, bool touched) {
    ShadowSegment segment;
    if (!grower_.gathers(index, light, segment)) {
      if (before == ShadowState::facing_away) return;
      changed_ = true;
      ++counters_.culled.dropped;
      return;
    }
    if (before == ShadowState::facing_away) {  // a new or moved light, or a surface that gathered none
      changed_ = true;
      grower_.trace_light(index, light, segment, counters_);
      return;
    }
    const Ray ray{segment.origin, segment.direction, segment.t_max};
    if (!tests_.tests_shadow(before, touched, ray).any()) {  // transparent surfaces of the selection may have stood there: the path names them
      grower_.crossings_.clear();
      before == ShadowState::filtered ? update_filters(index, light, segment, before, old)
                                      : keep(index, light, segment, before, old);
      return;
    }
    if (grower_.grow().shadow_bits > 0)
      update_counted(index, light, segment, before, old);
    else
      update_flagged(index, light, segment, before, old);
  }

  /// Blocked or not, b = 0: an unblocked segment ends at the first opaque object of the selection.
  void update_flagged(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
                      std::size_t old) {
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
    update_filters(index, light, segment, before, old);
  }

  /// What of the selection a segment crosses.
  struct Blockers {
    std::uint32_t opaque = 0;  // distinct objects
    bool transparent = false;
  };
  /// `passes_light`: of an object, as it was when the crossings were found.
  template <class PassesLight>
  Blockers blockers_of(const std::vector<Crossing>& crossings, const PassesLight& passes_light) {
    Blockers blockers;
    distinct_.clear();
    for (const Crossing& crossing : crossings) {
      if (passes_light(crossing.object)) {
        blockers.transparent = true;
      } else if (std::ranges::find(distinct_, crossing.object) == distinct_.end()) {
        distinct_.push_back(crossing.object);
        ++blockers.opaque;
      }
    }
    return blockers;
  }

  /// Shadow counters (paper 4.2): where only opaque objects are involved, their number follows from those of the
  /// selection that stood there and that stand there now.
  void update_counted(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
                      std::size_t old) {
    const Ray ray{segment.origin, segment.direction, segment.t_max};
    Tracer::blockers(change_.shadows_after, ray, grower_.crossings_);
    const Blockers now = blockers_of(grower_.crossings_,
                                     [&](ObjectId id) { return grower_.grow().scene.object(id).optics.passes_light; });
    if (before != ShadowState::blocked && now.opaque == 0) {
      update_filters(index, light, segment, before, old);
      return;
    }
    crossings_before_.clear();
    if (before == ShadowState::blocked) Tracer::blockers(change_.shadows_before, ray, crossings_before_);
    if (grower_.crossings_.empty() && crossings_before_.empty()) {
      keep(index, light, segment, before, old);
      return;
    }
    const Blockers then = blockers_of(crossings_before_, [&](ObjectId id) {
      return change_.before[change_.before_index[id.index()]].optics.passes_light;
    });
    if (then.transparent || now.transparent || before == ShadowState::filtered || !stored_entries_[old].objects.empty())
      recount(index, light, segment, before, old);
    else
      update_counter(index, light, segment, before, old, then.opaque, now.opaque);
  }

  /// No transparent surface stands or stood on the segment: one counter says it all.
  void update_counter(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
                      std::size_t old, std::uint32_t removed, std::uint32_t added) {
    const std::uint32_t bits = grower_.grow().shadow_bits;
    const ShadowCounter stored = before == ShadowState::blocked
                                     ? ShadowCounter::from_word(stored_entries_[old].counters[0], bits)
                                     : ShadowCounter::of(0, bits);
    const std::optional<ShadowCounter> counter =
        added >= removed ? stored.added(added - removed) : stored.removed(removed - added);
    if (!counter) {
      recount(index, light, segment, before, old);
      return;
    }
    changed_ = changed_ || *counter != stored;
    if (counter->is_blocked())
      grower_.set_blocked(index, light, std::array<std::uint32_t, 2>{0, counter->word()});
    else
      grower_.set_link(index, light, ShadowState::open);
  }

  void recount(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
               std::size_t old) {
    grower_.trace_light(index, light, segment, counters_);
    const TreeBlock& block = grower_.block();
    const LightLink& link = block.lights[block.nodes[index].first_light + light];
    changed_ =
        changed_ || link.state != before || before == ShadowState::filtered ||
        (before == ShadowState::blocked && !std::ranges::equal(block.blocker_entry(link), stored_entries_[old].words));
  }

  /// No opaque blockers before or now: takes the selection's filters out and those it has now in.
  void update_filters(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState before,
                      std::size_t old) {
    std::vector<FilterNode>& filters = stored_filters_[old];
    if (before != ShadowState::filtered) filters.clear();
    const std::size_t removed = std::erase_if(
        filters, [&](const FilterNode& f) { return (change_.flags(f.object) & RayChange::shadows) != 0; });
    if (removed == 0 && grower_.crossings_.empty()) {
      keep(index, light, segment, before, old);
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

  void keep(std::uint32_t index, std::size_t light, const ShadowSegment& segment, ShadowState state, std::size_t old) {
    if (!has_entry(state, grower_.grow().shadow_bits))
      grower_.set_link(index, light, state);
    else if (state == ShadowState::blocked)
      grower_.set_blocked(index, light, stored_entries_[old].words);
    else
      grower_.set_filters(index, light, segment, stored_filters_[old]);
  }
  [[nodiscard]] ShadowState state(std::uint32_t index, std::size_t light) {
    return grower_.block().lights[grower_.block().nodes[index].first_light + light].state;
  }

  void update_children(std::uint32_t index, const PathNode& node, History history) {
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
        if (is_stored) counters_.culled.dropped += skip_tree(stored_);
        continue;
      }
      const SpawnedRay& ray = now.rays[b];
      const bool same_ray = !respawns || ((before.mask >> b & 1U) != 0 && before.rays[b].origin == ray.origin &&
                                          before.rays[b].direction == ray.direction);
      std::uint32_t child = kNoNode;
      if (is_stored && same_ray) {
        child = update(ray, index, child_of(history, static_cast<Branch>(b)));
      } else {
        if (is_stored) counters_.culled.dropped += skip_tree(stored_);
        changed_ = true;
        child = trace(ray, index);
      }
      grower_.block().nodes[index].child[b] = child;
    }
  }

  Grower grower_;
  const RayChange& change_;
  const Touches* touches_;  // null: any segment may be touched
  StoredTree stored_;
  GrowCounters& counters_;
  SegmentTests tests_;
  bool changed_ = false;
  std::vector<std::vector<FilterNode>> stored_filters_;  // by old light
  std::vector<LightEntry> stored_entries_;               // by old light
  std::vector<Crossing> crossings_before_;
  std::vector<ObjectId> distinct_;  // opaque objects met so far
};

}  // namespace

std::uint32_t update_tree(const GrowScene& grow, const RayChange& change, const Touches* touches,
                          const SpawnedRay& primary, std::uint32_t sample, StoredTree stored, TreeBlock& block,
                          GrowCounters& counters, bool& changed) {
  Updater updater(grow, change, touches, sample, stored, block, counters);
  const std::uint32_t root = updater.update(primary, kNoNode, kPrimary);
  changed = updater.changed();
  return root;
}

}  // namespace relook
