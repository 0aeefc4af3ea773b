#include "scene/look/sides.h"

namespace relook {
namespace {

const Json::json_pointer kOwnSides("/extras/relook/doubleSided");

}  // namespace

bool is_solid(const Json& material) {
  const auto is_positive = [&](const char* pointer) {
    const Json::json_pointer at(pointer);
    return material.contains(at) && material[at].is_number() && material[at].get<double>() > 0;
  };
  const Json::json_pointer model("/extras/relook/model");
  if (material.contains(model) && material[model] == "blinn-phong") return is_positive("/extras/relook/refraction");
  return is_positive("/extensions/KHR_materials_volume/thicknessFactor") &&
         is_positive("/extensions/KHR_materials_transmission/transmissionFactor");
}

void resolve_sides(Json& material) {
  if (!material.is_object()) return;
  if (material.contains(kOwnSides) && material[kOwnSides].is_boolean())
    material["doubleSided"] = material[kOwnSides];
  else if (is_solid(material))
    material.erase("doubleSided");
}

void write_sides(bool is_double_sided, Json& material) {
  if (material.contains(kOwnSides)) material["extras"]["relook"].erase("doubleSided");
  if (is_solid(material)) {
    if (is_double_sided) return;
    material["extras"]["relook"]["doubleSided"] = false;
  }
  if (is_double_sided || material.contains("doubleSided")) material["doubleSided"] = is_double_sided;
}

}  // namespace relook
