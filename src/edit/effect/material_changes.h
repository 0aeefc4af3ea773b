// A sentence for what lies between two values of a material, a light or the environment.
#pragma once
#include <string>

#include "scene/material_fields.h"
#include "scene/scene.h"

namespace relook {

/// "index of refraction 1.5 -> 1.8, roughness 0 -> 0.3"
[[nodiscard]] std::string describe_material_change(const Material& before, const Material& after,
                                                   std::span<const MaterialRow> rows = material_rows());
[[nodiscard]] std::string describe_light_change(const Light& before, const Light& after);
[[nodiscard]] std::string describe_environment_change(const Environment& before, const Environment& after);
/// "(0, 0, 0) -> (0.1, 0.1, 0.1)"
[[nodiscard]] std::string describe_values(const Color& before, const Color& after);

}  // namespace relook
