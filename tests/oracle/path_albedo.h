// Directional albedos of the lobes that src/color/PATH.md names, by quadrature in doubles: a cosine with the view and a
// roughness in, the share of a furnace's light that comes to the eye out. Each formula stands here once more.
#pragma once
#include <functional>

namespace relook {

/// Reflectance by the cosine of incidence.
using Reflectance = std::function<double(double)>;

/// Schlick's, from f0 to 1.
[[nodiscard]] double schlick_reflectance(double f0, double cosine);
/// Of light that meets a body of index `ior` from outside, unpolarised.
[[nodiscard]] double fresnel_reflectance(double ior, double cosine);

/// Of one scattering at GGX microfacets of a roughness of at least 0.05: what masking takes does not come back.
[[nodiscard]] double ggx_albedo(double nv, double roughness, const Reflectance& reflectance);
/// Of light that one scattering at such microfacets of a body lets through: `eta` is the index behind over that in front.
[[nodiscard]] double rough_transmittance(double nv, double roughness, double eta);
/// Of Blinn and Phong's lobe, (n + 8) / (8 pi) (N.H)^n.
[[nodiscard]] double power_albedo(double nv, double shininess);
/// Of a white sheen.
[[nodiscard]] double cloth_albedo(double nv, double roughness);

}  // namespace relook
