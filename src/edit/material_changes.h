// What lies between two values of a material, a light or the environment: its class (Table 1) and a sentence.
#pragma once
#include <string>

#include "edit/apply.h"
#include "scene/scene.h"

namespace relook {

/// color, optical or geometric, for a mesh that shows the material.
[[nodiscard]] ChangeClass material_change_class(const Material& before, const Material& after, const Mesh& mesh);

/// "index of refraction 1.5 -> 1.8, roughness 0 -> 0.3"
[[nodiscard]] std::string describe_material_change(const Material& before, const Material& after);
[[nodiscard]] std::string describe_light_change(const Light& before, const Light& after);
[[nodiscard]] std::string describe_environment_change(const Environment& before, const Environment& after);
/// "(0, 0, 0) -> (0.1, 0.1, 0.1)"
[[nodiscard]] std::string describe_values(const Color& before, const Color& after);

}  // namespace relook
