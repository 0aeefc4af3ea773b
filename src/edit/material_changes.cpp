#include "edit/material_changes.h"

#include <cstdio>

#include "scene/surface_optics.h"

namespace relook {
namespace {

std::string text_of_value(float x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%g", static_cast<double>(x));
  return digits;
}
std::string text_of_value(const Color& c) {
  return "(" + text_of_value(c.x) + ", " + text_of_value(c.y) + ", " + text_of_value(c.z) + ")";
}
std::string text_of_value(const Rgba& c) {
  return "(" + text_of_value(c.r) + ", " + text_of_value(c.g) + ", " + text_of_value(c.b) + ", " + text_of_value(c.a) +
         ")";
}
std::string text_of_value(const std::string& text) { return text; }
std::string text_of_value(bool flag) { return flag ? "yes" : "no"; }
std::string text_of_value(AlphaMode mode) {
  return mode == AlphaMode::opaque ? "OPAQUE" : mode == AlphaMode::mask ? "MASK" : "BLEND";
}
std::string text_of_value(IlluminationModel model) {
  return model == IlluminationModel::unlit         ? "unlit"
         : model == IlluminationModel::blinn_phong ? "blinn-phong"
                                                   : "metallic-roughness";
}

/// A list of "what before -> after".
class Sentence {
 public:
  template <class Value>
  void compare(std::string_view what, const Value& before, const Value& after) {
    if (before != after) add(std::string(what) + " " + text_of_value(before) + " -> " + text_of_value(after));
  }
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  [[nodiscard]] std::string text() const { return text_; }

 private:
  std::string text_;
};

constexpr std::array<std::string_view, kSlotCount> kSlotNames{"base colour texture",
                                                              "metallic-roughness texture",
                                                              "normal map",
                                                              "occlusion texture",
                                                              "emissive texture",
                                                              "transmission texture",
                                                              "thickness texture",
                                                              "specular texture",
                                                              "specular colour texture",
                                                              "clearcoat texture",
                                                              "clearcoat roughness texture",
                                                              "clearcoat normal map",
                                                              "sheen colour texture",
                                                              "sheen roughness texture",
                                                              "anisotropy texture",
                                                              "iridescence texture",
                                                              "iridescence thickness texture"};

std::string describe_slot(const TextureSlot& before, const TextureSlot& after) {
  if (before.kind == TextureKind::none) return "added";
  if (after.kind == TextureKind::none) return "removed";
  if (before.kind != after.kind || before.pyramid != after.pyramid) return "replaced";
  if (before.procedural != after.procedural) return "parameters changed";
  if (before.mapping != after.mapping || before.axis != after.axis || before.texcoord != after.texcoord)
    return "mapped otherwise";
  return "transformed";
}

bool slot_differs(const Material& a, const Material& b, Slot slot) { return a.slot(slot) != b.slot(slot); }

/// Holes of a cut-out surface.
bool cut_out_changes(const Material& before, const Material& after) {
  const bool was = before.alpha_mode == AlphaMode::mask, is = after.alpha_mode == AlphaMode::mask;
  if (!was && !is) return false;
  return was != is || before.alpha_cutoff != after.alpha_cutoff || before.base_color.a != after.base_color.a ||
         slot_differs(before, after, Slot::base_color);
}

bool bends_normals_otherwise(const Material& before, const Material& after, const SurfaceOptics& optics) {
  const bool normal = slot_differs(before, after, Slot::normal) || before.normal_scale != after.normal_scale;
  const bool coat = slot_differs(before, after, Slot::clearcoat_normal) ||
                    before.clearcoat_normal_scale != after.clearcoat_normal_scale;
  return (normal && optics.spawns()) || (coat && optics.coat_reflects);
}

}  // namespace

ChangeClass material_change_class(const Material& before, const Material& after, const Mesh& mesh) {
  if (cut_out_changes(before, after)) return ChangeClass::geometric;
  const SurfaceOptics optics = surface_optics(after, mesh), optics_before = surface_optics(before, mesh);
  if (optics_before.culls_back != optics.culls_back) return ChangeClass::geometric;
  if (optics_before != optics || bends_normals_otherwise(before, after, optics)) return ChangeClass::optical;
  return ChangeClass::color;
}

std::string describe_values(const Color& before, const Color& after) {
  return text_of_value(before) + " -> " + text_of_value(after);
}

std::string describe_material_change(const Material& before, const Material& after) {
  Sentence s;
  s.compare("illumination model", before.model, after.model);
  s.compare("alpha mode", before.alpha_mode, after.alpha_mode);
  s.compare("alpha cutoff", before.alpha_cutoff, after.alpha_cutoff);
  s.compare("double-sided", before.double_sided, after.double_sided);
  s.compare("base colour", before.base_color, after.base_color);
  s.compare("metallic", before.metallic, after.metallic);
  s.compare("roughness", before.roughness, after.roughness);
  s.compare("normal scale", before.normal_scale, after.normal_scale);
  s.compare("occlusion strength", before.occlusion_strength, after.occlusion_strength);
  s.compare("emissive", before.emissive, after.emissive);
  s.compare("emissive strength", before.emissive_strength, after.emissive_strength);
  s.compare("index of refraction", before.ior, after.ior);
  s.compare("dispersion", before.dispersion, after.dispersion);
  s.compare("transmission", before.transmission, after.transmission);
  s.compare("thickness", before.thickness, after.thickness);
  s.compare("attenuation distance", before.attenuation_distance, after.attenuation_distance);
  s.compare("attenuation colour", before.attenuation_color, after.attenuation_color);
  s.compare("specular", before.specular, after.specular);
  s.compare("specular colour", before.specular_color, after.specular_color);
  s.compare("clearcoat", before.clearcoat, after.clearcoat);
  s.compare("clearcoat roughness", before.clearcoat_roughness, after.clearcoat_roughness);
  s.compare("clearcoat normal scale", before.clearcoat_normal_scale, after.clearcoat_normal_scale);
  s.compare("sheen colour", before.sheen_color, after.sheen_color);
  s.compare("sheen roughness", before.sheen_roughness, after.sheen_roughness);
  s.compare("anisotropy", before.anisotropy, after.anisotropy);
  s.compare("anisotropy rotation", before.anisotropy_rotation, after.anisotropy_rotation);
  s.compare("iridescence", before.iridescence, after.iridescence);
  s.compare("index of the iridescent film", before.iridescence_ior, after.iridescence_ior);
  s.compare("smallest film thickness", before.iridescence_minimum, after.iridescence_minimum);
  s.compare("film thickness", before.iridescence_maximum, after.iridescence_maximum);
  s.compare("ambient coefficient", before.phong_ambient, after.phong_ambient);
  s.compare("diffuse coefficient", before.phong_diffuse, after.phong_diffuse);
  s.compare("specular coefficient", before.phong_specular, after.phong_specular);
  s.compare("shininess", before.shininess, after.shininess);
  s.compare("reflection", before.reflection, after.reflection);
  s.compare("refraction", before.refraction, after.refraction);
  s.compare("transparency", before.transparency, after.transparency);
  for (std::size_t i = 0; i < kSlotCount; ++i)
    if (before.slots[i] != after.slots[i])
      s.add(std::string(kSlotNames[i]) + " " + describe_slot(before.slots[i], after.slots[i]));
  return s.text();
}

std::string describe_light_change(const Light& before, const Light& after) {
  Sentence s;
  s.compare("light", before.light, after.light);
  s.compare("colour", before.color, after.color);
  s.compare("intensity", before.intensity, after.intensity);
  s.compare("range", before.range, after.range);
  s.compare("inner cone", before.inner_cone, after.inner_cone);
  s.compare("outer cone", before.outer_cone, after.outer_cone);
  return s.text();
}

std::string describe_environment_change(const Environment& before, const Environment& after) {
  Sentence s;
  s.compare("colour", before.color, after.color);
  s.compare("intensity", before.intensity, after.intensity);
  s.compare("rotation", before.rotation, after.rotation);
  if (before.image != after.image)
    s.add(before.image == nullptr ? "image added" : after.image == nullptr ? "image removed" : "image replaced");
  return s.text();
}

}  // namespace relook
