// The base layer of metallic-roughness: a diffuse and a specular lobe, ambient light, and the rays that it mirrors and
// lets through (KHR_materials_transmission, KHR_materials_volume).
#pragma once
#include "color/surface/base_reflectance.h"
#include "color/surface/diffuse_lobe.h"
#include "color/surface/specular_lobe.h"
#include "color/surface/surface_terms.h"

namespace relook {

class BaseLayer {
 public:
  explicit BaseLayer(SurfaceTerms& terms);

  [[nodiscard]] const Triple& normal() const { return normal_; }
  /// Cosine of the normal with the view.
  [[nodiscard]] Scalar nv() const { return nv_; }

  /// The value of both lobes times NL, for light from a lamp at `direction`.
  [[nodiscard]] Triple reflected(const Triple& direction);
  /// Ambient light, mirror and transmission: what depends on the view alone.
  [[nodiscard]] Triple view_terms();

 private:
  [[nodiscard]] bool may_transmit() { return t_.builder().shape(Field::transmission).transmits; }
  [[nodiscard]] Scalar transmission() {
    return may_transmit() ? t_.textured(Field::transmission, Slot::transmission, 0) : t_.number(0);
  }
  /// From the inside, light leaves where the triangle or its vertex normals let it.
  [[nodiscard]] Scalar interface_cosine() {
    return t_.key().inside ? max(nv_, dot(t_.input3(Input::geometric), view_)) : nv_;
  }
  [[nodiscard]] Scalar child_length(Branch branch) {
    return t_.input(Input::child_length, 0, static_cast<std::uint32_t>(branch));
  }

  SurfaceTerms& t_;
  Triple base_;
  Scalar metallic_;
  Triple normal_, view_;
  Scalar nv_;
  SpecularLobe specular_;
  DiffuseLobe diffuse_;
  BaseReflectance reflectance_;
};

}  // namespace relook
