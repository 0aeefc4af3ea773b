// What each kind of node and each illumination model makes of a node's terms: a file each, named after the function.
#pragma once
#include "color/surface/surface_terms.h"

namespace relook {

/// What an illumination model says about a surface, before coverage.
[[nodiscard]] Triple metallic_roughness_color(SurfaceTerms& terms);
[[nodiscard]] Triple blinn_phong_color(SurfaceTerms& terms);

/// The share of light that passes a transparent surface on its way to a node.
[[nodiscard]] Triple filter_color(SurfaceTerms& terms);

/// What a ray that leaves the scene brings.
[[nodiscard]] Triple environment_color(SurfaceTerms& terms);

}  // namespace relook
