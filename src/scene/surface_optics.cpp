#include "scene/surface_optics.h"

#include <algorithm>

namespace relook {
namespace {

bool lets_light_past(const Material& m, const Mesh& mesh) {
  if (m.alpha_mode != AlphaMode::blend) return false;
  return m.base_color.a * texture_range(m.slot(Slot::base_color)).first.a * mesh.min_alpha < 1;
}

SurfaceOptics metallic_roughness_optics(const Material& m) {
  const auto [rough_min, rough_max] = texture_range(m.slot(Slot::metallic_roughness));
  SurfaceOptics optics;
  const bool has_metal = m.metallic * rough_max.b > 0;
  const bool has_dielectric = m.metallic * rough_min.b < 1;
  const bool has_specular = m.specular * texture_range(m.slot(Slot::specular)).second.a > 0;
  // A film reflects where the surface below it does not.
  const bool has_film = m.iridescence * texture_range(m.slot(Slot::iridescence)).second.r > 0;
  optics.reflects = m.roughness * rough_min.g < kMirrorThreshold && (has_metal || has_specular || has_film);
  optics.coat_reflects =
      m.clearcoat * texture_range(m.slot(Slot::clearcoat)).second.r > 0 &&
      m.clearcoat_roughness * texture_range(m.slot(Slot::clearcoat_roughness)).first.g < kMirrorThreshold;
  optics.refracts = m.transmission * texture_range(m.slot(Slot::transmission)).second.r > 0 && has_dielectric;
  optics.volume = optics.refracts && m.thickness > 0;
  optics.bent = optics.volume;
  // An ior of 0, which rays take for 1, and a specular colour above 1 reflect where the ior says that nothing is.
  const Color tint = m.specular_color;
  const bool is_bright = m.ior < 1 || std::max({tint.x, tint.y, tint.z}) > 1;
  optics.counts_in_cutoff = optics.refracts && !has_metal && !has_film && !is_bright;
  return optics;
}

SurfaceOptics blinn_phong_optics(const Material& m) {
  SurfaceOptics optics;
  optics.reflects = m.reflection > 0;
  optics.refracts = m.refraction > 0;
  optics.bent = optics.refracts;
  optics.transparent = m.transparency > 0;
  return optics;
}

}  // namespace

std::pair<Rgba, Rgba> texture_range(const TextureSlot& slot) {
  switch (slot.kind) {
    case TextureKind::image:
      return {slot.pyramid->smallest, slot.pyramid->largest};
    case TextureKind::procedural: {
      const Color a = slot.procedural.color1, b = slot.procedural.color2;
      return {Rgba(std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z), 1),
              Rgba(std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z), 1)};
    }
    case TextureKind::none:
      break;
  }
  return {Rgba(1, 1, 1, 1), Rgba(1, 1, 1, 1)};
}

SurfaceOptics surface_optics(const Material& material, const Mesh& mesh) {
  SurfaceOptics optics;
  if (material.model == IlluminationModel::metallic_roughness) optics = metallic_roughness_optics(material);
  if (material.model == IlluminationModel::blinn_phong) optics = blinn_phong_optics(material);
  optics.transparent = optics.transparent || lets_light_past(material, mesh);
  optics.cut_out = material.alpha_mode == AlphaMode::mask;
  optics.culls_back = !material.double_sided;
  optics.passes_light = optics.refracts || optics.transparent;
  optics.ior = optics.refracts ? std::max(material.ior, 1.0F) : 1;
  optics.dispersion = optics.volume ? material.dispersion : 0;
  return optics;
}

MaterialLobes material_lobes(const Material& material) {
  if (material.model == IlluminationModel::unlit) return {};
  if (material.model == IlluminationModel::blinn_phong)
    return {.diffuse = material.phong_diffuse != Color(0, 0, 0), .coat = material.phong_specular != Color(0, 0, 0)};
  const auto is_textured = [&](Slot slot) { return material.slot(slot).kind != TextureKind::none; };
  const bool is_metal = material.metallic >= 1 && !is_textured(Slot::metallic_roughness);
  const bool lets_all_through = material.transmission >= 1 && !is_textured(Slot::transmission);
  const bool is_cloth = material.sheen_color != Color(0, 0, 0);
  return {.diffuse = (!is_metal && !lets_all_through) || is_cloth,
          .specular = material.specular > 0 || material.metallic > 0 || material.iridescence > 0,
          .coat = material.clearcoat > 0,
          .transmission = blurs(material)};
}

bool dims_otherwise(const Material& material) {
  if (material.model != IlluminationModel::metallic_roughness) return false;
  return material.clearcoat > 0 || material.sheen_color != Color(0, 0, 0) ||
         material.slot(Slot::normal).kind != TextureKind::none;
}

bool blurs(const Material& material) {
  if (material.model != IlluminationModel::metallic_roughness || !(material.transmission > 0)) return false;
  if (!(material.roughness * texture_range(material.slot(Slot::metallic_roughness)).second.g >= kLeastBlur)) return false;
  return !(material.thickness > 0) || (material.ior >= kLeastBentIor && material.dispersion <= kMostBlurredDispersion);
}

}  // namespace relook
