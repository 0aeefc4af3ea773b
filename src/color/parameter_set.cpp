#include "color/parameter_set.h"

#include <algorithm>

namespace relook {

FieldMask ParameterSet::fields_of(MaterialId material) const {
  for (const auto& [changed, fields] : materials)
    if (changed == material) return fields;
  return 0;
}

bool ParameterSet::has(LightId light) const { return std::ranges::find(lights, light) != lights.end(); }

bool ParameterSet::reaches(MaterialId material, const Dependencies& read) const {
  if ((ambient && read.ambient) || (environment && read.environment)) return true;
  if ((fields_of(material) & read.material) != 0) return true;
  return std::ranges::any_of(lights,
                             [&](LightId light) { return std::ranges::find(read.lights, light) != read.lights.end(); });
}

}  // namespace relook
