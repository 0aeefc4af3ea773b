// The specular lobe of the base layer: GGX of the material's roughness, or, brushed (KHR_materials_anisotropy), of two
// alphas about a direction of its own.
#pragma once
#include <optional>

#include "color/surface/surface_terms.h"
#include "physics/brushed_ggx.h"
#include "physics/lobe_angles.h"

namespace relook {

class SpecularLobe {
 public:
  SpecularLobe(SurfaceTerms& terms, Scalar roughness);

  /// D V, for the light at `direction`.
  [[nodiscard]] Scalar value(const LobeAngles<Triple>& at, const Triple& direction, const Triple& view,
                             Scalar nv) const;
  /// The same where narrow lobes keep all their light (precise_ggx). `normal`: of the lobe.
  [[nodiscard]] Scalar precise_value(const LobeAngles<Triple>& at, const Triple& normal, const Triple& direction,
                                     const Triple& view, Scalar nv) const;
  /// Of the wider direction: a surface mirrors as far as it is smooth both ways.
  [[nodiscard]] Scalar mirror_roughness() const;

 private:
  [[nodiscard]] Scalar brushed_or(Scalar isotropic, const LobeAngles<Triple>& at, const Triple& direction,
                                  const Triple& view, Scalar nv) const;
  /// Which way the lobe is wider, and by how much.
  struct Brush {
    BrushAxes<Triple> axes;
    Scalar is_there;  // more than 0, unless the mesh gives no tangents
    Scalar strength2;
  };

  Scalar roughness_, alpha2_;
  std::optional<Brush> brush_;
};

}  // namespace relook
