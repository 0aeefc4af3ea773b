// Whether a change of a material may turn the rays that its lobes send under Integrator::path. Those follow from what
// lobes there are and from buckets of roughness and metallic, which are looked up per hit; here only a factor times the
// extremes of its texture is known, so the answer is an upper bound: the work that is done follows the hits.
#pragma once
#include "scene/material_fields.h"

namespace relook {

/// True unless every ray that leaves by a lobe is sure to leave as before.
[[nodiscard]] bool turns_lobes(const Material& before, const Material& after,
                               std::span<const MaterialRow> rows = material_rows());

}  // namespace relook
