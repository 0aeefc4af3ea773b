// Whether a change of a material may turn the rays that leave it under Integrator::path. Those follow from what lobes
// there are and from buckets of roughness, metallic and coverage, which are looked up per hit; here only a factor times
// the extremes of its texture is known, so the answer is an upper bound: the work that is done follows the hits.
#pragma once
#include "scene/material_fields.h"
#include "scene/mesh.h"

namespace relook {

/// True unless every ray that leaves by a lobe is sure to leave as before.
[[nodiscard]] bool turns_lobes(const Material& before, const Material& after,
                               std::span<const MaterialRow> rows = material_rows());

/// True unless every ray that meets the material on this mesh is sure to stop, or to pass by its coverage, as before.
[[nodiscard]] bool turns_coverage(const Material& before, const Material& after, const Mesh& mesh);

}  // namespace relook
