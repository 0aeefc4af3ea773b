// The frame of a compilation: what to compile, checks, materials and the scene entry, the delta, and the way back after
// an error. compile_nodes.cpp has the nodes.
#include "scene/compile/compile_scene.h"

#include <algorithm>

#include "scene/look/look_check.h"
#include "scene/look/look_names.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

/// Whether a change of an entity's value changes what its users compile to (nodes reach their children themselves).
bool reaches_users(const std::string& section) { return section != "materials" && section != "nodes"; }

}  // namespace

std::vector<CompiledEntity> all_entities(const LookDocument& document) {
  std::vector<CompiledEntity> entities;
  for (const auto& part : document.look.items()) {
    if (!section_of(part.key())) {
      entities.push_back({{part.key(), ""}, &part.value(), true});
      continue;
    }
    for (const auto& item : part.value().items()) entities.push_back({{part.key(), item.key()}, &item.value(), true});
  }
  return entities;
}

SceneDelta Compilation::run(const std::vector<TouchedEntity>& touched) {
  check_sections(document_, context_.file);
  for (const TouchedEntity& entity : touched) check_entity_name(entity, context_.file);
  const Entities entities = with_users(touched);
  check(entities);
  old_order_ = scene_.light_order;
  try {
    compile(entities);
    return delta();
  } catch (...) {
    roll_back();
    throw;
  }
}

void Compilation::run_first(const std::vector<CompiledEntity>& entities) {
  notes_history_ = false;
  require(std::ranges::is_sorted(entities, {}, &Entity::place), "entities come in the order of their places");
  compile(entities);
}

/// Checks all entities before any is compiled: what one refers to may have been touched as well.
void Compilation::check(const Entities& entities) const {
  for (const Entity& entity : entities)
    if (entity.value != nullptr) check_entity(document_, entity.place, *entity.value, context_.file);
  for (const Entity& entity : entities)
    if (entity.is_touched && entity.place.section == "extensions") check_variants();
}

void Compilation::compile(const Entities& entities) {
  ++index_.runs;
  for (const Entity& entity : entities) {
    if (entity.place.section == "materials" && entity.value != nullptr) update_material(entity);
    if (entity.place.section == "scene") update_scene_entry();
  }
  update_nodes(entities);
  update_emission(entities);
  update_light_order();
  for (const Entity& entity : entities)
    if (entity.is_touched) update_references(entity);
  check_camera();
}

void Compilation::fail(const std::string& pointer, const std::string& what) const {
  throw LookError(context_.file, pointer, what);
}

const Json* Compilation::value_of(const TouchedEntity& entity) const {
  const auto section = document_.look.find(entity.section);
  if (section == document_.look.end()) return nullptr;
  if (entity.name.empty()) return &*section;
  const auto found = section->find(entity.name);
  return found == section->end() ? nullptr : &*found;
}

Compilation::Entities Compilation::with_users(const std::vector<TouchedEntity>& touched) const {
  Entities entities;
  entities.reserve(touched.size());
  for (const TouchedEntity& entity : touched) entities.push_back({entity, value_of(entity), true});
  std::unordered_set<TouchedEntity, TouchedEntityHash> known;
  if (!index_.users.empty()) known.insert(touched.begin(), touched.end());
  for (std::size_t i = 0; i < entities.size(); ++i) {
    // Users of what was removed are checked again and found to refer to nothing.
    if (!reaches_users(entities[i].place.section) && entities[i].value != nullptr) continue;
    const auto users = index_.users.find(entities[i].place);
    if (users == index_.users.end()) continue;
    for (const TouchedEntity& user : users->second)
      if (known.insert(user).second) entities.push_back({user, value_of(user), false});
  }
  std::ranges::sort(entities, {}, &Entity::place);
  entities.erase(std::ranges::unique(entities, {}, &Entity::place).begin(), entities.end());
  return entities;
}

void Compilation::check_variants() const {
  for (const auto& mesh : document_.look.at("meshes").items())
    check_entity_values(document_, {"meshes", mesh.key()}, mesh.value(), context_.file);
}

void Compilation::update_references(const Entity& entity) {
  std::vector<TouchedEntity> references;
  if (entity.value != nullptr)
    visit_names(schema_of_entity(entity.place.section), *entity.value, [&](Target target, const Json& name) {
      if (target == Target::cameras || target == Target::variants) return;
      references.push_back({std::string(section_name(static_cast<Section>(target))), name.get<std::string>()});
    });
  if (notes_history_) {
    const auto old = index_.references.find(entity.place);
    old_references_.try_emplace(entity.place,
                                old == index_.references.end() ? std::vector<TouchedEntity>() : old->second);
  }
  set_references(entity.place, std::move(references));
}

void Compilation::set_references(const TouchedEntity& entity, std::vector<TouchedEntity> references) {
  if (const auto old = index_.references.find(entity); old != index_.references.end()) {
    for (const TouchedEntity& before : old->second) {
      const auto users = index_.users.find(before);
      if (users == index_.users.end()) continue;
      users->second.erase(entity);
      if (users->second.empty()) index_.users.erase(users);
    }
    index_.references.erase(old);
  }
  if (references.empty()) return;
  for (const TouchedEntity& now : references) index_.users[now].insert(entity);
  index_.references.emplace(entity, std::move(references));
}

void Compilation::update_material(const Entity& entity) {
  const std::string& name = entity.place.name;
  Material material = compile_material(context_, name, *entity.value, entity_pointer(entity.place));
  const auto [slot, is_new] =
      index_.materials.try_emplace(name, MaterialId(static_cast<std::uint32_t>(scene_.materials.size())));
  if (is_new) {
    new_materials_.push_back(name);
    scene_.materials.push_back(std::move(material));
    return;
  }
  Material& now = scene_.materials[slot->second.index()];
  if (now == material) return;
  old_materials_.try_emplace(slot->second, now);
  now = std::move(material);
}

void Compilation::update_scene_entry() {
  const Json& relook = document_.look.at("scene")["extras"]["relook"];
  const Color ambient = color_of(relook["ambient"]);
  Environment environment = compile_environment(context_, relook["environment"], scene_.integrator);
  if (ambient != scene_.ambient) old_ambient_ = std::exchange(scene_.ambient, ambient);
  if (environment != scene_.environment) old_environment_ = std::exchange(scene_.environment, std::move(environment));
  update_suns();
}

SceneDelta Compilation::delta() {
  SceneDelta delta;
  for (auto& [id, before] : old_materials_) delta.materials.push_back({id, std::move(before)});
  for (auto& [id, before] : old_objects_) {
    const Object& now = scene_.object(id);
    if (before != now && (before.alive || now.alive)) delta.objects.push_back({id, std::move(before)});
  }
  for (auto& [id, before] : old_lights_) {
    const Light& now = scene_.light(id);
    if (before != now && (before.alive || now.alive)) delta.lights.push_back({id, std::move(before)});
  }
  delta.ambient_before = old_ambient_;
  delta.environment_before = std::move(old_environment_);
  return delta;
}

void Compilation::roll_back() {
  for (auto& [entity, references] : old_references_) set_references(entity, std::move(references));
  for (auto& [name, record] : old_nodes_) {
    if (record)
      index_.nodes[name] = std::move(*record);
    else
      index_.nodes.erase(name);
  }
  for (auto& [id, material] : old_materials_) scene_.materials[id.index()] = std::move(material);
  for (auto& [id, object] : old_objects_) scene_.objects[id.index()] = std::move(object);
  for (auto& [id, light] : old_lights_) scene_.lights[id.index()] = std::move(light);
  scene_.materials.resize(scene_.materials.size() - new_materials_.size());
  scene_.objects.resize(scene_.objects.size() - new_objects_.size());
  for (; new_lights_ > 0; --new_lights_) {
    index_.forget(scene_.lights.back());
    scene_.lights.pop_back();
  }
  if (old_excluding_) index_.excluding = std::move(*old_excluding_);
  for (const std::string& name : new_materials_) index_.materials.erase(name);
  for (std::uint64_t key : new_objects_) index_.objects.erase(key);
  if (old_ambient_) scene_.ambient = *old_ambient_;
  if (old_environment_) scene_.environment = std::move(*old_environment_);
  scene_.light_order = std::move(old_order_);
}

}  // namespace relook
