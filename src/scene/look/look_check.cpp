#include "scene/look/look_check.h"

#include "base/error.h"
#include "scene/compile/compile_material.h"
#include "scene/look/look_names.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

void check_mesh(const LookDocument& document, const Json& value, std::string_view file, const std::string& pointer) {
  const std::string geometry = value["extras"]["relook"].value("geometry", "");
  const auto primitives = document.assets->mesh_primitives.find(geometry);
  if (primitives == document.assets->mesh_primitives.end())
    throw LookError(file, pointer + "/extras/relook/geometry", "the scene has no geometry \"" + geometry + "\"");
  for (MeshId id : primitives->second)
    if (!value.contains("primitives") || document.assets->meshes[id.index()].primitive >= value["primitives"].size())
      throw LookError(file, pointer + "/primitives", "geometry \"" + geometry + "\" has more primitives");
}

void check_skin(const LookDocument& document, const Json& value, std::string_view file, const std::string& pointer) {
  const std::string key = value["extras"]["relook"].value("inverseBinds", "");
  const auto inverse_binds = document.inverse_binds.find(key);
  if (inverse_binds == document.inverse_binds.end())
    throw LookError(file, pointer + "/extras/relook/inverseBinds",
                    "the scene has no inverse bind matrices \"" + key + "\"");
  const std::size_t joints = value.contains("joints") ? value["joints"].size() : 0;
  if (joints != inverse_binds->second.size())
    throw LookError(file, pointer + "/joints",
                    "there are " + std::to_string(joints) + " joints for " +
                        std::to_string(inverse_binds->second.size()) + " inverse bind matrices");
}

void check_node(const LookDocument& document, const Json& value, std::string_view file, const std::string& pointer) {
  if (member_at(value, {"extensions", "KHR_lights_punctual"}) != nullptr &&
      member_at(value, {"extensions", "EXT_lights_area"}) != nullptr)
    throw LookError(file, pointer + "/extensions", "a node has one light: of KHR_lights_punctual or EXT_lights_area");
  const Json* key = member_at(value, {"extras", "relook", "instances"});
  if (key != nullptr && !document.instances.contains(key->get_ref<const std::string&>()))
    throw LookError(file, pointer + "/extras/relook/instances", "the scene has no such instances");
}

}  // namespace

const Schema& schema_of_entity(const std::string& section) {
  if (section == "scene") return scene_schema();
  if (section == "extensions") return extensions_schema();
  return schema_of(*section_of(section));
}

void set_relook_extra(Json& value, const char* key, const Json& extra) {
  Json& extras = value["extras"];
  if (extras.is_null()) extras = Json::object();
  if (!extras.is_object()) return;
  Json& relook = extras["relook"];
  if (relook.is_null()) relook = Json::object();
  if (relook.is_object()) relook[key] = extra;
}

std::string entity_pointer(const TouchedEntity& entity) {
  return "/" + entity.section + (entity.name.empty() ? "" : "/" + escape_token(entity.name));
}

void check_sections(const LookDocument& document, std::string_view file) {
  const Json& look = document.look;
  if (!look.is_object()) throw LookError(file, "", "the look document must stay an object");
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const std::string section(section_name(static_cast<Section>(s)));
    const auto found = look.find(section);
    if (found == look.end() || !found->is_object())
      throw LookError(file, "/" + section, "must stay an object, keyed by name");
  }
  if (!look.contains("scene")) throw LookError(file, "/scene", "the scene entry cannot be removed");
  for (const auto& item : look.items())
    if (!section_of(item.key()) && item.key() != "scene" && item.key() != "extensions")
      throw LookError(file, "/" + escape_token(item.key()), "unknown key \"" + item.key() + "\"");
}

void check_entity_name(const TouchedEntity& entity, std::string_view file) {
  if (!section_of(entity.section)) return;
  if (entity.name.empty()) throw LookError(file, "/" + entity.section + "/", "a name must not be empty");
  if (printable(entity.name) != entity.name)
    throw LookError(file, entity_pointer(entity), "a name must not contain control characters");
}

void check_entity_values(const LookDocument& document, const TouchedEntity& entity, const Json& value,
                         std::string_view file) {
  check_against_schema(schema_of_entity(entity.section), value, document, file, entity_pointer(entity));
}

void check_entity(const LookDocument& document, const TouchedEntity& entity, const Json& value, std::string_view file) {
  check_entity_values(document, entity, value, file);
  const std::optional<Section> section = section_of(entity.section);
  if (!section) return;
  const std::string pointer = entity_pointer(entity);
  if (*section == Section::lights) (void)compile_light(file, entity.name, value, pointer);
  if (*section == Section::images || *section == Section::samplers)
    check_texture_entity(document, file, *section, value, pointer);
  if (*section == Section::meshes) check_mesh(document, value, file, pointer);
  if (*section == Section::skins) check_skin(document, value, file, pointer);
  if (*section == Section::nodes) check_node(document, value, file, pointer);
}

void check_values(const LookDocument& document) {
  for (const auto& part : document.look.items()) {
    if (!section_of(part.key())) {
      check_entity_values(document, {part.key(), ""}, part.value(), document.file);
      continue;
    }
    for (const auto& item : part.value().items())
      check_entity_values(document, {part.key(), item.key()}, item.value(), document.file);
  }
}

}  // namespace relook
