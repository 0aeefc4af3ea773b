// The parameters of a material, light and scene that colour expressions read: what the leaves of a colour tree point to
// (paper 2.1). Masks of fields tell which expressions an edit can change.
#pragma once
#include <cstdint>

#include "scene/scene.h"

namespace relook {

/// Fields of a material. What is looked up in the texture slots follows as kFirstSlotField + slot, the colours of
/// procedural textures as kFirstSlotColor + slot, and last where textures are looked up: one bit for all slots.
enum class Field : std::uint8_t {
  model,
  alpha_mode,
  base_color,
  metallic,
  roughness,
  normal_scale,
  occlusion_strength,
  emissive,
  emissive_strength,
  ior,
  dispersion,
  transmission,
  thickness,
  attenuation_distance,
  attenuation_color,
  specular,
  specular_color,
  clearcoat,
  clearcoat_roughness,
  clearcoat_normal_scale,
  sheen_color,
  sheen_roughness,
  anisotropy,
  anisotropy_rotation,  // components: its cosine, its sine
  iridescence,
  iridescence_ior,
  iridescence_minimum,
  iridescence_maximum,
  phong_ambient,
  phong_diffuse,
  phong_specular,
  shininess,
  reflection,
  refraction,
  transparency,
  count
};
inline constexpr unsigned kFirstSlotField = static_cast<unsigned>(Field::count);
inline constexpr unsigned kFirstSlotColor = kFirstSlotField + static_cast<unsigned>(kSlotCount);
inline constexpr unsigned kMappingField = kFirstSlotColor + static_cast<unsigned>(kSlotCount);
static_assert(kMappingField < 128);

__extension__ using FieldMask = unsigned __int128;
[[nodiscard]] constexpr FieldMask mask_of(Field field) { return FieldMask{1} << static_cast<unsigned>(field); }
[[nodiscard]] constexpr FieldMask mask_of(Slot slot) {
  return FieldMask{1} << (kFirstSlotField + static_cast<unsigned>(slot));
}
[[nodiscard]] constexpr FieldMask color_mask_of(Slot slot) {
  return FieldMask{1} << (kFirstSlotColor + static_cast<unsigned>(slot));
}
inline constexpr FieldMask kMappingMask = FieldMask{1} << kMappingField;

/// Fields whose values differ.
[[nodiscard]] FieldMask changed_fields(const Material& a, const Material& b);
/// Component `component` of a numeric field (scalars: component 0).
[[nodiscard]] float field_value(const Material& material, Field field, unsigned component);
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
  inverse_cone_width,  // of the difference to that of the inner one; the largest float for a hard edge
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
