#include "edit/guide/path_hints.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "scene/compile/compile_material.h"
#include "scene/look/look_check.h"
#include "scene/look/look_hints.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

struct SectionWord {
  std::string_view word;
  std::vector<std::string> place;
};
const std::vector<SectionWord>& section_words() {
  static const std::vector<SectionWord> words{{"light", {"lights"}},
                                              {"lamp", {"lights"}},
                                              {"lamps", {"lights"}},
                                              {"material", {"materials"}},
                                              {"shaders", {"materials"}},
                                              {"node", {"nodes"}},
                                              {"object", {"nodes"}},
                                              {"objects", {"nodes"}},
                                              {"mesh", {"meshes"}},
                                              {"texture", {"textures"}},
                                              {"image", {"images"}},
                                              {"environment", {"scene", "extras", "relook", "environment"}},
                                              {"world", {"scene", "extras", "relook", "environment"}},
                                              {"sky", {"scene", "extras", "relook", "environment"}},
                                              {"hdri", {"scene", "extras", "relook", "environment"}},
                                              {"ambient", {"scene", "extras", "relook", "ambient"}}};
  return words;
}

const Json* entities(const LookDocument& document, const std::string& section) {
  const auto found = document.look.find(section);
  return found == document.look.end() || !found->is_object() ? nullptr : &*found;
}
bool has_entity(const LookDocument& document, const std::string& section, const std::string& name) {
  const Json* names = entities(document, section);
  return names != nullptr && names->contains(name);
}

const std::string* light_of(const LookDocument& document, const std::string& node) {
  if (!has_entity(document, "nodes", node)) return nullptr;
  for (const char* extension : {"KHR_lights_punctual", "EXT_lights_area"}) {
    const Json* light = member_at(document.look["nodes"][node], {"extensions", extension, "light"});
    if (light != nullptr && light->is_string()) return &light->get_ref<const std::string&>();
  }
  return nullptr;
}

/// The material of the first primitive that has one, of a mesh or of a node's.
const std::string* material_of(const LookDocument& document, const std::string& section, const std::string& name) {
  if (!has_entity(document, section, name)) return nullptr;
  const Json& entity = document.look[section][name];
  if (section == "nodes") {
    const Json* mesh = member_at(entity, {"mesh"});
    return mesh == nullptr || !mesh->is_string() ? nullptr : material_of(document, "meshes", mesh->get<std::string>());
  }
  const Json* primitives = member_at(entity, {"primitives"});
  if (primitives == nullptr) return nullptr;
  for (const Json& primitive : *primitives)
    if (primitive.contains("material") && primitive["material"].is_string())
      return &primitive["material"].get_ref<const std::string&>();
  return nullptr;
}

std::string node_with_light(const LookDocument& document, const std::string& light) {
  const Json* nodes = entities(document, "nodes");
  if (nodes == nullptr) return "";
  for (const auto& item : nodes->items())
    if (const std::string* own = light_of(document, item.key()); own != nullptr && *own == light) return item.key();
  return "";
}

/// Do tokens lead to a place that exists or that a schema knows of an entity that does?
bool leads_somewhere(const LookDocument& document, const Tokens& tokens) {
  if (tokens.empty()) return true;
  const std::optional<Section> section = section_of(tokens[0]);
  const auto below = [&](std::size_t count) { return std::span(tokens).subspan(std::min(count, tokens.size())); };
  if (!section) {
    if (tokens[0] == "scene") return knows_place(scene_schema(), below(1));
    return tokens[0] == "extensions" && knows_place(extensions_schema(), below(1));
  }
  return tokens.size() < 2 ||
         (has_entity(document, tokens[0], tokens[1]) && knows_place(schema_of(*section), below(2)));
}

/// The same pointer with its end where the schema of its entity has it; empty if it has none.
Tokens deepened(const Tokens& tokens, const Schema& schema, std::size_t first) {
  Tokens at(tokens.begin(), tokens.begin() + static_cast<std::ptrdiff_t>(first));
  const Schema* level = &schema;
  for (std::size_t i = first; i < tokens.size(); ++i) {
    const auto field = std::ranges::find(level->fields, tokens[i], &SchemaField::key);
    if (field != level->fields.end()) {
      at.push_back(tokens[i]);
      if (field->kind == FieldKind::object) {
        level = field->inner;
        continue;
      }
      at.insert(at.end(), tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1, tokens.end());
      return at;
    }
    std::string place = deeper_place(*level, tokens[i]);
    if (place.empty() && level != &schema) {  // from the entity on
      place = deeper_place(schema, tokens[i]);
      at.resize(first);
    }
    if (place.empty()) return {};
    const Tokens found = split_pointer("/" + place, "", "");
    at.insert(at.end(), found.begin(), found.end());
    at.insert(at.end(), tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1, tokens.end());
    return at;
  }
  return at;
}

/// What is meant by a pointer into an entity that exists.
Tokens meant_below(const LookDocument& document, const Tokens& tokens) {
  const auto section = section_of(tokens[0]);
  const bool is_scene = tokens[0] == "scene";
  if (!section && !is_scene) return {};
  if (Tokens at = deepened(tokens, is_scene ? scene_schema() : schema_of(*section), is_scene ? 1 : 2); !at.empty())
    return at;
  const auto elsewhere = [&](const char* other, const std::string& name) {
    Tokens moved{other, name};
    moved.insert(moved.end(), tokens.begin() + 2, tokens.end());
    return deepened(moved, schema_of(*section_of(other)), 2);
  };
  if (is_scene) return {};
  if (const std::string* light = *section == Section::nodes ? light_of(document, tokens[1]) : nullptr)
    if (Tokens at = elsewhere("lights", *light); !at.empty()) return at;
  if (*section == Section::nodes || *section == Section::meshes)
    if (const std::string* material = material_of(document, tokens[0], tokens[1]))
      return elsewhere("materials", *material);
  if (*section == Section::lights)
    if (const std::string node = node_with_light(document, tokens[1]); !node.empty()) return elsewhere("nodes", node);
  return {};
}

/// What is meant by a name that a section does not have: the same name in another one.
Tokens meant_entity(const LookDocument& document, const Tokens& tokens) {
  Tokens at = tokens;
  const std::string& name = tokens[1];
  if (tokens[0] == "lights") {
    if (const std::string* light = light_of(document, name)) at[1] = *light;
  } else if (tokens[0] == "materials") {
    const std::string* material = material_of(document, "nodes", name);
    if (material == nullptr) material = material_of(document, "meshes", name);
    if (material != nullptr) at[1] = *material;
  } else if (tokens[0] == "nodes") {
    at[1] = node_with_light(document, name);
  }
  return at == tokens || at[1].empty() ? Tokens() : at;
}

Tokens with_start(const Tokens& start, const Tokens& tokens, std::size_t skipped) {
  Tokens at = start;
  at.insert(at.end(), tokens.begin() + static_cast<std::ptrdiff_t>(skipped), tokens.end());
  return at;
}

/// What is meant by a pointer whose first token is no part of a document.
Tokens meant_section(const LookDocument& document, const Tokens& tokens) {
  for (const SectionWord& word : section_words())
    if (tokens[0] == word.word) return with_start(word.place, tokens, 1);
  if (tokens[0] == "scenes") return with_start({"scene"}, tokens, std::min<std::size_t>(2, tokens.size()));
  for (const char* section : {"materials", "lights", "nodes"})
    if (has_entity(document, section, tokens[0])) return with_start({section}, tokens, 0);
  return {};
}

/// Where the first token that leads nowhere is, and what it is of.
std::string missing_text(const LookDocument& document, const Tokens& tokens) {
  const std::size_t depth = existing_depth(document.look, tokens);
  const std::size_t at = std::min(depth, tokens.size() - 1);
  const std::string above = pointer_text(Tokens(tokens.begin(), tokens.begin() + static_cast<std::ptrdiff_t>(at)));
  return "no \"" + tokens[at] + "\"" + (above.empty() ? "" : " in " + above);
}

/// A whole number of radians beyond a full turn: degrees, most likely.
bool looks_like_degrees(const Json& value) {
  if (!value.is_number()) return false;
  const auto x = value.get<double>();
  return std::abs(x) > 2 * std::numbers::pi + 0.1 && std::floor(x) == x && std::abs(x) <= 3600;
}

bool looks_like_bytes(const Json& value) {
  const auto is_byte = [](const Json& x) {
    return x.is_number() && x >= 0 && x <= 255 && std::floor(x.get<double>()) == x;
  };
  return value.is_array() && value.size() == 3 && std::ranges::all_of(value, is_byte) &&
         std::ranges::any_of(value, [](const Json& x) { return x > 32; });
}

std::string slip_of(const PatchOperation& operation) {
  const std::string& path = operation.path;
  const bool is_angle = path.ends_with("/environment/rotation") || path.ends_with("/background/rotation") ||
                        path.ends_with("/KHR_texture_transform/rotation") || path.ends_with("/anisotropyRotation");
  if (is_angle && looks_like_degrees(operation.value)) {
    char radians[32];
    std::snprintf(radians, sizeof radians, "%.6g", operation.value.get<double>() * std::numbers::pi / 180);
    return operation.value.dump() + " is taken for radians; so many degrees are " + radians;
  }
  if (path.ends_with("/color") && looks_like_bytes(operation.value))
    return operation.value.dump() + " is taken as it is; linear colours of a light seldom are above 1";
  return "";
}

}  // namespace

std::string path_hint(const LookDocument& document, const Tokens& tokens) {
  if (tokens.empty() || leads_somewhere(document, tokens) || tokens.back() == "asset") return "";
  Tokens meant = tokens;
  // Section, then name, then place: each mends what the one before could not know.
  if (!section_of(meant[0]) && meant[0] != "scene" && meant[0] != "extensions") meant = meant_section(document, meant);
  const bool has_name = meant.size() > 1 && section_of(meant[0]);
  if (has_name && !has_entity(document, meant[0], meant[1])) {
    if (meant == tokens)
      meant = meant_entity(document, meant);
    else if (Tokens other = meant_entity(document, meant); !other.empty())
      meant = std::move(other);
  }
  if (!meant.empty() && !leads_somewhere(document, meant)) {
    const bool has_entry = meant[0] == "scene" || (meant.size() > 1 && has_entity(document, meant[0], meant[1]));
    if (Tokens below = has_entry ? meant_below(document, meant) : Tokens(); !below.empty()) meant = std::move(below);
  }
  if (meant.empty() || meant == tokens || !leads_somewhere(document, meant)) return "";
  return missing_text(document, tokens) + "; did you mean " + pointer_text(meant) + "?";
}

std::vector<std::string> slip_warnings(const Journal& journal) {
  constexpr std::size_t kMostWarnings = 5;
  std::vector<std::string> warnings;
  for (const JournalStep& step : journal.steps) {
    const std::size_t frames = step.frames();
    for (std::size_t frame = 0; frame < frames;
         frame += std::max<std::size_t>(frames - 1, 1)) {  // the first and the last
      for (const PatchOperation& operation : step.edit_of(frame)) {
        if (operation.op != PatchOp::add && operation.op != PatchOp::replace) continue;
        const std::string slip = slip_of(operation);
        if (slip.empty() || warnings.size() == kMostWarnings) continue;
        warnings.push_back(journal.file + ": " + operation.value_where + ": " + slip);
        break;
      }
    }
  }
  return warnings;
}

}  // namespace relook
