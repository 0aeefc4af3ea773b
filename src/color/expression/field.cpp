#include "color/expression/field.h"

#include <cmath>
#include <limits>

namespace relook {
namespace {

FieldMask changed_fields(const TextureSlot& a, const TextureSlot& b, Slot slot) {
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

FieldMask changed_fields(const Material& a, const Material& b) {
  FieldMask mask = 0;
  const auto note = [&](Field field, bool differs) { mask |= differs ? mask_of(field) : 0; };
  note(Field::model, a.model != b.model);
  note(Field::alpha_mode, a.alpha_mode != b.alpha_mode);
  note(Field::base_color, a.base_color != b.base_color);
  note(Field::metallic, a.metallic != b.metallic);
  note(Field::roughness, a.roughness != b.roughness);
  note(Field::normal_scale, a.normal_scale != b.normal_scale);
  note(Field::occlusion_strength, a.occlusion_strength != b.occlusion_strength);
  note(Field::emissive, a.emissive != b.emissive);
  note(Field::emissive_strength, a.emissive_strength != b.emissive_strength);
  note(Field::ior, a.ior != b.ior);
  note(Field::dispersion, a.dispersion != b.dispersion);
  note(Field::transmission, a.transmission != b.transmission);
  note(Field::thickness, a.thickness != b.thickness);
  note(Field::attenuation_distance, a.attenuation_distance != b.attenuation_distance);
  note(Field::attenuation_color, a.attenuation_color != b.attenuation_color);
  note(Field::specular, a.specular != b.specular);
  note(Field::specular_color, a.specular_color != b.specular_color);
  note(Field::clearcoat, a.clearcoat != b.clearcoat);
  note(Field::clearcoat_roughness, a.clearcoat_roughness != b.clearcoat_roughness);
  note(Field::clearcoat_normal_scale, a.clearcoat_normal_scale != b.clearcoat_normal_scale);
  note(Field::sheen_color, a.sheen_color != b.sheen_color);
  note(Field::sheen_roughness, a.sheen_roughness != b.sheen_roughness);
  note(Field::anisotropy, a.anisotropy != b.anisotropy);
  note(Field::anisotropy_rotation, a.anisotropy_rotation != b.anisotropy_rotation);
  note(Field::iridescence, a.iridescence != b.iridescence);
  note(Field::iridescence_ior, a.iridescence_ior != b.iridescence_ior);
  note(Field::iridescence_minimum, a.iridescence_minimum != b.iridescence_minimum);
  note(Field::iridescence_maximum, a.iridescence_maximum != b.iridescence_maximum);
  note(Field::phong_ambient, a.phong_ambient != b.phong_ambient);
  note(Field::phong_diffuse, a.phong_diffuse != b.phong_diffuse);
  note(Field::phong_specular, a.phong_specular != b.phong_specular);
  note(Field::shininess, a.shininess != b.shininess);
  note(Field::reflection, a.reflection != b.reflection);
  note(Field::refraction, a.refraction != b.refraction);
  note(Field::transparency, a.transparency != b.transparency);
  for (std::size_t s = 0; s < kSlotCount; ++s) mask |= changed_fields(a.slots[s], b.slots[s], static_cast<Slot>(s));
  return mask;
}

float field_value(const Material& m, Field field, unsigned component) {
  const auto of = [&](const auto& vector) { return vector[static_cast<int>(component)]; };
  switch (field) {
    case Field::base_color:
      return of(m.base_color);
    case Field::metallic:
      return m.metallic;
    case Field::roughness:
      return m.roughness;
    case Field::normal_scale:
      return m.normal_scale;
    case Field::occlusion_strength:
      return m.occlusion_strength;
    case Field::emissive:
      return of(m.emissive);
    case Field::emissive_strength:
      return m.emissive_strength;
    case Field::ior:
      return m.ior;
    case Field::dispersion:
      return m.dispersion;
    case Field::transmission:
      return m.transmission;
    case Field::thickness:
      return m.thickness;
    case Field::attenuation_distance:
      return m.attenuation_distance;
    case Field::attenuation_color:
      return of(m.attenuation_color);
    case Field::specular:
      return m.specular;
    case Field::specular_color:
      return of(m.specular_color);
    case Field::clearcoat:
      return m.clearcoat;
    case Field::clearcoat_roughness:
      return m.clearcoat_roughness;
    case Field::clearcoat_normal_scale:
      return m.clearcoat_normal_scale;
    case Field::sheen_color:
      return of(m.sheen_color);
    case Field::sheen_roughness:
      return m.sheen_roughness;
    case Field::anisotropy:
      return m.anisotropy;
    case Field::anisotropy_rotation: {
      const double angle = m.anisotropy_rotation;
      return static_cast<float>(component == 0 ? std::cos(angle) : std::sin(angle));
    }
    case Field::iridescence:
      return m.iridescence;
    case Field::iridescence_ior:
      return m.iridescence_ior;
    case Field::iridescence_minimum:
      return m.iridescence_minimum;
    case Field::iridescence_maximum:
      return m.iridescence_maximum;
    case Field::phong_ambient:
      return of(m.phong_ambient);
    case Field::phong_diffuse:
      return of(m.phong_diffuse);
    case Field::phong_specular:
      return of(m.phong_specular);
    case Field::shininess:
      return m.shininess;
    case Field::reflection:
      return m.reflection;
    case Field::refraction:
      return m.refraction;
    case Field::transparency:
      return m.transparency;
    case Field::model:
    case Field::alpha_mode:
    case Field::count:
      break;
  }
  return 0;
}

float slot_color(const TextureSlot& slot, unsigned component) {
  const Procedural& texture = slot.procedural;
  return component < 3 ? texture.color1[static_cast<int>(component)] : texture.color2[static_cast<int>(component - 3)];
}

float field_value(const Light& light, LightField field) {
  switch (field) {
    case LightField::red:
      return light.color.x;
    case LightField::green:
      return light.color.y;
    case LightField::blue:
      return light.color.z;
    case LightField::intensity:
      return light.intensity;
    case LightField::inverse_range:
      return std::isinf(light.range) ? 0.0F : 1.0F / light.range;
    case LightField::outer_versine: {
      const double half = std::sin(0.5 * double{light.outer_cone});
      return static_cast<float>(2 * half * half);
    }
    case LightField::inverse_cone_width: {
      const double inner = double{light.inner_cone}, outer = double{light.outer_cone};
      const double width = 2 * std::sin(0.5 * (outer + inner)) * std::sin(0.5 * (outer - inner));
      constexpr double kMost = std::numeric_limits<float>::max();
      return static_cast<float>(width > 1 / kMost ? 1 / width : kMost);
    }
    case LightField::x:
      return light.position.x;
    case LightField::y:
      return light.position.y;
    case LightField::z:
      return light.position.z;
    case LightField::dx:
      return light.direction.x;
    case LightField::dy:
      return light.direction.y;
    case LightField::dz:
      return light.direction.z;
  }
  return 0;
}

}  // namespace relook
