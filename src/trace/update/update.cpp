// Ray trees after a change of the scene (paper 2.2): stored segments are tested against the selection; only what it
// touches is traced against the whole scene.
#include "trace/update/kept_rays.h"
#include "trace/update/shadow_update.h"

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
        tests_(change, grow.shadow_bits, counters),
        shadows_(grower_, change, tests_, counters, what_, stored.kept != nullptr) {}
  Updater(const Updater&) = delete;
  Updater& operator=(const Updater&) = delete;

  /// `coverage`: as kept, or null.
  std::uint32_t update(const SpawnedRay& ray, std::uint32_t parent, History history,
                       const CoverageChoice* coverage = nullptr) {
    std::span<const Hit> hits;
    const PathNode node = take(stored_, hits);
    if (!node.is_miss() && (change_.flags(node.object) & RayChange::moved) != 0) {
      // The selection is removed: what lies behind it shows (paper 2.2).
      counters_.culled.dropped += node.segments() + skip_children(stored_, node);
      note(TreeChange::all);
      return trace(ray, parent);
    }
    const std::uint32_t index = grower_.append(ray, parent);
    if (!node.is_miss()) grower_.set_hit(index, node.object, hits.front(), coverage);
    const Touch touch = may_touch(history);
    if (test(index, node, touch.ray)) return index;
    if (node.is_miss()) return index;
    shadows_.update(index, node, hits, touch);
    if (stored_.kept != nullptr)
      update_kept_children(index, node, history);
    else
      update_children(index, node, history);
    return index;
  }
  [[nodiscard]] TreeChange what() const { return what_; }

 private:
  /// What of a node's segments the selection may meet.
  [[nodiscard]] Touch may_touch(History history) const {
    if (touches_ == nullptr) return {history, true, true, LightSet::all(), LightSet::all()};
    const Touch* touch = touch_of(*touches_, history);
    return touch != nullptr ? *touch : Touch{history};
  }

  void note(TreeChange what) { what_ = std::max(what_, what); }

  std::uint32_t trace(const SpawnedRay& ray, std::uint32_t parent) {
    const std::uint32_t index = grower_.trace(ray, parent, counters_);
    grower_.trace_lights(index, counters_);
    return index;
  }

  /// The ray test: does the selection, where it is now, come before what is stored? If so, regrows the node.
  bool test(std::uint32_t index, const PathNode& node, bool touched) {
    if (change_.only_lights()) return tests_.tests_ray(touched, {});
    TreeBlock& block = grower_.block();
    const SpawnedRay ray = block.nodes[index].ray;
    Ray segment = stored_segment(ray);
    float slack = 0;
    if (touched && !node.is_miss()) {
      slack = distance_slack(block.nodes[index], grower_.grow().scene.object(node.object));
      segment = stored_segment(block.nodes[index], slack);
    }
    if (!tests_.tests_ray(touched, segment)) return false;
    Meeting meeting = Tracer::intersect(change_.moved_after, segment);
    if (meeting.object.is_none()) return false;
    const Ray whole = grower_.whole_ray(ray, counters_);
    if (ray.goes_on()) {  // behind what it comes from?
      segment.behind = whole.behind;
      segment.t_min = ray.start;
      meeting = Tracer::intersect(change_.moved_after, segment);
      if (meeting.object.is_none()) return false;
    }
    if (!node.is_miss() && meeting.t > block.nodes[index].length - slack) {
      ++counters_.ray_updates;
      const Meeting nearest = Tracer::intersect(*grower_.grow().level, whole);
      if (nearest.object == node.object && nearest.hit == block.nodes[index].hit) return false;
      if (!nearest.object.is_none()) return regrow(index, node, nearest);
    }
    return regrow(index, node, meeting);
  }

  /// Requires: something is met.
  bool regrow(std::uint32_t index, const PathNode& node, const Meeting& meeting) {
    note(TreeChange::all);
    if (stored_.kept != nullptr) return true;  // restored rays cannot grow
    TreeBlock& block = grower_.block();
    if (!node.is_miss()) block.resize_lights(block.nodes[index].first_light);
    counters_.culled.dropped += node.shadow_segments + skip_children(stored_, node);
    grower_.trace_from(index, meeting, counters_);
    grower_.trace_lights(index, counters_);
    return true;
  }

  void update_children(std::uint32_t index, const PathNode& node, History history) {
    Spawned now;
    grower_.find_spawned(index, now);
    if (now.cut != node.flags.cut()) note(TreeChange::all);
    const bool respawns = (change_.flags(node.object) & RayChange::respawns) != 0;
    Spawned before;
    if (respawns) {
      const RayObject& then = change_.value_before(node.object);
      RayNode as_before = grower_.block().nodes[index];
      as_before.coverage = coverage_choice(as_before, then);
      spawn(as_before, then, grower_.grow().rule(), before);
    }
    for (std::size_t b = 0; b < kBranches; ++b) {
      const auto branch = static_cast<Branch>(b);
      const bool is_stored = node.has_child(branch), is_now = now.branches().has(branch);
      const bool goes_as_before =
          is_stored && is_now &&
          (!respawns || (before.branches().has(branch) && before.ray(branch).is_same_way(now.ray(branch))));
      if (!goes_as_before && (is_stored || is_now)) note(TreeChange::all);
      if (is_stored && !goes_as_before) counters_.culled.dropped += skip_tree(stored_);
      if (!is_now) continue;
      const SpawnedRay& ray = now.ray(branch);
      const std::uint32_t child = goes_as_before ? update(ray, index, history.child(branch)) : trace(ray, index);
      grower_.block().nodes[index].child[b] = child;
    }
  }

  /// What is left of the tree is not looked at once it is known to change.
  void update_kept_children(std::uint32_t index, const PathNode& node, History history) {
    const RayObject& object = grower_.grow().scene.object(node.object);
    grower_.block().nodes[index].cut = node.flags.cut();
    for (std::size_t b = 0; b < kBranches && what_ != TreeChange::all; ++b) {
      const auto branch = static_cast<Branch>(b);
      if (!node.has_child(branch)) continue;
      const KeptRay& kept = *stored_.kept++;
      const SpawnedRay ray = kept.restored(grower_.block().nodes[index], object, branch);
      const CoverageChoice coverage = kept.coverage();
      const std::uint32_t child = update(ray, index, history.child(branch), &coverage);
      grower_.block().nodes[index].child[b] = child;
    }
  }

  Grower grower_;
  const RayChange& change_;
  const Touches* touches_;  // null: any segment may be touched
  StoredTree stored_;
  GrowCounters& counters_;
  SegmentTests tests_;
  TreeChange what_ = TreeChange::none;
  ShadowUpdater shadows_;
};

}  // namespace

void RayChange::find_lost_lights() {
  std::vector<bool> kept(old_lights.size(), false);
  for (const std::uint32_t old : old_light_index)
    if (old != kNoNode) kept[old] = true;
  lost_lights.clear();
  for (std::uint32_t old = 0; old < kept.size(); ++old)
    if (!kept[old]) lost_lights.push_back(old);
}

std::uint32_t update_tree(const GrowScene& grow, const RayChange& change, const Touches* touches,
                          const SpawnedRay& primary, std::uint32_t sample, StoredTree stored, TreeBlock& block,
                          GrowCounters& counters, TreeChange& what) {
  Updater updater(grow, change, touches, sample, stored, block, counters);
  const std::uint32_t root = updater.update(primary, kNoNode, History::primary());
  what = updater.what();
  return root;
}

}  // namespace relook
