#include "path_reference_surface.h"

#include <algorithm>
#include <cmath>

#include "pi.h"

namespace relook {
namespace {

double schlick_weight(double cosine) { return std::pow(1 - std::min(cosine, 1.0), 5); }

/// D V NL
double ggx(const Vec& n, const Vec& view, double nv, const Vec& way, double alpha) {
  const double nl = n.dot(way);
  if (nl <= 0) return 0;
  const Vec h = (view + way).normalized();
  const double nh = std::max(n.dot(h), 0.0), a2 = alpha * alpha, d = nh * nh * a2 + (h - n * nh).length2();
  const double smith = nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2);
  return a2 / (kPi * d * d) * 0.5 / smith * nl;
}

}  // namespace

double exact_reflectance(double cosine, double eta) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  const double behind = std::sqrt(1 - sine2);
  const double s = (cosine - eta * behind) / (cosine + eta * behind);
  const double p = (behind - eta * cosine) / (behind + eta * cosine);
  return (s * s + p * p) / 2;
}

Vec tilted(const Vec& axis, double cosine, double turn) {
  const Vec other = std::fabs(axis.x) < 0.5 ? Vec(1, 0, 0) : Vec(0, 1, 0);
  const Vec x = axis.cross(other).normalized(), y = axis.cross(x);
  const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + axis * cosine;
}

Vec PathReference::Surface::dielectric(double cosine) const {
  const double ior = std::max(double{material->ior}, 1.0), r0 = std::pow((ior - 1) / (ior + 1), 2);
  double weight = schlick_weight(cosine);
  if (optics.volume)
    weight = std::clamp((exact_reflectance(std::min(cosine, 1.0), inside ? 1 / ior : ior) - r0) / (1 - r0), 0.0, 1.0);
  Vec f0 = color_of(material->specular_color) * r0;
  for (int c = 0; c < 3; ++c) f0[c] = std::min(f0[c], 1.0) * double{material->specular};
  const double f90 = material->specular;
  return f0 + (Vec(f90, f90, f90) - f0) * weight;
}

Vec PathReference::Surface::reflectance(double cosine) const {
  const double ior = std::max(double{material->ior}, 1.0), r0 = std::pow((ior - 1) / (ior + 1), 2);
  double weight = schlick_weight(cosine);
  if (optics.volume)
    weight = std::clamp((exact_reflectance(std::min(cosine, 1.0), inside ? 1 / ior : ior) - r0) / (1 - r0), 0.0, 1.0);
  const double metallic = material->metallic;
  return dielectric(cosine) * (1 - metallic) + (base() + (Vec(1, 1, 1) - base()) * weight) * metallic;
}

double PathReference::Surface::entered() const {
  return 1 - largest(dielectric(inside ? std::max(nv, ng.dot(view)) : nv));
}

double PathReference::Surface::below_coat() const { return 1 - coat() * (0.04 + 0.96 * schlick_weight(nv)); }

Vec PathReference::Surface::diffuse(const Vec& way) const {
  const double nl = n.dot(way);
  if (nl <= 0 || is_interface()) return Vec(0, 0, 0);
  return base() * ((1.0 - material->metallic) * (1.0 - material->transmission) * entered() / kPi * nl * below_coat());
}

Vec PathReference::Surface::specular(const Vec& way) const {
  const double vh = std::max(view.dot((view + way).normalized()), 0.0);
  return reflectance(vh) * (ggx(n, view, nv, way, alpha) * below_coat());
}

Vec PathReference::Surface::coating(const Vec& way) const {
  const double vh = std::max(view.dot((view + way).normalized()), 0.0);
  const double value = coat() * (0.04 + 0.96 * schlick_weight(vh)) * ggx(n, view, nv, way, coat_alpha);
  return {value, value, value};
}

bool PathReference::Surface::blurs() const {
  return optics.refracts && material->roughness >= 0.0625F && (!optics.volume || material->ior >= 1.015625F);
}

Vec PathReference::Surface::through(const Vec& way) const {
  if (!blurs() || n.dot(way) >= 0) return Vec(0, 0, 0);
  double vh, value;
  if (optics.volume) {
    const Vec sum = view + way * eta(), h = sum.normalized() * (eta() > 1 ? -1.0 : 1.0);
    vh = view.dot(h);
    const double lh = -way.dot(h), nl = -n.dot(way), nh = n.dot(h);
    if (vh <= 0 || lh <= 0 || nh <= 0) return Vec(0, 0, 0);
    const double a2 = blur_alpha * blur_alpha, d = nh * nh * a2 + (h - n * nh).length2();
    const auto seen = [&](double c) { return 2 * c / (c + std::sqrt(c * c * (1 - a2) + a2)); };
    value = a2 / (kPi * d * d) * seen(nv) * seen(nl) * vh / nv * eta() * eta() * lh / sum.length2();
  } else {
    const Vec up = way - n * (2 * n.dot(way));
    vh = std::max(view.dot((view + up).normalized()), 0.0);
    value = ggx(n, view, nv, up, blur_alpha);
  }
  const Vec tinted = is_interface() ? Vec(1, 1, 1) : base();
  return tinted * ((1.0 - material->metallic) * material->transmission * value * (1 - largest(dielectric(vh))) *
                   below_coat());
}

Vec PathReference::Surface::tint(double inside_length) const {
  const double rest = 1 - coverage();
  if (!optics.passes_light) return Vec(rest, rest, rest);
  const double cosine = std::fabs(ng.dot(view));
  Surface outside = *this;
  outside.inside = false;
  Vec through = is_interface() ? Vec(1, 1, 1) : base();
  through *= (1.0 - material->metallic) * material->transmission * (1 - largest(outside.dielectric(cosine)));
  if (is_interface() && std::isfinite(material->attenuation_distance))
    for (int c = 0; c < 3; ++c)
      through[c] *= std::pow(double{material->attenuation_color[c]}, inside_length / material->attenuation_distance);
  return Vec(rest, rest, rest) + through * coverage();
}

}  // namespace relook
