#include "trace/probe.h"

#include "trace/grower.h"

namespace relook {
namespace {

class Prober {
 public:
  Prober(const GrowScene& grow, const RayChange& change, const Touches& touches, StoredTree stored,
         GrowCounters& counters)
      : g_(grow), change_(change), touches_(touches), stored_(stored), counters_(counters) {}

  bool probe(const SpawnedRay& ray, History history) {
    std::span<const Hit> hits;
    const PathNode stored = take(stored_, hits);
    const Touch* touch = touch_of(touches_, history);
    if (touch == nullptr) {
      skip_children(stored_, stored);
      return false;
    }
    RayNode node(kNoNode, 0, ray);
    if (!stored.is_miss()) {
      node.object = stored.object();
      node.hit = hits.front();
      complete(node, g_.scene.object(node.object));
    }
    if (touch->ray && meets(node)) return true;
    if (stored.is_miss()) return false;
    if ((touch->open | touch->blocked) != 0 && lights_change(node, stored, *touch)) return true;
    if (!touch->below) {
      skip_children(stored_, stored);
      return false;
    }
    return probe_children(node, stored, history);
  }

 private:
  [[nodiscard]] bool meets(const RayNode& node) {
    Ray segment{node.ray.origin, node.ray.direction};
    if (!node.object.is_none()) segment.t_max = node.length + distance_slack(node, g_.scene.object(node.object));
    if (!is_near(change_.bounds.moved, segment)) return false;
    ++counters_.ray_tests;
    return !Tracer::intersect(change_.moved_after, segment).object.is_none();
  }

  [[nodiscard]] bool lights_change(const RayNode& node, const PathNode& stored, const Touch& touch) {
    const auto& lights = g_.scene.scene().light_order;
    for (std::size_t light = 0; light < lights.size(); ++light) {
      const ShadowState state = shadow_state(stored.lights, light);
      const bool is_blocked = state == ShadowState::blocked;
      const std::uint32_t may_change = is_blocked ? touch.blocked : touch.open;
      if (state == ShadowState::facing_away || (may_change & light_bit(light)) == 0) continue;
      const ShadowSegment segment = shadow_segment(node.point, g_.scene.scene().light(lights[light]));
      const Ray ray{segment.origin, segment.direction, segment.t_max};
      const bool before = is_blocked && is_near(change_.bounds.shadows_before, ray);
      const bool after = (!is_blocked || g_.shadow_bits > 0) && is_near(change_.bounds.shadows_after, ray);
      if (!before && !after) continue;
      ++counters_.ray_tests;
      if (before && crosses(change_.shadows_before, ray)) return true;
      if (after && crosses(change_.shadows_after, ray)) return true;
    }
    return false;
  }
  [[nodiscard]] bool is_near(const Box& box, const Ray& ray) const {
    return may_meet(box, change_.bounds.condition, ray.origin, ray.direction, ray.t_max);
  }
  [[nodiscard]] bool crosses(const Tracer::TopLevel& selection, const Ray& ray) {
    return !Tracer::passes(selection, ray, crossings_) || !crossings_.empty();
  }

  bool probe_children(const RayNode& node, const PathNode& stored, History history) {
    const Spawned rays = spawn(node, g_.scene.object(node.object), g_.max_depth);
    for (std::size_t b = 0; b < kBranches; ++b) {
      const auto branch = static_cast<Branch>(b);
      if (stored.has_child(branch) && probe(rays.rays[b], child_of(history, branch))) return true;
    }
    return false;
  }

  const GrowScene& g_;
  const RayChange& change_;
  const Touches& touches_;
  StoredTree stored_;
  GrowCounters& counters_;
  std::vector<Crossing> crossings_;
};

}  // namespace

bool probe_tree(const GrowScene& grow, const RayChange& change, const Touches& touches, const SpawnedRay& primary,
                StoredTree stored, GrowCounters& counters) {
  return Prober(grow, change, touches, stored, counters).probe(primary, kPrimary);
}

}  // namespace relook
