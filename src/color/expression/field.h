// The parameters of a material, light and scene that colour expressions read: what the leaves of a colour tree point to
// (paper 2.1). Those of materials are material_fields.h's, whose masks tell which expressions an edit can change.
#pragma once
#include <cstdint>

#include "scene/material_fields.h"
#include "scene/scene.h"

namespace relook {

/// Component of a procedural texture's color1 (0..2) or color2 (3..5).
[[nodiscard]] float slot_color(const TextureSlot& slot, unsigned component);

/// Numbers of a light: colour parameters and placement.
enum class LightField : std::uint8_t {
  red,
  green,
  blue,
  intensity,
  inverse_range,
  outer_versine,       // 1 - cos of the outer cone angle
  inverse_cone_width,  // 1 / (cos of the inner cone angle - cos of the outer); the largest float for a hard edge
  x,
  y,
  z,
  dx,
  dy,
  dz
};
[[nodiscard]] float field_value(const Light& light, LightField field);
/// True for the colour parameters: the rest is placement.
[[nodiscard]] constexpr bool is_color(LightField field) { return field < LightField::x; }

}  // namespace relook
