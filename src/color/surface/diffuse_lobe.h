// The diffuse lobe of the base layer: light that the surface neither reflects nor lets through, scattered evenly.
#pragma once
#include "color/expression/expression.h"
#include "physics/lambert.h"

namespace relook {

struct DiffuseLobe {
  Triple base;
  Scalar metallic, transmission;

  /// `entered`: the share of the light that a dielectric does not reflect.
  [[nodiscard]] Triple albedo(Scalar entered) const { return base * share(entered); }
  [[nodiscard]] Triple value(Scalar entered) const { return base * lambert(share(entered)); }

 private:
  [[nodiscard]] Scalar share(Scalar entered) const { return (1.0F - metallic) * (1.0F - transmission) * entered; }
};

}  // namespace relook
