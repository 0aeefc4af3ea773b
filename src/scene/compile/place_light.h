// What of a light follows from numbers alone: the place and the axes that a node gives it, and the colour of a
// temperature. Called while lights are compiled; only + - * / and sqrt, so that the bits are the same everywhere.
#pragma once
#include "scene/compile/compile_transform.h"
#include "scene/light.h"

namespace relook {

/// Half axes, radii (metres) and angles (radians) that are not zero are at least and at most this, so that areas and
/// solid angles, and what is divided by them, stay finite.
inline constexpr float kSmallestLight = 1e-9F, kLargestLight = 1e9F, kSmallestAngle = 1e-6F;
inline constexpr float kSmallestRate = 1.0F / 1024;

/// Puts a light where its node stands; `light` has the half axes of the untransformed node. As EXT_lights_area says, an
/// area is as many times as large as the largest component of the node's scale, whatever its sign, in all directions.
/// False if the node is scaled to nothing that the light needs: it then gives none. An area needs two axes of three.
[[nodiscard]] bool place_light(const WideTransform& world, const WidePoint& eye, Light& light);

/// Linear sRGB of luminance 1 of a black body at `kelvin`, colours outside of sRGB clamped: M. Krystek, An algorithm to
/// calculate correlated colour temperature, Color Research & Application 10 (1985), for the locus from 1000 to 15000 K,
/// beyond which it tends to a blue nearby; IEC 61966-2-1 for its matrix.
[[nodiscard]] Color temperature_color(double kelvin);

}  // namespace relook
