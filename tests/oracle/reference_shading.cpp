// The oracle's colours: lobes, Fresnel terms and both models as src/color/SHADING.md says under "metallic-roughness"
// and "blinn-phong".
#include <algorithm>
#include <cmath>
#include <optional>

#include "pi.h"
#include "reference_tracer.h"

namespace relook {
namespace {

double positive(double x) { return std::max(x, 0.0); }
double schlick(double cosine) { return std::pow(1 - cosine, 5); }
/// GGX distribution times height-correlated Smith visibility.
double ggx(double nh, double nl, double nv, double alpha) {
  const double a2 = alpha * alpha, d = nh * nh * (a2 - 1) + 1;
  const double smith = nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2);
  return a2 / (kPi * d * d) * 0.5 / smith;
}

double charlie(double nh, double nl, double nv, double roughness) {
  const double alpha = std::pow(std::max(roughness, 0.07), 2), sine = std::sqrt(positive(1 - nh * nh));
  return (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * kPi) / (4 * (nl + nv - nl * nv));
}

/// Unpolarised reflectance at an interface; `eta` = index here / index there.
double fresnel_exact(double cosine, double eta) {
  const double sine2 = eta * eta * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;
  const double beyond = std::sqrt(1 - sine2);
  const double s = (eta * cosine - beyond) / (eta * cosine + beyond);
  const double p = (eta * beyond - cosine) / (eta * beyond + cosine);
  return (s * s + p * p) / 2;
}

/// KHR_materials_iridescence: the sum over the light that crosses the film 0, 1 and 2 times more, each seen through the
/// colour matching functions at its path's length, given as Fourier transforms of Gaussians.
Vec film_reflectance(Vec f0, double film, double nanometres, double cosine) {
  const double below = std::sqrt(1 - (1 - cosine * cosine) / (film * film)), air = std::pow((film - 1) / (film + 1), 2);
  const double r12 = air + (1 - air) * schlick(cosine), path = 2 * film * std::max(nanometres, 0.0) * below;
  Vec reflectance(0, 0, 0), shift(0, 0, 0), strength(0, 0, 0);
  for (int c = 0; c < 3; ++c) {
    const double root = std::sqrt(std::min(f0[c] + 1e-4, 0.9999)), base = (1 + root) / (1 - root);
    const double normal = std::pow((base - film) / (base + film), 2), r23 = normal + (1 - normal) * schlick(below);
    const double both = std::clamp(r12 * r23, 1e-5, 0.9999), inner = std::pow(1 - r12, 2) * r23 / (1 - both);
    reflectance[c] = r12 + inner;
    strength[c] = inner - (1 - r12);
    shift[c] = kPi + (base < film ? kPi : 0);
    f0[c] = std::sqrt(both);  // from here on: what a crossing leaves
  }
  for (int m = 1; m <= 2; ++m) {
    const double phase = 2 * kPi * m * path * 1e-9;
    const auto seen = [&](double value, double position, double variance, double turn) {
      return value * std::sqrt(2 * kPi * variance) * std::cos(position * phase + m * turn) *
             std::exp(-phase * phase * variance) / 1.0685e-7;
    };
    const double x =
        seen(5.4856e-13, 1.6810e6, 4.3278e9, shift.x) + seen(9.7470e-14, 2.2399e6, 4.5282e9, shift.x);
    const double y = seen(4.4201e-13, 1.7953e6, 9.3046e9, shift.y), z = seen(5.2481e-13, 2.2084e6, 6.6121e9, shift.z);
    const Vec rgb(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                  0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
    strength *= f0;
    reflectance += strength * rgb * 2.0;
  }
  return {positive(reflectance.x), positive(reflectance.y), positive(reflectance.z)};
}

double integrated_sheen(double cosine, double roughness) {
  const int steps = 40;
  const Vec view(std::sqrt(1 - cosine * cosine), 0, cosine);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double nl = (i + 0.5) / steps, sine = std::sqrt(1 - nl * nl);
    for (int j = 0; j < steps; ++j) {
      const double phi = (j + 0.5) / steps * 2 * kPi;
      const Vec h = (view + Vec(sine * std::cos(phi), sine * std::sin(phi), nl)).normalized();
      sum += charlie(h.z, nl, cosine, roughness) * nl;
    }
  }
  return std::min(sum / (steps * steps) * 2 * kPi, 1.0);
}
}  // namespace

double sheen_albedo(double cosine, double roughness) {
  const int last = 9;
  const double x = std::sqrt(cosine) * last, y = roughness * last;
  const int column = std::min(static_cast<int>(x), last - 1), row = std::min(static_cast<int>(y), last - 1);
  const auto node = [&](int i, int j) { return integrated_sheen(std::pow(double(i) / last, 2), double(j) / last); };
  const auto along = [&](int j) { return node(column, j) * (column + 1 - x) + node(column + 1, j) * (x - column); };
  return along(row) * (row + 1 - y) + along(row + 1) * (y - row);
}

Vec ReferenceTracer::reflected(const Surface& s, Vec normal) const {
  const Vec way = normal * (2 * normal.dot(s.view)) - s.view;
  const double below = way.dot(s.ng);
  return (below < 0 ? way - s.ng * (2 * below) : way).normalized();
}

Vec ReferenceTracer::beer(const Surface& s, bool runs_inside, const Answer& answer) const {
  Vec color = answer.color;
  if (runs_inside && s.optics.volume && std::isfinite(s.material->attenuation_distance))
    for (int c = 0; c < 3; ++c)
      color[c] *=
          std::pow(double{s.material->attenuation_color[c]}, answer.distance / s.material->attenuation_distance);
  return color;
}

namespace {

/// The refracted direction, unless all light is reflected; `eta` = index here / index there.
std::optional<Vec> refracted(Vec view, Vec normal, double eta) {
  const double cosine = normal.dot(view), sine2 = eta * eta * (1 - cosine * cosine);
  if (sine2 >= 1) return std::nullopt;
  return (normal * (eta * cosine - std::sqrt(1 - sine2)) - view * eta).normalized();
}
double mirror_fade(double roughness) {
  const double t = positive(1 - roughness / kMirrorThreshold);
  return t * t * (3 - 2 * t);
}
}  // namespace

std::optional<Vec> ReferenceTracer::refracted_way(const Surface& s, double ior) {
  const auto bent = refracted(s.view, s.n, s.inside ? ior : 1 / ior);
  return bent || !s.inside ? bent : refracted(s.view, s.ng, ior);
}

double ReferenceTracer::specular_lobe(const Surface& s, Vec toward, double nl, double nv) const {
  const Vec h = (s.view + toward).normalized();
  const double alpha = std::pow(std::max(s.roughness, 0.05), 2), nh = positive(s.n.dot(h));
  const std::optional<Axes> frame = s.material->anisotropy > 0 ? axes(s, Slot::anisotropy) : std::nullopt;
  if (!frame) return ggx(nh, nl, nv, alpha);
  const Imath::V4d texel = texture(s, Slot::anisotropy);
  const bool has_map = s.material->slot(Slot::anisotropy).kind != TextureKind::none;
  const double angle = (has_map ? std::atan2(2 * texel.y - 1, 2 * texel.x - 1) : 0) + s.material->anisotropy_rotation;
  const Vec t = frame->tangent * std::cos(angle) + frame->bitangent * std::sin(angle);
  const Vec b = frame->bitangent * std::cos(angle) - frame->tangent * std::sin(angle);
  const double wide = alpha + (1 - alpha) * std::pow(s.material->anisotropy * texel.z, 2);
  // Burley's distribution, and Smith's shadowing with the roughness in the plane of each direction.
  const double d = 1 / (kPi * wide * alpha *
                        std::pow(std::pow(t.dot(h) / wide, 2) + std::pow(b.dot(h) / alpha, 2) + nh * nh, 2));
  const auto shadow = [&](Vec w, double up) {
    return std::sqrt(1 + (std::pow(wide * t.dot(w), 2) + std::pow(alpha * b.dot(w), 2)) / (up * up)) / 2 - 0.5;
  };
  return d / ((1 + shadow(s.view, nv) + shadow(toward, nl)) * 4 * nl * nv);
}

double ReferenceTracer::mirror_roughness(const Surface& s) const {
  if (s.material->anisotropy == 0 || !axes(s, Slot::anisotropy)) return s.roughness;
  const double strength = s.material->anisotropy * texture(s, Slot::anisotropy).z, alpha = s.roughness * s.roughness;
  return std::sqrt(alpha * (1 - strength * strength) + strength * strength);
}
namespace {
double ior_of(int channel, const SurfaceOptics& optics, double middle) {
  const double half_spread = (middle - 1) * 0.025 * double{optics.dispersion};
  return channel == 0 ? std::max(middle - half_spread, 1.0) : channel == 2 ? middle + half_spread : middle;
}
}  // namespace

Vec ReferenceTracer::metallic_roughness(const Surface& s, const Ray& ray) const {
  if (s.optics.dispersion <= 0 || ray.channel >= 0) return metallic_roughness_of(ray.channel, s, ray);
  Vec color;
  for (int channel = 0; channel < 3; ++channel) color[channel] = metallic_roughness_of(channel, s, ray)[channel];
  return color;
}

Vec ReferenceTracer::metallic_roughness_of(int channel, const Surface& s, const Ray& ray) const {
  const Material& m = *s.material;
  const double ior = ior_of(channel, s.optics, m.ior), nv = std::max(s.n.dot(s.view), 1e-4),
               dielectric = 1 - s.metallic;
  const double r0 = std::pow((ior - 1) / (ior + 1), 2), f90 = m.specular * texture(s, Slot::specular).w;
  const Imath::V4d tint = texture(s, Slot::specular_color);
  Vec f0 = color_of(m.specular_color) * Vec(tint.x, tint.y, tint.z) * r0;
  for (int c = 0; c < 3; ++c) f0[c] = std::min(f0[c], 1.0) * f90;
  const bool interface_only = s.optics.volume && s.inside;
  const double share = interface_only ? 0 : m.iridescence * texture(s, Slot::iridescence).x;
  const double film = m.iridescence_minimum + (double{m.iridescence_maximum} - m.iridescence_minimum) *
                                                  texture(s, Slot::iridescence_thickness).y;
  const auto filmed = [&](Vec bare, Vec normal, double cosine) {
    return share == 0 ? bare : bare * (1 - share) + film_reflectance(normal, m.iridescence_ior, film, cosine) * share;
  };
  const auto fd = [&](double w, double c) { return filmed(f0 + (Vec(f90, f90, f90) - f0) * w, f0, c); };
  const auto fresnel = [&](double w, double c) {
    return fd(w, c) * dielectric + filmed(s.base + (Vec(1, 1, 1) - s.base) * w, s.base, c) * s.metallic;
  };
  const auto reflectance = [&](double n) {
    return fresnel_exact(s.inside ? std::max(nv, s.ng.dot(s.view)) : nv, s.inside ? n : 1 / n);
  };
  const double exact = reflectance(ior);
  double most = exact;  // of the channels that a mirror ray is for
  for (int c = 0; c < 3 && ray.channel < 0; ++c) most = std::max(most, reflectance(ior_of(c, s.optics, m.ior)));
  const double weight = s.optics.volume ? std::clamp((exact - r0) / (1 - r0), 0.0, 1.0) : schlick(nv);
  const double diffuse = dielectric * (1 - s.transmission), fade = mirror_fade(mirror_roughness(s));
  const std::vector<Arriving> lights = interface_only ? std::vector<Arriving>() : lamps(s);

  Vec color(0, 0, 0), coat(0, 0, 0), sheen(0, 0, 0);
  const Imath::V4d sheen_texel = texture(s, Slot::sheen_color);
  const Vec sheen_color = color_of(m.sheen_color) * Vec(sheen_texel.x, sheen_texel.y, sheen_texel.z);
  const double sheen_rough = m.sheen_roughness * texture(s, Slot::sheen_roughness).w;
  const double coat_weight = m.clearcoat * texture(s, Slot::clearcoat).x;
  const double coat_rough = m.clearcoat_roughness * texture(s, Slot::clearcoat_roughness).y;
  const double coat_nv = std::max(s.nc.dot(s.view), 1e-4), coat_fresnel = 0.04 + 0.96 * schlick(coat_nv);
  for (const auto& [toward, irradiance] : lights) {
    const Vec h = (s.view + toward).normalized();
    const double nl = positive(s.n.dot(toward)), vh = positive(s.view.dot(h)), coat_nl = positive(s.nc.dot(toward));
    if (nl > 0) {
      const double spec = specular_lobe(s, toward, nl, nv), left = positive(1 - largest(fd(schlick(vh), vh)));
      color += (s.base * (diffuse * left / kPi) + fresnel(schlick(vh), vh) * spec) * irradiance * nl;
      sheen += sheen_color * irradiance * (charlie(positive(s.n.dot(h)), nl, nv, sheen_rough) * nl);
    }
    if (coat_nl > 0 && coat_weight > 0)
      coat += irradiance * (coat_weight * (0.04 + 0.96 * schlick(vh)) * coat_nl *
                            ggx(positive(s.nc.dot(h)), coat_nl, coat_nv, std::pow(std::max(coat_rough, 0.05), 2)));
  }
  if (!interface_only)
    color += color_of(scene_.ambient) * s.occlusion *
             (s.base * (diffuse * positive(1 - largest(fd(weight, nv)))) + fresnel(weight, nv) * (1 - fade));
  if (s.optics.reflects) {
    const Answer answer = spawn(s, ray, reflected(s, s.n), s.optics.counts_in_cutoff ? most : 1);
    color += fresnel(weight, nv) * fade * beer(s, s.inside, answer);
  }
  if (s.optics.refracts) {
    const auto bent = refracted_way(s, ior);
    if (!s.optics.bent || bent) {
      Ray parted = ray;
      if (s.optics.dispersion > 0) parted.channel = channel;
      const Answer answer = spawn(s, parted, s.optics.bent ? *bent : -s.view, s.optics.counts_in_cutoff ? 1 - exact : 1);
      const Vec filter = s.optics.volume && s.inside ? Vec(1, 1, 1) : s.base;
      color += filter * (dielectric * s.transmission * positive(1 - largest(fd(weight, nv)))) * beer(s, !s.inside, answer);
    }
  }
  if (largest(sheen_color) > 0) color = color * (1 - largest(sheen_color) * sheen_albedo(nv, sheen_rough)) + sheen;
  const Imath::V4d glow = texture(s, Slot::emissive);
  color += color_of(m.emissive) * Vec(glow.x, glow.y, glow.z) * double{m.emissive_strength};
  if (s.optics.coat_reflects)
    coat +=
        spawn(s, ray, reflected(s, s.nc), coat_fresnel).color * (coat_weight * coat_fresnel * mirror_fade(coat_rough));
  return color * (1 - coat_weight * coat_fresnel) + coat;
}

Vec ReferenceTracer::blinn_phong(const Surface& s, const Ray& ray) const {
  const Material& m = *s.material;
  Vec color = color_of(scene_.ambient) * color_of(m.phong_ambient) * s.base * s.occlusion;
  for (const auto& [toward, irradiance] : lamps(s)) {
    const double nh = positive(s.n.dot((s.view + toward).normalized()));
    const double lobe = (m.shininess + 8) / (8 * kPi) * std::pow(nh, double{m.shininess});
    color += (color_of(m.phong_diffuse) * s.base / kPi + color_of(m.phong_specular) * lobe) * irradiance *
             positive(s.n.dot(toward));
  }
  const Imath::V4d glow = texture(s, Slot::emissive);
  color += color_of(m.emissive) * Vec(glow.x, glow.y, glow.z) * double{m.emissive_strength};
  if (s.optics.reflects) color += spawn(s, ray, reflected(s, s.n), 1).color * double{m.reflection};
  if (s.optics.refracts) {
    const auto bent = refracted_way(s, m.ior);
    if (bent) color += spawn(s, ray, *bent, 1).color * double{m.refraction};
  }
  return color;
}

}  // namespace relook
