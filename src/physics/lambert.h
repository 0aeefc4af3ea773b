// The diffuse lobe (glTF 2.0, appendix B.3.1): light that is scattered evenly.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// Its value, for the share of light that it scatters: a scalar or a colour.
template <class C>
[[nodiscard]] C lambert(const C& albedo) {
  return albedo * kInversePi;
}

}  // namespace relook
