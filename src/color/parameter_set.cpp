#include "color/parameter_set.h"

#include <algorithm>

namespace relook {

FieldMask ParameterSet::fields_of(MaterialId material) const {
  for (const auto& [changed, fields] : materials)
    if (changed == material) return fields;
  return 0;
}

bool ParameterSet::has(LightId light) const { return std::ranges::find(lights, light) != lights.end(); }

bool ParameterSet::contains(const ParameterSet& others) const {
  if ((others.ambient && !ambient) || (others.environment && !environment)) return false;
  return std::ranges::all_of(others.lights, [&](LightId light) { return has(light); }) &&
         std::ranges::all_of(others.materials,
                             [&](const auto& entry) { return (entry.second & ~fields_of(entry.first)) == 0; });
}

void ParameterSet::add(const ParameterSet& others) {
  ambient = ambient || others.ambient;
  environment = environment || others.environment;
  for (const LightId light : others.lights)
    if (!has(light)) lights.push_back(light);
  for (const auto& [material, fields] : others.materials) {
    const auto known = std::ranges::find(materials, material, &std::pair<MaterialId, FieldMask>::first);
    if (known != materials.end())
      known->second |= fields;
    else
      materials.emplace_back(material, fields);
  }
}

bool ParameterSet::reaches(MaterialId material, const Dependencies& read) const {
  if ((ambient && read.ambient) || (environment && read.environment)) return true;
  if ((fields_of(material) & read.material) != 0) return true;
  return std::ranges::any_of(lights,
                             [&](LightId light) { return std::ranges::find(read.lights, light) != read.lights.end(); });
}

}  // namespace relook
