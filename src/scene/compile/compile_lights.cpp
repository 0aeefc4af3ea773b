// The lights of a compilation: those that nodes place and, under Integrator::path, the suns of the environment and the
// emission of each material, which live as lights so that an edit of them is an edit of a light.
#include <algorithm>

#include "scene/compile/compile_scene.h"
#include "scene/compile/place_light.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

Light none_of(LightKind kind) {
  Light none;
  none.kind = kind;
  none.alive = false;
  return none;
}

const Json* excludes_of(const Json& node) { return member_at(node, {"extras", "relook", "excludes"}); }

bool emits(const Material& material) {
  const Color light = material.emissive * material.emissive_strength;
  return material.model != IlluminationModel::unlit && (light.x > 0 || light.y > 0 || light.z > 0);
}

/// The light that a material is.
Light emission_of(const Material& material, MaterialId id) {
  Light light;
  light.kind = LightKind::emission;
  light.light = material.name;
  light.material = id;
  light.alive = emits(material);
  light.color = material.emissive;
  light.intensity = material.emissive_strength;
  light.emission = material.slot(Slot::emissive);
  return light;
}

/// The light that an environment's suns are. Without an image there are none, whatever its rotation.
Light suns_of(const Environment& environment) {
  Light light;
  light.kind = LightKind::suns;
  light.color = environment.color;
  light.intensity = environment.intensity;
  light.image = environment.image;
  if (light.image != nullptr) light.rotation = environment.rotation;
  return light;
}

}  // namespace

void SceneIndex::forget(const Light& light) {
  if (light.kind == LightKind::suns)
    suns = LightId::none();
  else if (light.kind == LightKind::emission)
    emission.erase(light.material);
  else
    lights.erase(light.node);
}

/// Another slot. `none`: what it holds before it is set.
LightId Compilation::new_light(Light none) {
  scene_.lights.push_back(std::move(none));
  ++new_lights_;
  return LightId(static_cast<std::uint32_t>(scene_.lights.size() - 1));
}

void Compilation::set_light(LightId id, Light value) {
  Light& now = scene_.lights[id.index()];
  if (now == value) return;
  old_lights_.try_emplace(id, now);
  now = std::move(value);
}

void Compilation::end_light(LightId id) {
  Light gone = scene_.light(id);
  gone.alive = false;
  set_excluding(gone.node, false);
  set_light(id, std::move(gone));
}

void Compilation::update_light(const std::string& name, const Json& node, NodeRecord& record) {
  const Json* given = light_name_of(node);
  if (given == nullptr) {
    if (record.light.is_none()) return;
    end_light(record.light);
    record.light = LightId::none();
    return;
  }
  const auto& light_name = given->get_ref<const std::string&>();
  Light light = compile_light(context_.file, light_name, document_.look["lights"][light_name],
                              "/lights/" + escape_token(light_name), scene_.integrator);
  light.node = name;
  require_range(record.world, name);
  const bool has_place = place_light(record.world, scene_.camera.eye, light);
  const bool is_path = scene_.integrator == Integrator::path;
  light.alive = record.visible && has_place && (is_path || !traits_of(light.kind).path_only);
  const auto [slot, is_new] = index_.lights.try_emplace(name);
  if (is_new) {
    Light none = none_of(LightKind::point);
    none.node = name;
    slot->second = new_light(std::move(none));
  }
  record.light = slot->second;
  if (is_path) {
    const Json* visible = member_at(node, {"extras", "relook", "visible"});
    light.visible = visible != nullptr && visible->get<bool>();
    set_excluding(name, excludes_of(node) != nullptr);
    if (index_.excluding.contains(name)) light.excluded = scene_.light(slot->second).excluded;  // until all is placed
  }
  set_light(slot->second, std::move(light));
}

/// Notes whether the light of a node excludes others.
void Compilation::set_excluding(const std::string& node, bool excludes) {
  if (index_.excluding.contains(node) == excludes) return;
  if (!old_excluding_) old_excluding_ = index_.excluding;
  if (excludes)
    index_.excluding.insert(node);
  else
    index_.excluding.erase(node);
}

/// Finds again what lights exclude: any node may have got or lost an object.
void Compilation::update_excludes() {
  for (const std::string& name : index_.excluding) {
    const LightId id = index_.nodes.at(name).light;
    Light light = scene_.light(id);
    light.excluded = objects_below(*excludes_of(document_.look["nodes"][name]));
    set_light(id, std::move(light));
  }
}

/// The objects at nodes and below them, increasing.
std::vector<ObjectId> Compilation::objects_below(const Json& nodes) const {
  std::set<std::string> found;
  std::vector<std::string> todo;
  for (const Json& node : nodes) todo.push_back(node.get<std::string>());
  std::vector<ObjectId> objects;
  while (!todo.empty()) {
    const std::string name = std::move(todo.back());
    todo.pop_back();
    const auto record = index_.nodes.find(name);
    if (record == index_.nodes.end() || !found.insert(name).second) continue;
    objects.insert(objects.end(), record->second.objects.begin(), record->second.objects.end());
    const Json& node = document_.look["nodes"][name];
    if (const auto children = node.find("children"); children != node.end())
      for (const Json& child : *children) todo.push_back(child.get<std::string>());
  }
  std::ranges::sort(objects);
  return objects;
}

void Compilation::update_suns() {
  if (scene_.integrator != Integrator::path) return;
  if (index_.suns.is_none()) index_.suns = new_light(none_of(LightKind::suns));
  set_light(index_.suns, suns_of(scene_.environment));
}

/// Requires: materials are compiled.
void Compilation::update_emission(const Entities& entities) {
  if (scene_.integrator != Integrator::path) return;
  for (const Entity& entity : entities) {
    if (entity.place.section != "materials") continue;
    const auto found = index_.materials.find(entity.place.name);
    if (found == index_.materials.end()) continue;
    const MaterialId id = found->second;
    Light light = emission_of(scene_.material(id), id);
    if (entity.value == nullptr) light.alive = false;  // removed; its slot stays
    const auto slot = index_.emission.find(id);
    if (slot != index_.emission.end()) {
      set_light(slot->second, std::move(light));
    } else if (light.alive) {
      Light none = none_of(LightKind::emission);
      none.material = id;
      const LightId made = index_.emission.emplace(id, new_light(std::move(none))).first->second;
      set_light(made, std::move(light));
    }
  }
}

void Compilation::update_light_order() {
  constexpr std::size_t kMostLights = std::size_t{1} << 20;  // colour programs name them with 20 bits
  if (old_lights_.empty()) return;
  scene_.light_order.clear();
  for (std::uint32_t i = 0; i < scene_.lights.size(); ++i)
    if (scene_.lights[i].alive) scene_.light_order.emplace_back(i);
  if (scene_.light_order.size() > kMostLights)
    fail("/lights", "a scene has at most " + std::to_string(kMostLights) + " lights");
  const auto rank = [](const Light& light) {
    return traits_of(light.kind).in_document ? 0 : static_cast<int>(light.kind);
  };
  std::ranges::sort(scene_.light_order, [&](LightId left, LightId right) {
    const Light& a = scene_.light(left);
    const Light& b = scene_.light(right);
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return rank(a) == 0 ? a.node < b.node : a.light < b.light;
  });
}

}  // namespace relook
