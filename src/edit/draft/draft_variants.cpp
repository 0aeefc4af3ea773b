// KHR_materials_variants as steps: switching a variant replaces materials of primitives.
#include "base/error.h"
#include "edit/draft/journal_draft.h"

namespace relook {
namespace {

const Json::json_pointer kVariants("/extensions/KHR_materials_variants/variants");
const Json::json_pointer kMappings("/extensions/KHR_materials_variants/mappings");

/// The material of a primitive under a variant; null: glTF's default material.
Json material_under(const Json& primitive, const Json& variant) {
  for (const Json& mapping : primitive[kMappings])
    for (const Json& mapped : mapping.value("variants", Json::array()))
      if (mapped == variant) return mapping.at("material");
  return primitive.value("material", Json());
}

/// Sets a material that is `before`, or absent (null).
Json operation(const std::string& path, const Json& before, const Json& material) {
  if (material.is_null()) return {{"op", "remove"}, {"path", path}};
  return {{"op", before.is_null() ? "add" : "replace"}, {"path", path}, {"value", material}};
}

}  // namespace

JournalDraft draft_variants(const LookDocument& document) {
  const Json& look = document.look;
  if (!look.contains(kVariants) || look[kVariants].empty())
    throw InputError(document.file, "", "the scene has no variants (KHR_materials_variants)");
  JournalDraft draft;
  Json current = look["meshes"];
  for (const Json& variant : look[kVariants]) {
    Json edit = Json::array();
    for (const auto& mesh : look["meshes"].items()) {
      const Json primitives = mesh.value().value("primitives", Json::array());
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (!primitives[i].contains(kMappings)) continue;
        Json& now = current[mesh.key()]["primitives"][i];
        const Json before = now.value("material", Json()), material = material_under(primitives[i], variant);
        if (before.is_null() && material.is_null()) continue;
        edit.push_back(
            operation("/meshes/" + escape_token(mesh.key()) + "/primitives/" + std::to_string(i) + "/material", before,
                      material));
        if (material.is_null())
          now.erase("material");
        else
          now["material"] = material;
      }
    }
    if (edit.empty()) draft.warnings.push_back("variant \"" + variant.get<std::string>() + "\" changes no material");
    draft.steps.push_back({{"name", variant}, {"edit", std::move(edit)}});
  }
  return draft;
}

}  // namespace relook
