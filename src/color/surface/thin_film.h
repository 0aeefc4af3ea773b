// Reflectance of a surface under a thin film: KHR_materials_iridescence, after Belcour and Barla 2017, "A Practical
// Extension to Microfacet Theory for the Modeling of Varying Iridescence".
#pragma once
#include "color/expression/expression.h"

namespace relook {

/// A film in air.
struct ThinFilm {
  Scalar ior;        // at least 1
  Scalar thickness;  // nanometres
};

/// For unpolarised light at a cosine of incidence; `f0`: of the bare surface in air at normal incidence. Not negative; a
/// channel may lie a little above 1, since colours of one wavelength lie outside Rec.709.
[[nodiscard]] Triple film_fresnel(const ThinFilm& film, const Triple& f0, Scalar cosine);

}  // namespace relook
