// Which rays a hit on a surface spawns, and whether light passes through: the part of a material that decides the shape
// of ray trees. A pure function of the material and the mesh, never of the hit, so that "optical" (Table 1) can be told
// from values: an edit is optical exactly when this, or what bends the spawned rays, changes. Called for every object
// that rays meet (trace/ray_scene.cpp), and for materials that an edit changes (edit/, replay/).
#pragma once
#include <utility>

#include "scene/material.h"
#include "scene/mesh.h"

namespace relook {

/// Surfaces rougher than this everywhere spawn no mirror ray; below it the mirror weight fades in (SHADING.md).
inline constexpr float kMirrorThreshold = 0.25F;

struct SurfaceOptics {
  bool reflects = false;        // a mirror ray about the shading normal
  bool coat_reflects = false;   // a mirror ray about the clearcoat normal
  bool refracts = false;        // a ray through the surface: bent, or straight when thin-walled
  bool bent = false;            // refracts by Snell's law with `ior`
  bool transparent = false;     // a straight ray weighted by 1 - coverage
  bool volume = false;          // Beer attenuation on the inside
  bool counts_in_cutoff = false;  // the Fresnel terms of its branches count towards the cut-off
  bool passes_light = false;    // shadow segments are tinted, not blocked
  bool cut_out = false;         // alpha MASK: holes in visibility
  bool culls_back = false;      // single-sided: no ray meets its back faces
  float ior = 1;                // 1 unless refracts
  float dispersion = 0;         // 0 unless volume

  [[nodiscard]] bool spawns() const { return reflects || coat_reflects || refracts || transparent; }
  bool operator==(const SurfaceOptics&) const = default;
};

[[nodiscard]] SurfaceOptics surface_optics(const Material& material, const Mesh& mesh);

/// Under Integrator::path: does coverage alone send rays straight on? Blinn-phong's transparency sends them on, too.
[[nodiscard]] inline bool passes_by_coverage(const Material& material) {
  return material.alpha_mode == AlphaMode::blend &&
         !(material.model == IlluminationModel::blinn_phong && material.transparency > 0);
}

/// The lobes that a material has under Integrator::path on its outer side: decided by factors, never by a texel. Sheen
/// goes with the diffuse one; the power lobe of blinn-phong is `coat`.
struct MaterialLobes {
  bool diffuse = false, specular = false, coat = false;
  bool transmission = false;  // of what is let through, where the surface `blurs`
  bool operator==(const MaterialLobes&) const = default;
};
[[nodiscard]] MaterialLobes material_lobes(const Material& material);
/// Is what goes through blurred by a roughness that may reach kLeastBlur, so that a lobe stands for it under
/// Integrator::path? Otherwise one ray goes on.
[[nodiscard]] bool blurs(const Material& material);
inline constexpr float kLeastBlur = 0.0625F;
/// Where the index of a volume is next to 1, be it that of red light alone, microfacets bend nothing.
inline constexpr float kLeastBentIor = 1.015625F, kMostBlurredDispersion = 8;

/// Smallest and largest linear value that a slot multiplies its factor by; (1, 1) for an empty slot.
[[nodiscard]] std::pair<Rgba, Rgba> texture_range(const TextureSlot& slot);

}  // namespace relook
