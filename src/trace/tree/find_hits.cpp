#include "trace/tree/find_hits.h"

#include <algorithm>

#include "trace/shadow/shadow_segment.h"
#include "trace/tree/spawn.h"

namespace relook {

HitFinder::HitFinder(const GrowScene& grow, const RayChange& change, GrowCounters& counters)
    : g_(grow),
      change_(change),
      counters_(counters),
      rays_(grow.objects, counters),
      new_light_(change.old_lights.size(), kNoNode) {
  for (std::uint32_t light = 0; light < change.old_light_index.size(); ++light)
    if (change.old_light_index[light] != kNoNode) new_light_[change.old_light_index[light]] = light;
}

void HitFinder::find(const SpawnedRay& primary, const PathCursor& path, std::vector<Hit>& hits) {
  cursor_ = path;
  hits_ = &hits;
  const std::uint64_t found_before = rays_.found();
  find_node(primary, primary);
  if (rays_.found() > found_before) ++counters_.trees_rebuilt;
  counters_.hits_rebuilt += rays_.found() - found_before;
}

/// The ray to a node as it was and as it is: they differ in their Fresnel products alone.
void HitFinder::find_node(const SpawnedRay& before, const SpawnedRay& now) {
  const PathNode stored = cursor_.next();
  if (stored.is_miss()) return;
  if (has_flag(stored.object, RayChange::moved)) {
    append_empty(stored);
    skip_trees(stored.children());
    return;
  }
  RayNode node(kNoNode, 0, before);
  node.object = stored.object;
  const Meeting meeting = rays_.meeting(node.object, ray_of(before));  // what it goes on behind was found before
  node.hit = meeting.hit;
  node.t = meeting.t;
  complete(node, g_.scene.object(node.object));
  hits_->push_back(node.hit);
  find_filters(node, stored);
  find_children(node, stored, now);
}

void HitFinder::find_filters(const RayNode& node, const PathNode& stored) {
  EntryReader entries(stored.entries, g_.shadow_bits);
  const auto is_steady = [&](std::uint32_t object) { return !has_flag(ObjectId(object), RayChange::shadows); };
  for (std::size_t old = 0; old < new_light_.size(); ++old) {
    const ShadowState state = shadow_state(stored.lights, old);
    const LightEntry entry = entries.next(state);
    if (state != ShadowState::filtered) continue;
    const std::size_t first = hits_->size();
    hits_->resize(first + entry.objects.size());
    if (new_light_[old] == kNoNode) continue;
    steady_.clear();
    std::ranges::copy_if(entry.objects, std::back_inserter(steady_), is_steady);
    if (steady_.empty()) continue;
    const RayLight& light = g_.scene.light(new_light_[old]);
    auto crossing = rays_.filters(steady_, shadow_segment(node, light)).begin();
    for (std::size_t i = 0; i < entry.objects.size(); ++i)
      if (is_steady(entry.objects[i])) (*hits_)[first + i] = (crossing++)->hit;
  }
}

void HitFinder::find_children(const RayNode& node, const PathNode& stored, const SpawnedRay& now) {
  const RayObject& object = g_.scene.object(node.object);
  const bool respawns = has_flag(node.object, RayChange::respawns);
  const RayObject& then = respawns ? change_.value_before(node.object) : object;
  if (!g_.rule().may_spawn(then) && stored.children() == 0) return;
  Spawned old, changed;
  spawn(node, then, g_.rule(), old);
  if (old.branches() != stored.branches()) refuse_trees();
  const bool may_differ = respawns || now.fresnel_product != node.ray.fresnel_product;
  if (may_differ) {
    RayNode as_now = node;
    as_now.ray = now;
    spawn(as_now, object, g_.rule(), changed);
  }
  const Spawned& rays = may_differ ? changed : old;
  for (std::size_t b = 0; b < kBranches; ++b) {
    const auto branch = static_cast<Branch>(b);
    if (!stored.has_child(branch)) continue;
    const bool goes_as_before = rays.branches().has(branch) && rays.ray(branch).is_same_way(old.ray(branch));
    if (goes_as_before)
      find_node(old.ray(branch), rays.ray(branch));
    else
      skip_trees(1);
  }
}

void HitFinder::append_empty(const PathNode& stored) {
  if (!stored.is_miss()) hits_->resize(hits_->size() + 1 + stored.filter_hits);
}

void HitFinder::skip_trees(unsigned count) {
  for (unsigned owed = count; owed > 0; --owed) {
    const PathNode stored = cursor_.next();
    append_empty(stored);
    owed += stored.children();
  }
}

}  // namespace relook
