#include "scene/material_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "scene/look/look_schema.h"

namespace relook {
namespace {

using Row = MaterialRow;

constexpr std::array<std::string_view, 3> kModels{"metallic-roughness", "blinn-phong", "unlit"};
constexpr std::array<std::string_view, 3> kAlphaModes{"OPAQUE", "MASK", "BLEND"};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr unsigned bit_of(Field field) { return static_cast<unsigned>(field); }
constexpr unsigned bit_of(Slot slot) { return kFirstSlotField + static_cast<unsigned>(slot); }

constexpr Row number(Field field, std::string_view words, std::string_view pointer, float Material::*member,
                     double fallback, double low, double high, unsigned traits = 0) {
  return {bit_of(field), words, pointer, member, {fallback}, low, high, {}, traits};
}
constexpr Row color(Field field, std::string_view words, std::string_view pointer, Color Material::*member,
                    double fallback, double high) {
  return {bit_of(field), words, pointer, member, {fallback, fallback, fallback}, 0, high, {}, 0};
}
constexpr Row rgba(Field field, std::string_view words, std::string_view pointer, Rgba Material::*member,
                   double fallback, double high, unsigned traits) {
  return {bit_of(field), words, pointer, member, {fallback, fallback, fallback, fallback}, 0, high, {}, traits};
}
/// A flag that is false unless a document says otherwise.
constexpr Row flag(Field field, std::string_view words, std::string_view pointer, bool Material::*member,
                   unsigned traits) {
  return {bit_of(field), words, pointer, member, {}, 0, 0, {}, traits};
}
/// A choice that is the first of `choices` unless a document says otherwise.
template <class Enum>
constexpr Row choice(Field field, std::string_view words, std::string_view pointer, Enum Material::*member,
                     std::span<const std::string_view> choices) {
  return {bit_of(field), words, pointer, member, {}, 0, 0, choices, 0};
}
constexpr Row texture(Slot slot, std::string_view words, std::string_view pointer, unsigned traits = 0) {
  return {bit_of(slot), words, pointer, slot, {}, 0, 0, {}, traits};
}

// Bounds of what glTF defines are glTF's. A slot's row comes before those of numbers inside its textureInfo.
constexpr auto kRows = std::to_array<Row>({
    rgba(Field::base_color, "base colour", "pbrMetallicRoughness/baseColorFactor", &Material::base_color, 1, 1,
         Row::cuts),
    number(Field::metallic, "metallic", "pbrMetallicRoughness/metallicFactor", &Material::metallic, 1, 0, 1),
    number(Field::roughness, "roughness", "pbrMetallicRoughness/roughnessFactor", &Material::roughness, 1, 0, 1),
    texture(Slot::base_color, "base colour texture", "pbrMetallicRoughness/baseColorTexture", Row::srgb | Row::cuts),
    texture(Slot::metallic_roughness, "metallic-roughness texture", "pbrMetallicRoughness/metallicRoughnessTexture"),
    texture(Slot::normal, "normal map", "normalTexture", Row::bends),
    number(Field::normal_scale, "normal scale", "normalTexture/scale", &Material::normal_scale, 1, -kCeiling, kCeiling,
           Row::bends),
    texture(Slot::occlusion, "occlusion texture", "occlusionTexture"),
    number(Field::occlusion_strength, "occlusion strength", "occlusionTexture/strength", &Material::occlusion_strength,
           1, 0, 1),
    texture(Slot::emissive, "emissive texture", "emissiveTexture", Row::srgb),
    color(Field::emissive, "emissive", "emissiveFactor", &Material::emissive, 0, 1),
    choice(Field::alpha_mode, "alpha mode", "alphaMode", &Material::alpha_mode, kAlphaModes),
    number(Field::alpha_cutoff, "alpha cutoff", "alphaCutoff", &Material::alpha_cutoff, 0.5, 0, kUnbounded,
           Row::unread | Row::cuts),
    flag(Field::double_sided, "double-sided", "doubleSided", &Material::double_sided, Row::unread),

    number(Field::ior, "index of refraction", "extensions/KHR_materials_ior/ior", &Material::ior, 1.5, 1, kCeiling,
           Row::zero_too),
    number(Field::dispersion, "dispersion", "extensions/KHR_materials_dispersion/dispersion", &Material::dispersion, 0,
           0, kCeiling),
    number(Field::transmission, "transmission", "extensions/KHR_materials_transmission/transmissionFactor",
           &Material::transmission, 0, 0, 1),
    texture(Slot::transmission, "transmission texture", "extensions/KHR_materials_transmission/transmissionTexture"),
    number(Field::thickness, "thickness", "extensions/KHR_materials_volume/thicknessFactor", &Material::thickness, 0, 0,
           kCeiling),
    texture(Slot::thickness, "thickness texture", "extensions/KHR_materials_volume/thicknessTexture"),
    number(Field::attenuation_distance, "attenuation distance", "extensions/KHR_materials_volume/attenuationDistance",
           &Material::attenuation_distance, kInfinity, kAboveZero, kUnbounded, Row::unwritten),
    color(Field::attenuation_color, "attenuation colour", "extensions/KHR_materials_volume/attenuationColor",
          &Material::attenuation_color, 1, 1),
    number(Field::specular, "specular", "extensions/KHR_materials_specular/specularFactor", &Material::specular, 1, 0,
           1),
    texture(Slot::specular, "specular texture", "extensions/KHR_materials_specular/specularTexture"),
    color(Field::specular_color, "specular colour", "extensions/KHR_materials_specular/specularColorFactor",
          &Material::specular_color, 1, kCeiling),
    texture(Slot::specular_color, "specular colour texture", "extensions/KHR_materials_specular/specularColorTexture",
            Row::srgb),
    number(Field::clearcoat, "clearcoat", "extensions/KHR_materials_clearcoat/clearcoatFactor", &Material::clearcoat, 0,
           0, 1),
    texture(Slot::clearcoat, "clearcoat texture", "extensions/KHR_materials_clearcoat/clearcoatTexture"),
    number(Field::clearcoat_roughness, "clearcoat roughness",
           "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", &Material::clearcoat_roughness, 0, 0, 1),
    texture(Slot::clearcoat_roughness, "clearcoat roughness texture",
            "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture"),
    texture(Slot::clearcoat_normal, "clearcoat normal map", "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
            Row::bends_coat),
    number(Field::clearcoat_normal_scale, "clearcoat normal scale",
           "extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", &Material::clearcoat_normal_scale, 1,
           -kCeiling, kCeiling, Row::bends_coat),
    color(Field::sheen_color, "sheen colour", "extensions/KHR_materials_sheen/sheenColorFactor", &Material::sheen_color,
          0, 1),
    texture(Slot::sheen_color, "sheen colour texture", "extensions/KHR_materials_sheen/sheenColorTexture", Row::srgb),
    number(Field::sheen_roughness, "sheen roughness", "extensions/KHR_materials_sheen/sheenRoughnessFactor",
           &Material::sheen_roughness, 0, 0, 1),
    texture(Slot::sheen_roughness, "sheen roughness texture", "extensions/KHR_materials_sheen/sheenRoughnessTexture"),
    number(Field::anisotropy, "anisotropy", "extensions/KHR_materials_anisotropy/anisotropyStrength",
           &Material::anisotropy, 0, 0, 1),
    number(Field::anisotropy_rotation, "anisotropy rotation", "extensions/KHR_materials_anisotropy/anisotropyRotation",
           &Material::anisotropy_rotation, 0, -kCeiling, kCeiling, Row::angle),
    texture(Slot::anisotropy, "anisotropy texture", "extensions/KHR_materials_anisotropy/anisotropyTexture"),
    number(Field::iridescence, "iridescence", "extensions/KHR_materials_iridescence/iridescenceFactor",
           &Material::iridescence, 0, 0, 1),
    texture(Slot::iridescence, "iridescence texture", "extensions/KHR_materials_iridescence/iridescenceTexture"),
    number(Field::iridescence_ior, "index of the iridescent film",
           "extensions/KHR_materials_iridescence/iridescenceIor", &Material::iridescence_ior, 1.3, 1, kCeiling),
    number(Field::iridescence_minimum, "smallest film thickness",
           "extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", &Material::iridescence_minimum, 100, 0,
           kCeiling),
    number(Field::iridescence_maximum, "film thickness",
           "extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", &Material::iridescence_maximum, 400, 0,
           kCeiling),
    texture(Slot::iridescence_thickness, "iridescence thickness texture",
            "extensions/KHR_materials_iridescence/iridescenceThicknessTexture"),
    number(Field::emissive_strength, "emissive strength", "extensions/KHR_materials_emissive_strength/emissiveStrength",
           &Material::emissive_strength, 1, 0, kCeiling),

    choice(Field::model, "illumination model", "extras/relook/model", &Material::model, kModels),
    color(Field::phong_ambient, "ambient coefficient", "extras/relook/ambient", &Material::phong_ambient, 1,
          kOwnCeiling),
    color(Field::phong_diffuse, "diffuse coefficient", "extras/relook/diffuse", &Material::phong_diffuse, 1,
          kOwnCeiling),
    color(Field::phong_specular, "specular coefficient", "extras/relook/specular", &Material::phong_specular, 0.5,
          kOwnCeiling),
    number(Field::shininess, "shininess", "extras/relook/shininess", &Material::shininess, 32, 0, kOwnCeiling),
    number(Field::reflection, "reflection", "extras/relook/reflection", &Material::reflection, 0, 0, 1),
    number(Field::refraction, "refraction", "extras/relook/refraction", &Material::refraction, 0, 0, 1),
    number(Field::transparency, "transparency", "extras/relook/transparency", &Material::transparency, 0, 0, 1),
});

/// Where the row of each field and slot is, by its bit. Does not compile unless each has exactly one.
constexpr auto kPlaces = [] {
  std::array<std::uint8_t, kRows.size()> places{};
  std::array<bool, kRows.size()> found{};
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    const unsigned bit = kRows[i].bit;
    if (found.at(bit)) throw "a field has two rows";
    found[bit] = true;
    places[bit] = static_cast<std::uint8_t>(i);
  }
  return places;
}();
static_assert(kRows.size() == kFirstSlotColor, "each field and each slot has a row");

/// What differs between the contents of a slot.
FieldMask changed_slot(const TextureSlot& a, const TextureSlot& b, Slot slot) {
  if (a == b) return 0;
  FieldMask mask = 0;
  if (a.mapping != b.mapping || a.axis != b.axis || a.texcoord != b.texcoord) mask |= kMappingMask;
  if (a.procedural.color1 != b.procedural.color1 || a.procedural.color2 != b.procedural.color2)
    mask |= color_mask_of(slot);
  TextureSlot same = a;
  same.mapping = b.mapping;
  same.axis = b.axis;
  same.texcoord = b.texcoord;
  same.procedural.color1 = b.procedural.color1;
  same.procedural.color2 = b.procedural.color2;
  if (same != b) mask |= mask_of(slot);
  return mask;
}

}  // namespace

std::span<const MaterialRow> material_rows() { return kRows; }

bool differs(const MaterialRow& row, const Material& a, const Material& b) {
  return std::visit(
      [&](const auto member) {
        if constexpr (std::is_same_v<decltype(member), const Slot>)
          return a.slot(member) != b.slot(member);
        else
          return a.*member != b.*member;
      },
      row.member);
}

bool differs(MaterialRow::Trait trait, const Material& a, const Material& b, std::span<const MaterialRow> rows) {
  return std::ranges::any_of(rows, [&](const MaterialRow& row) {
    if (!row.has(trait)) return false;
    const auto* color = std::get_if<Rgba Material::*>(&row.member);
    if (trait == MaterialRow::cuts && color != nullptr) return (a.*(*color)).a != (b.*(*color)).a;
    return differs(row, a, b);
  });
}

FieldMask changed_fields(const Material& a, const Material& b, std::span<const MaterialRow> rows) {
  FieldMask mask = 0;
  for (const MaterialRow& row : rows) {
    if (row.has(MaterialRow::unread)) continue;
    if (const Slot* slot = row.slot())
      mask |= changed_slot(a.slot(*slot), b.slot(*slot), *slot);
    else if (differs(row, a, b))
      mask |= FieldMask{1} << row.bit;
  }
  return mask;
}

float field_value(const Material& material, const MaterialRow& row, unsigned component) {
  const auto of = [&](const auto& color) { return color[static_cast<int>(component)]; };
  if (const auto* color = std::get_if<Color Material::*>(&row.member)) return of(material.*(*color));
  if (const auto* color = std::get_if<Rgba Material::*>(&row.member)) return of(material.*(*color));
  const auto* number = std::get_if<float Material::*>(&row.member);
  if (number == nullptr) return 0;
  if (!row.has(MaterialRow::angle)) return material.*(*number);
  const double angle = material.*(*number);
  return static_cast<float>(component == 0 ? std::cos(angle) : std::sin(angle));
}

float field_value(const Material& material, Field field, unsigned component) {
  return field_value(material, kRows[kPlaces[static_cast<std::size_t>(field)]], component);
}

}  // namespace relook
