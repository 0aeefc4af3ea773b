// Procedural solid textures (paper 2.1, 4.1.1): marble, wood, checker and noise as pure functions of a position and a
// few parameters. The result always lies between color1 and color2, so parameters bound what a texture can reach. Read
// by colour programs (color/expression/lanes.cpp), tracing (trace/surface.cpp: alpha) and displacement.
#pragma once
#include <span>

#include "base/math.h"
#include "scene/material.h"

namespace relook {

/// The texture's value at `position`, in the units of its coordinates (object-space metres, or uv with z = 0); alpha 1.
[[nodiscard]] Rgba evaluate(const Procedural& texture, Point position);

/// The same for many positions at once: the weight w of color2, in [0, 1], lane by lane, where
/// the value is color1 (1 - w) + color2 w. Spans of equal length.
void procedural_weights(const Procedural& texture, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> weight);

}  // namespace relook
