// Lights as the path oracle sees them. Inside tests/oracle.
#pragma once
#include <optional>

#include "reference_tracer.h"

namespace relook {

/// Of its shape, from the front; of an emission, without its image.
[[nodiscard]] Vec radiance_of(const Light& light);
/// Has it a size, so that rays can meet it? Emission is met as a surface.
[[nodiscard]] bool has_shape(const Light& light);
/// What window and cone of a lamp leave of it at a place.
[[nodiscard]] double share_of(const Light& light, const Vec& at);
/// How far along a ray, of a unit `way`, it meets a light's shape from the side that shines.
[[nodiscard]] std::optional<double> crossing(const Light& light, const Vec& origin, const Vec& way);

}  // namespace relook
