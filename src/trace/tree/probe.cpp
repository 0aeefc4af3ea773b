#include "trace/tree/probe.h"

#include "trace/shadow/shadow_segment.h"
#include "trace/tree/grower.h"
#include "trace/tree/segment_tests.h"
#include "trace/tree/spawn.h"

namespace relook {
namespace {

class Prober {
 public:
  Prober(const GrowScene& grow, const RayChange& change, const Touches& touches, StoredTree stored,
         GrowCounters& counters)
      : g_(grow),
        change_(change),
        touches_(touches),
        stored_(stored),
        counters_(counters),
        tests_(change, grow.shadow_bits, counters) {}

  bool probe(const SpawnedRay& ray, History history) {
    std::span<const Hit> hits;
    const PathNode stored = take(stored_, hits);
    const Touch* touch = touch_of(touches_, history);
    if (touch == nullptr) {
      counters_.culled.tunnels += stored.segments() + skip_children(stored_, stored);
      return false;
    }
    RayNode node(kNoNode, 0, ray);
    if (!stored.is_miss()) {
      node.object = stored.object;
      node.hit = hits.front();
      complete(node, g_.scene.object(node.object));
    }
    if (meets(node, touch->ray)) return true;
    if (stored.is_miss()) return false;
    if ((touch->open | touch->blocked).empty())
      counters_.culled.tunnels += stored.shadow_segments;
    else if (lights_change(node, stored, *touch))
      return true;
    if (!touch->below) {
      counters_.culled.tunnels += skip_children(stored_, stored);
      return false;
    }
    return probe_children(node, stored, history);
  }

 private:
  [[nodiscard]] bool meets(const RayNode& node, bool touched) {
    Ray segment = stored_segment(node.ray);
    if (touched && !node.object.is_none())
      segment.t_max = std::min(node.length + distance_slack(node, g_.scene.object(node.object)), node.ray.end);
    return tests_.tests_ray(touched, segment) && !Tracer::intersect(change_.moved_after, segment).object.is_none();
  }

  [[nodiscard]] bool lights_change(const RayNode& node, const PathNode& stored, const Touch& touch) {
    const std::size_t lights = g_.scene.light_order().size();
    for (std::size_t light = 0; light < lights; ++light) {
      const ShadowState state = shadow_state(stored.lights, light);
      if (state == ShadowState::facing_away) continue;
      const bool touched = touch.touches(state == ShadowState::blocked, light);
      const ShadowSegment segment = shadow_segment(node, g_.scene.light(light));
      const Ray ray = segment.ray();
      const auto tests = tests_.tests_shadow(state, touched, ray);
      if (tests.before && crosses(change_.shadows_before, ray)) return true;
      if (tests.after && crosses(change_.shadows_after, ray)) return true;
    }
    return false;
  }
  [[nodiscard]] bool crosses(const Tracer::TopLevel& selection, const Ray& ray) {
    return !Tracer::passes(selection, ray, crossings_) || !crossings_.empty();
  }

  bool probe_children(const RayNode& node, const PathNode& stored, History history) {
    Spawned rays;
    spawn(node, g_.scene.object(node.object), g_.rule(), rays);
    for (std::size_t b = 0; b < kBranches; ++b) {
      const auto branch = static_cast<Branch>(b);
      if (stored.has_child(branch) && probe(rays.ray(branch), history.child(branch))) return true;
    }
    return false;
  }

  const GrowScene& g_;
  const RayChange& change_;
  const Touches& touches_;
  StoredTree stored_;
  GrowCounters& counters_;
  SegmentTests tests_;
  std::vector<Crossing> crossings_;
};

}  // namespace

bool probe_tree(const GrowScene& grow, const RayChange& change, const Touches& touches, const SpawnedRay& primary,
                StoredTree stored, GrowCounters& counters) {
  return Prober(grow, change, touches, stored, counters).probe(primary, History::primary());
}

}  // namespace relook
