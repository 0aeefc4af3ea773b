// A sheen layer over the base layer (KHR_materials_sheen): physics/sheen.h's lobe about the base layer's normal.
#pragma once
#include "color/surface/surface_terms.h"

namespace relook {

class SheenLayer {
 public:
  /// `normal`, `nv`: the base layer's, and its cosine with the view.
  SheenLayer(SurfaceTerms& terms, const Triple& normal, Scalar nv);

  /// The value of the lobe times NL, for light from a lamp at `direction`.
  [[nodiscard]] Triple reflected(const Triple& direction);
  /// What the layer leaves of the light from below.
  [[nodiscard]] Scalar passed();

 private:
  Triple color_;
  Scalar roughness_;
  Triple normal_, view_;
  Scalar nv_;
};

}  // namespace relook
