// A hit as the path oracle sees it, and what its lobes make of light. Inside tests/oracle.
#pragma once
#include "path_reference.h"

namespace relook {

struct PathReference::Surface {
  const Object* object;
  const Material* material;
  SurfaceOptics optics;
  bool inside;
  Vec p, ng, n, view;
  Vec lift;  // to the smooth surface, as segments leave it at the horizon
  double nv, alpha, coat_alpha;
  double blur_alpha;  // of what is let through: as the material says

  [[nodiscard]] bool is_interface() const { return optics.volume && inside; }
  [[nodiscard]] Vec base() const { return {material->base_color.r, material->base_color.g, material->base_color.b}; }
  [[nodiscard]] double coverage() const {
    return material->alpha_mode == AlphaMode::blend ? material->base_color.a : 1.0F;
  }
  [[nodiscard]] double coat() const { return inside ? 0 : material->clearcoat; }

  /// Of the dielectric, at a cosine from this side.
  [[nodiscard]] Vec dielectric(double cosine) const;
  /// Of dielectric and metal.
  [[nodiscard]] Vec reflectance(double cosine) const;
  /// What of light from below is not reflected towards the eye, by the dielectric and by the coat.
  [[nodiscard]] double entered() const;
  [[nodiscard]] double below_coat() const;

  /// Of a light at `way`, times the cosine there; the coat's is its alone, the others' come from below it.
  [[nodiscard]] Vec diffuse(const Vec& way) const;
  [[nodiscard]] Vec specular(const Vec& way) const;
  [[nodiscard]] Vec coating(const Vec& way) const;
  /// Is what goes through scattered? Of light from the other side, then, likewise.
  [[nodiscard]] bool blurs() const;
  [[nodiscard]] Vec through(const Vec& way) const;
  /// Index behind over index in front.
  [[nodiscard]] double eta() const { return inside ? 1.0 / optics.ior : double{optics.ior}; }

  [[nodiscard]] static bool is_wide(double alpha) { return alpha >= 0.25; }
  /// What a segment along a way meets of it as a filter.
  [[nodiscard]] Vec tint(double inside_length) const;
};

/// Exact, of unpolarised light; `eta`: index behind over index in front.
[[nodiscard]] double exact_reflectance(double cosine, double eta);
/// A unit vector at an angle from `axis`.
[[nodiscard]] Vec tilted(const Vec& axis, double cosine, double turn);

}  // namespace relook
