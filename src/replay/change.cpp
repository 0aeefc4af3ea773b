#include "replay/change.h"

#include <algorithm>
#include <unordered_map>

#include "edit/effect/effect.h"
#include "trace/box_range.h"

namespace relook {
namespace {

unsigned flags_of(const ObjectEffect& effect) {
  unsigned flags = 0;
  if (effect.moved) flags |= RayChange::moved;
  if (effect.shadows) flags |= RayChange::shadows;
  if (effect.respawns) flags |= RayChange::respawns;
  return flags;
}

/// Collects the flags of objects and their values before the edit.
class ObjectChanges {
 public:
  ObjectChanges(const RayScene& ray_scene, const Scene& scene, StepChange& change)
      : ray_scene_(ray_scene), scene_(scene), change_(change) {}

  void move(const SceneDelta::ObjectChange& object) {
    flag(object.id, effect_of(object.before, scene_.object(object.id)));
  }
  void compare_material(ObjectId id, const Material& after) {
    if (id.index() >= ray_scene_.size() || !scene_.object(id).alive) return;
    const RayObject& before = ray_scene_.object(id);
    if (before.alive) flag(id, effect_of(*before.material, before.optics, after, surface_optics(after, *before.mesh),
                                         *before.mesh, scene_.integrator));
  }

 private:
  void flag(ObjectId id, const ObjectEffect& effect) {
    const unsigned flags = flags_of(effect);
    if (flags == 0) return;
    change_.rays.reserve(scene_.objects.size());
    std::uint8_t& known = change_.rays.objects[id.index()];
    if (known == 0 && id.index() < ray_scene_.size()) {
      change_.rays.before_index[id.index()] = static_cast<std::uint32_t>(change_.rays.before.size());
      change_.rays.before.push_back(ray_scene_.object(id));
    }
    known = static_cast<std::uint8_t>(known | flags);
    change_.any_moved = change_.any_moved || effect.moved;
    change_.any_shadows = change_.any_shadows || effect.shadows;
    change_.any_respawns = change_.any_respawns || effect.respawns;
  }

  const RayScene& ray_scene_;
  const Scene& scene_;
  StepChange& change_;
};

void find_light_changes(const Scene& scene, const SceneDelta& delta, const std::vector<LightId>& old_lights,
                        StepChange& change) {
  std::vector<LightId> moved;
  for (const auto& light : delta.lights) {
    const LightEffect effect = effect_of(light.before, scene.light(light.id));
    if (effect.moved) moved.push_back(light.id);
    if (effect.recolored) change.colors.parameters.lights.push_back(light.id);
  }
  std::ranges::sort(change.colors.parameters.lights);
  change.rays.old_lights = old_lights;
  change.rays.keeps_places = scene.light_order == old_lights;
  change.rays.lights_changed = !change.rays.keeps_places || !moved.empty();
  std::unordered_map<LightId, std::uint32_t> kept;  // by place in the old order
  for (std::uint32_t i = 0; i < old_lights.size(); ++i) kept.emplace(old_lights[i], i);
  for (const LightId light : moved) kept.erase(light);
  for (const LightId light : scene.light_order) {
    const auto old = kept.find(light);
    change.rays.old_light_index.push_back(old != kept.end() ? old->second : kNoNode);
  }
  change.rays.find_lost_lights();
}

}  // namespace

StepChange find_change(const RayScene& ray_scene, const Scene& scene, const SceneDelta& delta,
                       const std::vector<LightId>& old_lights) {
  StepChange change;
  ObjectChanges objects(ray_scene, scene, change);
  for (const auto& material : delta.materials) {
    const Material& after = scene.material(material.id);
    const FieldMask fields = changed_fields(material.before, after);
    if (fields != 0) change.colors.parameters.materials.emplace_back(material.id, fields);
    if (structure_of(material.before) != structure_of(after)) change.colors.restructured.push_back(material.id);
  }
  std::ranges::sort(change.colors.parameters.materials);
  // Objects that have another material now follow below.
  for (const auto& material : delta.materials)
    if (material.id.index() < ray_scene.material_count())
      for (const ObjectId user : ray_scene.users_of(material.id))
        if (scene.object(user).material == material.id) objects.compare_material(user, scene.material(material.id));
  for (const auto& object : delta.objects) {
    objects.move(object);
    if (object.before.material == scene.object(object.id).material) continue;
    objects.compare_material(object.id, scene.material(scene.object(object.id).material));
    change.colors.reassigned.push_back(object.id);
  }
  find_light_changes(scene, delta, old_lights, change);
  change.colors.parameters.ambient = delta.ambient_before.has_value();
  change.colors.parameters.environment = delta.environment_before.has_value();
  change.colors.new_environment =
      delta.environment_before && (delta.environment_before->image == nullptr) != (scene.environment.image == nullptr);
  return change;
}

StepChange no_change(const std::vector<LightId>& lights) {
  StepChange change;
  change.rays.old_lights = lights;
  for (std::uint32_t i = 0; i < lights.size(); ++i) change.rays.old_light_index.push_back(i);
  return change;
}

bool is_compressible(const ColorChange& change) {
  return change.reassigned.empty() && std::ranges::none_of(change.parameters.materials, [](const auto& material) {
           return (material.second & kMappingMask) != 0;
         });
}

std::vector<ObjectId> selection_of(const StepChange& change) {
  std::vector<ObjectId> selection;
  for (std::uint32_t i = 0; i < change.rays.objects.size(); ++i)
    if ((change.rays.objects[i] & (RayChange::moved | RayChange::shadows)) != 0) selection.emplace_back(i);
  return selection;
}

ChangeBoxes boxes_of(const StepChange& change, const RayScene& ray_scene, std::span<const ObjectId> absent) {
  const RayChange& rays = change.rays;
  ChangeBoxes boxes;
  std::vector<Box> moved, before, after;
  for (ObjectId id : selection_of(change)) {
    const RayObject& now = ray_scene.object(id);
    const bool is_moved = (rays.flags(id) & RayChange::moved) != 0,
               shadows = (rays.flags(id) & RayChange::shadows) != 0;
    const bool is_there = now.alive && !std::ranges::binary_search(absent, id);
    if (is_there && is_moved) moved.push_back(world_bounds(now));
    if (is_there && shadows) after.push_back(world_bounds(now));
    boxes.condition = std::max(boxes.condition, now.condition);
    if (!shadows || rays.before_index[id.index()] == kNoNode) continue;
    const RayObject& then = rays.before[rays.before_index[id.index()]];
    if (then.alive) before.push_back(world_bounds(then));
    boxes.condition = std::max(boxes.condition, then.condition);
  }
  boxes.moved = box_set(moved);
  boxes.shadows_before = box_set(before);
  boxes.shadows_after = box_set(after);
  return boxes;
}

void build_selection(StepChange& change, const RayScene& ray_scene, std::span<const ObjectId> absent, Tracer& tracer) {
  RayChange& rays = change.rays;
  std::vector<Tracer::Placed> moved, before, after;
  for (ObjectId id : selection_of(change)) {
    const bool is_there = !std::ranges::binary_search(absent, id);
    if (is_there && (rays.flags(id) & RayChange::moved) != 0) moved.push_back({id, &ray_scene.object(id)});
    if ((rays.flags(id) & RayChange::shadows) == 0) continue;
    if (is_there) after.push_back({id, &ray_scene.object(id)});
    if (rays.before_index[id.index()] != kNoNode) before.push_back({id, &rays.before[rays.before_index[id.index()]]});
  }
  if (!moved.empty()) rays.moved_after = tracer.build(moved);
  if (!before.empty()) rays.shadows_before = tracer.build(before);
  if (!after.empty()) rays.shadows_after = tracer.build(after);
}

}  // namespace relook
