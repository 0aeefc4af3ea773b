#include "color/expression/parameter_set.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace relook {

FieldMask ParameterSet::fields_of(MaterialId material) const {
  const auto known = std::ranges::lower_bound(materials, material, {}, &std::pair<MaterialId, FieldMask>::first);
  return known != materials.end() && known->first == material ? known->second : 0;
}

bool ParameterSet::has(LightId light) const { return std::ranges::binary_search(lights, light); }

bool ParameterSet::contains(const ParameterSet& others) const {
  if ((others.ambient && !ambient) || (others.environment && !environment)) return false;
  return std::ranges::all_of(others.lights, [&](LightId light) { return has(light); }) &&
         std::ranges::all_of(others.materials,
                             [&](const auto& entry) { return (entry.second & ~fields_of(entry.first)) == 0; });
}

void ParameterSet::add(const ParameterSet& others) {
  ambient = ambient || others.ambient;
  environment = environment || others.environment;
  std::vector<LightId> both;
  std::ranges::set_union(lights, others.lights, std::back_inserter(both));
  lights = std::move(both);
  materials.insert(materials.end(), others.materials.begin(), others.materials.end());
  std::ranges::stable_sort(materials, {}, &std::pair<MaterialId, FieldMask>::first);
  std::size_t last = 0;
  for (std::size_t i = 1; i < materials.size(); ++i)
    if (materials[i].first == materials[last].first)
      materials[last].second |= materials[i].second;
    else
      materials[++last] = materials[i];
  if (!materials.empty()) materials.resize(last + 1);
}

bool ParameterSet::reaches(MaterialId material, const Dependencies& read) const {
  if ((ambient && read.ambient) || (environment && read.environment)) return true;
  if ((fields_of(material) & read.material) != 0) return true;
  return !lights.empty() && std::ranges::any_of(read.lights, [&](LightId light) { return has(light); });
}

}  // namespace relook
