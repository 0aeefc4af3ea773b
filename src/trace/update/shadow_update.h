// The light that reaches a stored node after a change: each shadow segment kept, tested against the selection or traced
// again; inside src/trace.
#pragma once
#include <algorithm>
#include <iterator>
#include <vector>

#include "trace/box_range.h"
#include "trace/object_rays.h"
#include "trace/shadow/shadow_line.h"
#include "trace/tree/grower.h"
#include "trace/tree/segment_tests.h"

namespace relook {

class ShadowUpdater {
 public:
  /// All outlive it. `what`: is told what becomes another. `keeps_states`: nodes are where they were, and face the lights
  /// that stay as they did.
  ShadowUpdater(Grower& grower, const RayChange& change, SegmentTests& tests, GrowCounters& counters, TreeChange& what,
                bool keeps_states)
      : grower_(grower),
        change_(change),
        tests_(tests),
        counters_(counters),
        what_(what),
        keeps_states_(keeps_states),
        line_(grower.grow().shadow_bits),
        object_rays_(grower.grow().objects, counters) {}

  /// `hits`: of the node and its filters, as stored.
  void update(std::uint32_t index, const PathNode& node, std::span<const Hit> hits, const Touch& touch) {
    has_entries_ = !node.entries.empty();
    if (has_entries_) read_entries(node, hits);
    if (keeps_states_) find_place(grower_.block().nodes[index].point);
    for (std::size_t light = 0; light < grower_.lights().size(); ++light) {
      const std::uint32_t old = change_.old_light_index[light];
      const ShadowState before = old == kNoNode ? ShadowState::facing_away : shadow_state(node.lights, old);
      const bool touched = touch.touches(before == ShadowState::blocked, light);
      if (!only_lights_ || has_entries_ || old == kNoNode)
        update_light({index, light, {}, before, old == kNoNode ? 0 : old, old == kNoNode}, touched);
      else
        keep_state(index, light, before, touched);
    }
    note_lost_lights(node);
  }

 private:
  void note(TreeChange what) { what_ = std::max(what_, what); }

  /// What is stored by old light, since lights may have changed places.
  void read_entries(const PathNode& node, std::span<const Hit> hits) {
    EntryReader entries(node.entries, grower_.grow().shadow_bits);
    FilterReader filters(hits.subspan(1));
    stored_filters_.resize(change_.old_lights.size());
    stored_entries_.resize(change_.old_lights.size());
    for (std::size_t old = 0; old < change_.old_lights.size(); ++old) {
      const ShadowState state = shadow_state(node.lights, old);
      stored_entries_[old] = entries.next(state);
      if (state == ShadowState::filtered) filters.next(stored_entries_[old].objects, stored_filters_[old]);
    }
  }

  /// Of an old light.
  [[nodiscard]] const LightEntry& entry_of(std::size_t old) const { return has_entries_ ? stored_entries_[old] : kNoEntry; }
  [[nodiscard]] std::vector<FilterNode>& filters_of(std::size_t old) {
    return has_entries_ ? stored_filters_[old] : no_filters_;
  }

  /// Where the node's segments set out.
  void find_place(const SurfacePoint& point) {
    const Direction margin = Direction(1, 1, 1) * (2 * point.offset);
    place_ = Box(point.position - margin, point.position + margin);
    place_.extendBy(point.position + point.lift);
  }
  /// Is a light so placed that no segment from the node to it comes near the selection? Told without a sample of it.
  [[nodiscard]] bool is_away(std::size_t light, ShadowState state) const {
    if (light >= change_.light_boxes.size() || change_.light_boxes[light].isEmpty()) return false;
    Box hull = place_;
    hull.extendBy(change_.light_boxes[light]);
    const SelectionBounds& bounds = change_.bounds;
    const Direction slack = (hull.max - hull.min) * (0x1p-12F * bounds.condition);
    hull = Box(hull.min - slack, hull.max + slack);
    return state == ShadowState::blocked ? !hull.intersects(bounds.shadows_before)
                                         : !hull.intersects(bounds.shadows_after);
  }

  /// Of a light that stays where it is while only other lights change.
  void keep_state(std::uint32_t index, std::size_t light, ShadowState state, bool touched) {
    if (state == ShadowState::facing_away) return;
    tests_.tests_shadow(state, touched, {});
    grower_.set_link(index, light, state);
  }

  /// A light that lit the node and is no more, or has moved, changes its colour even if nothing else does.
  void note_lost_lights(const PathNode& node) {
    for (const std::uint32_t old : change_.lost_lights) {
      if (shadow_state(node.lights, old) == ShadowState::facing_away) continue;
      note(TreeChange::lights);
      ++counters_.culled.dropped;
    }
  }

  /// A light of a node that is being updated.
  struct LightUpdate {
    std::uint32_t index;    // of the node
    std::size_t light;      // place in the light order
    ShadowSegment segment;  // to it
    ShadowState before;     // as stored
    std::size_t old;        // place in the stored light order
    bool is_new;            // it has none
  };

  /// `touched`: may the selection cross the segment, or did it so before?
  void update_light(LightUpdate l, bool touched) {
    if (only_lights_ && !l.is_new) {  // its segment is worked out if surfaces on it are to be completed
      if (l.before == ShadowState::facing_away) return;
      tests_.tests_shadow(l.before, touched, {});
      if (l.before == ShadowState::filtered) grower_.gathers(l.index, l.light, l.segment);
      return keep(l);
    }
    if (keeps_states_ && !l.is_new && grower_.grow().shadow_bits == 0 && !grower_.block().keeps_lines) {
      if (l.before == ShadowState::facing_away) return;
      if (l.before != ShadowState::filtered && touched && is_away(l.light, l.before)) {
        ++counters_.culled.boxes;
        return keep(l);
      }
    }
    if (!grower_.gathers(l.index, l.light, l.segment)) {
      if (l.before == ShadowState::facing_away) return;
      note(TreeChange::all);
      ++counters_.culled.dropped;
      return;
    }
    if (l.before == ShadowState::facing_away) {  // a new or moved light, or a surface that gathered none
      note(l.is_new ? TreeChange::lights : TreeChange::all);
      grower_.trace_light(l.index, l.light, l.segment, counters_);
      return;
    }
    const Ray ray = l.segment.ray();
    const auto tests = tests_.tests_shadow(l.before, touched, ray);
    if (!tests.any())  // transparent surfaces of the selection may have stood there: the path names them
      l.before == ShadowState::filtered ? update_filters(l, {}) : keep(l);
    else if (grower_.grow().shadow_bits > 0)
      update_counted(l, ray, tests);
    else
      update_flagged(l, ray);
  }

  /// Blocked or not, b = 0: an unblocked segment ends at the first opaque object of the selection.
  void update_flagged(const LightUpdate& l, const Ray& ray) {
    const bool blocked_now = !Tracer::passes(change_.shadows_after, ray, grower_.crossings_);
    if (l.before == ShadowState::blocked) {
      if (!blocked_now && !Tracer::passes(change_.shadows_before, ray, crossings_before_))
        recount(l);
      else
        grower_.set_link(l.index, l.light, l.before);
      return;
    }
    if (blocked_now) {
      note(TreeChange::all);
      grower_.set_link(l.index, l.light, ShadowState::blocked);
      return;
    }
    update_filters(l, grower_.crossings_);
  }

  /// What of the selection a segment crosses. `passes_light`: of an object, as it was when the crossings were found.
  template <class PassesLight>
  void find_crossings(const Tracer::TopLevel& selection, const Ray& ray, const PassesLight& passes_light,
                      SelectionCrossings& found) {
    Tracer::blockers(selection, ray, grower_.crossings_);
    for (const Crossing& crossing : grower_.crossings_)
      (passes_light(crossing.object) ? found.transparent : found.opaque).push_back(crossing);
  }

  /// Shadow counters (paper 4.2): how many blockers there are follows from what of the selection stood there and what
  /// stands there now.
  void update_counted(const LightUpdate& l, const Ray& ray, const SegmentTests::Shadow& tests) {
    then_.clear();
    now_.clear();
    if (tests.after)
      find_crossings(
          change_.shadows_after, ray, [&](ObjectId id) { return grower_.grow().scene.object(id).optics.passes_light; },
          now_);
    if (l.before != ShadowState::blocked && now_.opaque.empty()) {
      update_filters(l, now_.transparent);
      return;
    }
    const auto passed_light = [&](ObjectId id) {
      return change_.value_before(id).optics.passes_light;
    };
    if (tests.before) find_crossings(change_.shadows_before, ray, passed_light, then_);
    if (then_.empty() && now_.empty())
      keep(l);
    else if (!has_new_line(l))
      recount(l);
    else
      set_line(l);
  }

  /// What stands on the segment now, in line_; false if only a ray can tell.
  bool has_new_line(const LightUpdate& l) {
    const LightEntry& stored = entry_of(l.old);
    find_steady(l);
    const std::span<const Crossing> steady = has_ranges(l) ? std::span<const Crossing>(ranged_) : steady_surfaces(l);
    if (steady.size() != steady_.size()) return false;
    if (!line_.start(steady, then_.transparent, stored.counters)) return false;
    const auto object_of = [](const Crossing& crossing) { return crossing.object.index(); };
    if (l.before == ShadowState::blocked && !std::ranges::equal(line_.surfaces(), stored.objects, {}, object_of))
      return false;
    return line_.exchange(then_, now_);
  }

  /// The transparent surfaces of a stored segment that are as they were, as objects.
  void find_steady(const LightUpdate& l) {
    steady_.clear();
    std::ranges::copy_if(entry_of(l.old).objects, std::back_inserter(steady_), [&](std::uint32_t object) {
      return (change_.flags(ObjectId(object)) & RayChange::shadows) == 0;
    });
  }

  /// Found again where they stand: their hits are not kept behind blockers. None where the levels of single objects are
  /// not at hand.
  std::span<const Crossing> steady_surfaces(const LightUpdate& l) {
    if (steady_.empty() || grower_.grow().objects == nullptr) return {};
    return object_rays_.filters(steady_, l.segment);
  }

  /// Without a ray: if the selection crosses the segment nowhere near their objects, any place there tells what is
  /// before and what behind them. Such places are in ranged_, with no hits.
  bool has_ranges(const LightUpdate& l) {
    ranged_.clear();
    float last = 0;
    for (const std::uint32_t id : steady_) {
      const RayObject& object = grower_.grow().scene.object(ObjectId(id));
      const auto range =
          range_in(world_bounds(object), object.condition, l.segment.origin, l.segment.direction, l.segment.t_max);
      if (!range || is_selection_within(*range)) return false;
      last = std::max(last, static_cast<float>(range->enter));  // in their order
      ranged_.push_back({ObjectId(id), {}, last, object.key});
    }
    return true;
  }
  [[nodiscard]] bool is_selection_within(const SegmentRange& range) const {
    // Twice the rounding to float is left on both sides.
    const double enter = range.enter * (1 - 0x1p-22), leave = range.leave * (1 + 0x1p-22);
    const auto is_within = [&](const Crossing& crossing) {
      return static_cast<double>(crossing.t) >= enter && static_cast<double>(crossing.t) <= leave;
    };
    return std::ranges::any_of(then_.opaque, is_within) || std::ranges::any_of(then_.transparent, is_within) ||
           std::ranges::any_of(now_.opaque, is_within) || std::ranges::any_of(now_.transparent, is_within);
  }

  void set_line(const LightUpdate& l) {
    if (!line_.is_blocked()) {
      note(TreeChange::all);
      if (steady_.empty() || grower_.grow().objects != nullptr)
        set_surfaces(l, steady_surfaces(l), now_.transparent);
      else
        grower_.trace_light(l.index, l.light, l.segment, counters_);
      return;
    }
    const std::span<const std::uint32_t> entry = line_.entry();
    if (l.before != ShadowState::blocked)
      note(TreeChange::all);
    else if (!std::ranges::equal(entry, entry_of(l.old).words))
      note(TreeChange::counters);
    grower_.set_blocked(l.index, l.light, entry);
  }

  void recount(const LightUpdate& l) {
    grower_.trace_light(l.index, l.light, l.segment, counters_);
    const TreeBlock& block = grower_.block();
    const LightLink& link = block.lights[block.nodes[l.index].first_light + l.light];
    if (link.state != l.before || l.before == ShadowState::filtered)
      note(TreeChange::all);
    else if (has_entry(l.before, grower_.grow().shadow_bits) &&
             !std::ranges::equal(block.blocker_entry(link), entry_of(l.old).words))
      note(TreeChange::counters);
  }

  /// No opaque blockers before or now: takes the selection's filters out and puts those it has now in.
  void update_filters(const LightUpdate& l, std::span<const Crossing> now) {
    std::vector<FilterNode>& filters = filters_of(l.old);
    if (l.before != ShadowState::filtered) filters.clear();
    const std::size_t removed = std::erase_if(
        filters, [&](const FilterNode& f) { return (change_.flags(f.object) & RayChange::shadows) != 0; });
    if (removed == 0 && now.empty()) {
      keep(l);
      return;
    }
    note(TreeChange::all);
    if (now.empty()) {
      grower_.set_filters(l.index, l.light, l.segment, filters);
      return;
    }
    steady_.clear();
    for (const FilterNode& filter : filters) steady_.push_back(filter.object.index());
    const std::span<const Crossing> steady = steady_surfaces(l);
    if (steady.size() == filters.size())
      set_surfaces(l, steady, now);
    else
      grower_.trace_light(l.index, l.light, l.segment, counters_);  // the order is not known
  }

  void set_surfaces(const LightUpdate& l, std::span<const Crossing> steady, std::span<const Crossing> now) {
    merged_.clear();
    std::ranges::merge(steady, now, std::back_inserter(merged_), {}, place_on_segment, place_on_segment);
    grower_.set_crossings(l.index, l.light, l.segment, merged_);
  }

  void keep(const LightUpdate& l) {
    if (!has_entry(l.before, grower_.grow().shadow_bits))
      grower_.set_link(l.index, l.light, l.before);
    else if (l.before == ShadowState::blocked)
      grower_.set_blocked(l.index, l.light, entry_of(l.old).words);
    else
      grower_.set_filters(l.index, l.light, l.segment, filters_of(l.old));
  }

  Grower& grower_;
  const RayChange& change_;
  SegmentTests& tests_;
  GrowCounters& counters_;
  TreeChange& what_;
  bool only_lights_ = change_.only_lights();
  bool keeps_states_;  // no node's own doing changes
  bool has_entries_ = false;
  Box place_;
  static inline const LightEntry kNoEntry{};
  std::vector<FilterNode> no_filters_;
  std::vector<std::vector<FilterNode>> stored_filters_;  // by old light
  std::vector<LightEntry> stored_entries_;               // by old light
  std::vector<Crossing> crossings_before_, merged_, ranged_;
  SelectionCrossings then_, now_;  // of the segment at hand
  ShadowLine line_;
  ObjectRays object_rays_;
  std::vector<std::uint32_t> steady_;  // objects of its transparent surfaces beside the selection's
};

}  // namespace relook
