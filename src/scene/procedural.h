// Procedural solid textures (paper 2.1, 4.1.1): marble, wood, checker and noise as pure functions of a position and a
// few parameters. The result always lies between color1 and color2, so parameters bound what a texture can reach.
#pragma once
#include "base/math.h"
#include "scene/material.h"

namespace relook {

/// The texture's value at `position`, in the units of its coordinates (object-space metres, or uv with z = 0); alpha 1.
[[nodiscard]] Rgba evaluate(const Procedural& texture, Point position);

/// Gradient noise in [-1, 1], 0 on the integer lattice, period 2^31 (K. Perlin, Improving Noise, 2002: its fade curve and
/// gradients, with an integer hash for the permutation table).
[[nodiscard]] float gradient_noise(Point position);

}  // namespace relook
