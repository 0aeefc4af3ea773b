#include "scene/compile_scene.h"

#include "scene/look_names.h"
#include "scene/look_schema.h"

namespace relook {
namespace {

std::string pointer_of(const TouchedEntity& entity) {
  return "/" + entity.section + (entity.name.empty() ? "" : "/" + escape_token(entity.name));
}

const Schema& schema_of_entity(const TouchedEntity& entity) {
  if (entity.section == "scene") return scene_schema();
  if (entity.section == "extensions") return extensions_schema();
  return schema_of(*section_of(entity.section));
}

/// Whether a change of an entity's value changes what its users compile to (nodes reach their children themselves).
bool reaches_users(const std::string& section) { return section != "materials" && section != "nodes"; }

}  // namespace

std::vector<TouchedEntity> all_entities(const LookDocument& document) {
  std::vector<TouchedEntity> entities;
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const std::string section(section_name(static_cast<Section>(s)));
    for (const auto& item : document.look.at(section).items()) entities.push_back({section, item.key()});
  }
  entities.push_back({"scene", ""});
  if (document.look.contains("extensions")) entities.push_back({"extensions", ""});
  return entities;
}

SceneDelta Compilation::run(const std::vector<TouchedEntity>& touched) {
  old_order_ = scene_.light_order;
  try {
    check_root();
    for (const TouchedEntity& entity : touched) check_name(entity);
    const Entities entities = with_users(touched);
    for (const TouchedEntity& entity : entities) check_entity(entity);
    for (const TouchedEntity& entity : touched)
      if (entity.section == "extensions") check_variants();
    for (const TouchedEntity& entity : entities)
      if (entity.section == "materials" && value_of(entity) != nullptr) update_material(entity.name);
    if (entities.contains({"scene", ""})) update_scene_entry();
    update_nodes(entities, touched);
    for (const TouchedEntity& entity : touched) update_references(entity);
    check_camera();
    return delta();
  } catch (...) {
    roll_back();
    throw;
  }
}

void Compilation::fail(const std::string& pointer, const std::string& what) const {
  throw LookError(context_.file, pointer, what);
}

void Compilation::check_root() const {
  const Json& look = document_.look;
  if (!look.is_object()) fail("", "the look document must stay an object");
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const std::string section(section_name(static_cast<Section>(s)));
    const auto found = look.find(section);
    if (found == look.end() || !found->is_object()) fail("/" + section, "must stay an object, keyed by name");
  }
  if (!look.contains("scene")) fail("/scene", "the scene entry cannot be removed");
  for (const auto& item : look.items())
    if (!section_of(item.key()) && item.key() != "scene" && item.key() != "extensions")
      fail("/" + escape_token(item.key()), "unknown key \"" + item.key() + "\"");
}

void Compilation::check_name(const TouchedEntity& entity) const {
  if (!section_of(entity.section)) return;
  if (entity.name.empty()) fail("/" + entity.section + "/", "a name must not be empty");
  if (printable(entity.name) != entity.name) fail(pointer_of(entity), "a name must not contain control characters");
}

const Json* Compilation::value_of(const TouchedEntity& entity) const {
  const auto section = document_.look.find(entity.section);
  if (section == document_.look.end()) return nullptr;
  if (entity.name.empty()) return &*section;
  const auto found = section->find(entity.name);
  return found == section->end() ? nullptr : &*found;
}

Compilation::Entities Compilation::with_users(const std::vector<TouchedEntity>& touched) const {
  Entities entities(touched.begin(), touched.end());
  std::vector<TouchedEntity> todo(entities.begin(), entities.end());
  while (!todo.empty()) {
    const TouchedEntity entity = std::move(todo.back());
    todo.pop_back();
    // Users of what was removed are checked again and found to refer to nothing.
    if (!reaches_users(entity.section) && value_of(entity) != nullptr) continue;
    const auto users = index_.users.find(entity);
    if (users == index_.users.end()) continue;
    for (const TouchedEntity& user : users->second)
      if (entities.insert(user).second) todo.push_back(user);
  }
  return entities;
}

void Compilation::check_entity(const TouchedEntity& entity) const {
  const Json* value = value_of(entity);
  if (value == nullptr) return;
  const std::string pointer = pointer_of(entity);
  check_against_schema(schema_of_entity(entity), *value, document_, context_.file, pointer);
  const std::optional<Section> section = section_of(entity.section);
  if (!section) return;
  if (*section == Section::lights) (void)compile_light(context_, entity.name, *value, pointer);
  if (*section == Section::images || *section == Section::samplers)
    check_texture_entity(context_, *section, *value, pointer);
  if (*section != Section::meshes) return;
  const std::string& geometry = (*value)["extras"]["relook"].value("geometry", "");
  const auto primitives = document_.assets->mesh_primitives.find(geometry);
  if (primitives == document_.assets->mesh_primitives.end())
    fail(pointer + "/extras/relook/geometry", "the scene has no geometry \"" + geometry + "\"");
  for (MeshId id : primitives->second)
    if (!value->contains("primitives") ||
        document_.assets->meshes[id.index()].primitive >= (*value)["primitives"].size())
      fail(pointer + "/primitives", "geometry \"" + geometry + "\" has more primitives");
}

void Compilation::check_variants() const {
  for (const auto& mesh : document_.look.at("meshes").items())
    check_against_schema(schema_of(Section::meshes), mesh.value(), document_, context_.file,
                         "/meshes/" + escape_token(mesh.key()));
}

void Compilation::update_references(const TouchedEntity& entity) {
  std::vector<TouchedEntity> references;
  if (const Json* value = value_of(entity))
    visit_names(schema_of_entity(entity), *value, [&](Target target, const Json& name) {
      if (target == Target::cameras || target == Target::variants) return;
      references.push_back({std::string(section_name(static_cast<Section>(target))), name.get<std::string>()});
    });
  const auto old = index_.references.find(entity);
  old_references_.try_emplace(entity, old == index_.references.end() ? std::vector<TouchedEntity>() : old->second);
  set_references(entity, std::move(references));
}

void Compilation::set_references(const TouchedEntity& entity, std::vector<TouchedEntity> references) {
  std::vector<TouchedEntity>& slot = index_.references[entity];
  for (const TouchedEntity& old : slot) {
    const auto users = index_.users.find(old);
    if (users == index_.users.end()) continue;
    users->second.erase(entity);
    if (users->second.empty()) index_.users.erase(users);
  }
  for (const TouchedEntity& now : references) index_.users[now].insert(entity);
  slot = std::move(references);
  if (slot.empty()) index_.references.erase(entity);
}

void Compilation::update_material(const std::string& name) {
  const TouchedEntity entity{"materials", name};
  Material material = compile_material(context_, name, *value_of(entity), pointer_of(entity));
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
  Environment environment = compile_environment(context_, relook["environment"]);
  if (ambient != scene_.ambient) old_ambient_ = std::exchange(scene_.ambient, ambient);
  if (environment != scene_.environment) old_environment_ = std::exchange(scene_.environment, std::move(environment));
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
  scene_.lights.resize(scene_.lights.size() - new_lights_.size());
  for (const std::string& name : new_materials_) index_.materials.erase(name);
  for (std::uint64_t key : new_objects_) index_.objects.erase(key);
  for (const std::string& node : new_lights_) index_.lights.erase(node);
  if (old_ambient_) scene_.ambient = *old_ambient_;
  if (old_environment_) scene_.environment = std::move(*old_environment_);
  scene_.light_order = std::move(old_order_);
}

}  // namespace relook
