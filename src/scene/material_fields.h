// The table of a material's fields: where each stands in a look document and what may stand there, which member of
// Material holds it, what people are told when it changes, and what a change of it does. From its rows follow the
// schema of materials (look/look_schema), their compilation (compile/compile_material), which fields an edit changes
// and what colour expressions read of them (here), and the sentence and the class of a change (edit/). A field is added
// by a member, an enumerator and a row; functions take other rows than material_rows() so that a test can add one.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "scene/material.h"

namespace relook {

/// Fields of a material, in the order in which sentences name them. What is looked up in the texture slots follows as
/// kFirstSlotField + slot, the colours of procedural textures as kFirstSlotColor + slot, and last where textures are
/// looked up: one bit for all slots.
enum class Field : std::uint8_t {
  model,
  alpha_mode,
  alpha_cutoff,
  double_sided,
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
  anisotropy_rotation,
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

/// One field of a material: a number, flag, colour or choice, or a texture slot.
struct MaterialRow {
  using Member = std::variant<float Material::*, bool Material::*, Color Material::*, Rgba Material::*,
                              IlluminationModel Material::*, AlphaMode Material::*, Slot>;
  enum Trait : unsigned {
    unread = 1,      // no colour expression reads it
    cuts = 2,        // decides where a cut-out surface has holes; of an Rgba its alpha does
    bends = 4,       // turns the normals that spawned rays leave by
    bends_coat = 8,  // likewise of the clearcoat
    angle = 16,      // colour expressions read its cosine (component 0) and its sine
    srgb = 32,       // of a slot: 8-bit images are sRGB-encoded
    zero_too = 64,   // SchemaField::zero_too
    unwritten = 128  // SchemaField::unwritten: documents omit the default
  };

  unsigned bit = 0;                           // in a FieldMask: of the Field, or of what the slot holds
  std::string_view words;                     // what people call it: "index of refraction"
  std::string_view pointer;                   // below the material: "pbrMetallicRoughness/roughnessFactor"
  Member member;                              // of a slot: the textureInfo at `pointer`
  std::array<double, 4> fallback{};           // as many as the member has components; a choice: its index
  double low = 0, high = 0;                   // bounds of numbers and of the components of colours
  std::span<const std::string_view> choices;  // by enumerator
  unsigned traits = 0;

  [[nodiscard]] bool has(Trait trait) const { return (traits & trait) != 0; }
  /// The texture slot; null for a row that is none.
  [[nodiscard]] const Slot* slot() const { return std::get_if<Slot>(&member); }
};

/// All fields of a material, in the order in which a document's schema has them.
[[nodiscard]] std::span<const MaterialRow> material_rows();

/// Do two materials differ in a field?
[[nodiscard]] bool differs(const MaterialRow& row, const Material& a, const Material& b);
/// Do they differ in a field that has the trait (`cuts`, `bends` or `bends_coat`)? For `cuts` only the alpha of an Rgba
/// counts.
[[nodiscard]] bool differs(MaterialRow::Trait trait, const Material& a, const Material& b,
                           std::span<const MaterialRow> rows = material_rows());

/// Fields whose values differ, among those that colour expressions read.
[[nodiscard]] FieldMask changed_fields(const Material& a, const Material& b,
                                       std::span<const MaterialRow> rows = material_rows());

/// What colour expressions read of a field: component `component` (of a scalar 0; of an angle 0 is the cosine, 1 the
/// sine). The value is 0 for flags and choices.
[[nodiscard]] float field_value(const Material& material, const MaterialRow& row, unsigned component);
[[nodiscard]] float field_value(const Material& material, Field field, unsigned component);

}  // namespace relook
