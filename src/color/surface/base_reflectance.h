// What the base layer reflects: the reflectances of a dielectric (KHR_materials_ior, KHR_materials_specular) and of a
// metal, either under a thin film (KHR_materials_iridescence). Used by its lobes at V.H, by its mirror at N.V.
#pragma once
#include <optional>

#include "color/surface/surface_terms.h"
#include "physics/thin_film.h"

namespace relook {

class BaseReflectance {
 public:
  BaseReflectance(SurfaceTerms& terms, const Triple& base, Scalar metallic);

  /// `weight`: between f0 and f90; `cosine`: of incidence.
  [[nodiscard]] Triple dielectric(Scalar weight, Scalar cosine);
  /// Dielectric and metal, mixed. `dielectric`: what the function above gives for the same weight and cosine.
  [[nodiscard]] Triple mixed(const Triple& dielectric, Scalar weight, Scalar cosine);
  /// What a dielectric does not reflect.
  [[nodiscard]] Scalar entered(const Triple& dielectric) const;

 private:
  [[nodiscard]] Triple dielectric_f0();
  [[nodiscard]] ThinFilm<Scalar> film();
  /// As much of the film over a bare surface as iridescence says.
  [[nodiscard]] Triple filmed(const Triple& bare, const Triple& f0, Scalar cosine);

  SurfaceTerms& t_;
  Triple base_;
  Scalar metallic_, specular_;
  Triple f0_;
  std::optional<ThinFilm<Scalar>> film_;
};

}  // namespace relook
