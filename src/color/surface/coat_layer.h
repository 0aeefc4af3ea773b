// A clearcoat over everything, emission included (KHR_materials_clearcoat): a GGX lobe and a mirror of its own normal.
#pragma once
#include "color/surface/surface_terms.h"

namespace relook {

class CoatLayer {
 public:
  explicit CoatLayer(SurfaceTerms& terms);

  /// The value of the lobe times NL, for light from a lamp at `direction`.
  [[nodiscard]] Triple reflected(const Triple& direction);
  /// What the layer leaves of the light from below.
  [[nodiscard]] Scalar passed();
  /// What the coat's ray brings.
  [[nodiscard]] Triple mirror();

 private:
  SurfaceTerms& t_;
  Scalar strength_, roughness_;
  Triple normal_, view_;
  Scalar nv_, fresnel_;
};

}  // namespace relook
