// Directional albedo of the sheen lobe (Charlie distribution, Ashikhmin visibility; KHR_materials_sheen, "albedo
// scaling").
#pragma once

namespace relook {

/// Share of the light from a hemisphere that a white sheen layer sends towards a viewer at cosine `cosine`; at most 1.
/// Bilinear in a 10 x 10 table over (roughness, sqrt(cosine)).
[[nodiscard]] float sheen_albedo(float cosine, float roughness);

}  // namespace relook
