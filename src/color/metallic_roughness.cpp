// glTF 2.0 Appendix B with KHR_materials_{ior, specular, transmission, volume, clearcoat, sheen, emissive_strength} as
// a colour expression. SHADING.md has the formulas.
#include <numbers>

#include "color/surface_terms.h"

namespace relook {
namespace {

constexpr float kInversePi = std::numbers::inv_pi_v<float>;

/// D V of the GGX lobe; alpha2 = alpha squared.
Scalar ggx(Scalar alpha2, Scalar nh, Scalar nl, Scalar nv) {
  const Scalar d = nh * nh * (alpha2 - 1.0F) + 1.0F;
  const Scalar distribution = alpha2 * kInversePi / (d * d);
  const Scalar lambda_l = nv * sqrt(nl * nl * (1.0F - alpha2) + alpha2);
  const Scalar lambda_v = nl * sqrt(nv * nv * (1.0F - alpha2) + alpha2);
  return distribution * (0.5F / max(lambda_l + lambda_v, 1e-7F));
}

Scalar squared_alpha(Scalar roughness) {
  const Scalar rough = max(roughness, 0.05F);
  const Scalar alpha = rough * rough;
  return alpha * alpha;
}

/// Exact unpolarised Fresnel reflectance R as the weight between f0 and f90: (R - r0) / (1 - r0).
Scalar exact_weight(SurfaceTerms& terms, Scalar cosine) {
  const Scalar ior = max(terms.ior(), 1.0F);
  const Scalar eta = terms.key().inside ? 1.0F / ior : ior;
  const Scalar c = min(cosine, 1.0F);
  const Scalar cos2_out = 1.0F - (1.0F - c * c) / (eta * eta);
  const Scalar out = sqrt(max(cos2_out, 0.0F));
  const Scalar s = (c - eta * out) / (c + eta * out);
  const Scalar p = (out - eta * c) / (out + eta * c);
  const Scalar reflectance = (s * s + p * p) * 0.5F;
  const Scalar root = (ior - 1.0F) / (ior + 1.0F);
  const Scalar r0 = root * root;
  const Scalar weight = min(max((reflectance - r0) / (1.0F - r0), 0.0F), 1.0F);
  return if_positive(cos2_out, weight, terms.number(1));
}

/// The parameters of the base layer at a hit.
class BaseLayer {
 public:
  explicit BaseLayer(SurfaceTerms& terms)
      : t_(terms),
        base_(terms.base_color()),
        metallic_(terms.textured(Field::metallic, Slot::metallic_roughness, 2)),
        roughness_(terms.textured(Field::roughness, Slot::metallic_roughness, 1)),
        alpha2_(squared_alpha(roughness_)),
        transmission_(transmission()),
        specular_(terms.textured(Field::specular, Slot::specular, 3)),
        f0_(dielectric_f0()),
        normal_(terms.normal(Slot::normal, Field::normal_scale)),
        view_(terms.view()),
        nv_(max(dot(normal_, view_), 1e-4F)) {}

  [[nodiscard]] Triple normal() const { return normal_; }
  [[nodiscard]] Scalar nv() const { return nv_; }

  /// (diffuse + spec) NL, for one lamp.
  [[nodiscard]] Triple reflected(const Triple& direction) {
    const Triple half = normalized(direction + view_);
    const Scalar nl = max(dot(normal_, direction), 0.0F);
    const Scalar nh = min(max(dot(normal_, half), 0.0F), 1.0F);
    const Scalar weight = schlick(max(dot(view_, half), 0.0F));
    const Triple dielectric = dielectric_fresnel(weight);
    const Triple diffuse = base_ * (diffuse_share(dielectric) * kInversePi);
    const Triple spec = fresnel(dielectric, weight) * ggx(alpha2_, nh, nl, nv_);
    return (diffuse + spec) * nl;
  }

  /// Ambient light, mirror and transmission: what depends on the view alone.
  [[nodiscard]] Triple view_terms() {
    const bool volume = t_.builder().shape(Field::thickness).thick && may_transmit();
    const Scalar weight = volume ? exact_weight(t_, interface_cosine()) : schlick(nv_);
    const Triple dielectric = dielectric_fresnel(weight);
    const Triple mirror = fresnel(dielectric, weight);
    const Scalar fade = mirror_fade(roughness_);
    Triple sum = t_.grey(0);
    if (!t_.key().interface_only && t_.counts(kAmbientSource))
      sum = t_.ambient() * t_.occlusion() * (base_ * diffuse_share(dielectric) + mirror * (1.0F - fade));
    if (t_.has_child(Branch::reflection)) {
      Triple seen = t_.child(Branch::reflection) * mirror * fade;
      if (volume && t_.key().inside) seen = seen * t_.beer(child_length(Branch::reflection));
      sum = sum + seen;
    }
    if (t_.has_child(t_.refraction())) {
      const Scalar share = (1.0F - metallic_) * transmission_ * (1.0F - largest(dielectric));
      Triple seen = t_.child(t_.refraction()) * share;
      if (!volume || !t_.key().inside) seen = seen * base_;  // a volume tints once, where it is entered
      if (volume && !t_.key().inside) seen = seen * t_.beer(child_length(t_.refraction()));
      sum = sum + seen;
    }
    return sum;
  }

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
    return t_.input(Input::child_length, static_cast<unsigned>(branch));
  }
  [[nodiscard]] Triple dielectric_f0() {
    const Scalar ior = t_.ior();
    const Scalar root = (ior - 1.0F) / (ior + 1.0F);
    const Triple color = t_.textured3(Field::specular_color, Slot::specular_color) * (root * root);
    return Triple{min(color.x, 1.0F), min(color.y, 1.0F), min(color.z, 1.0F)} * specular_;
  }
  [[nodiscard]] Triple dielectric_fresnel(Scalar weight) {
    return f0_ + (Triple{specular_, specular_, specular_} - f0_) * weight;
  }
  /// Dielectric and metal, mixed; `weight` as for dielectric_fresnel.
  [[nodiscard]] Triple fresnel(const Triple& dielectric, Scalar weight) {
    const Triple metal = base_ + (t_.grey(1) - base_) * weight;
    return dielectric * (1.0F - metallic_) + metal * metallic_;
  }
  [[nodiscard]] Scalar diffuse_share(const Triple& dielectric) {
    return (1.0F - metallic_) * (1.0F - transmission_) * (1.0F - largest(dielectric));
  }

  SurfaceTerms& t_;
  Triple base_;
  Scalar metallic_, roughness_, alpha2_, transmission_, specular_;
  Triple f0_, normal_, view_;
  Scalar nv_;
};

/// A sheen layer over what lies below (Charlie distribution, Ashikhmin visibility).
class SheenLayer {
 public:
  SheenLayer(SurfaceTerms& terms, const BaseLayer& base)
      : color_(terms.textured3(Field::sheen_color, Slot::sheen_color)),
        roughness_(terms.textured(Field::sheen_roughness, Slot::sheen_roughness, 3)),
        normal_(base.normal()),
        view_(terms.view()),
        nv_(base.nv()) {}

  [[nodiscard]] Triple reflected(const Triple& direction) {
    const Scalar rough = max(roughness_, 0.07F);
    const Scalar inverse_alpha = 1.0F / (rough * rough);
    const Triple half = normalized(direction + view_);
    const Scalar nl = max(dot(normal_, direction), 0.0F);
    const Scalar nh = min(max(dot(normal_, half), 0.0F), 1.0F);
    const Scalar sin2 = max(1.0F - nh * nh, 1e-7F);
    const Scalar power = exp2(log2(sin2) * (inverse_alpha * 0.5F));
    const Scalar distribution = (inverse_alpha + 2.0F) * power * (0.5F * kInversePi);
    const Scalar visibility = 1.0F / (max(nl + nv_ - nl * nv_, 1e-4F) * 4.0F);
    return color_ * (distribution * visibility * nl);
  }
  /// What the layer leaves of the light from below.
  [[nodiscard]] Scalar passed() {
    ExpressionBuilder& b = *nv_.builder;
    const Scalar albedo{&b, b.apply(Op::sheen_albedo, min(nv_, 1.0F).value, roughness_.value)};
    return max(1.0F - largest(color_) * albedo, 0.0F);
  }

 private:
  Triple color_;
  Scalar roughness_;
  Triple normal_, view_;
  Scalar nv_;
};

/// A clearcoat over everything, emission included.
class CoatLayer {
 public:
  explicit CoatLayer(SurfaceTerms& terms)
      : t_(terms),
        strength_(terms.textured(Field::clearcoat, Slot::clearcoat, 0)),
        roughness_(terms.textured(Field::clearcoat_roughness, Slot::clearcoat_roughness, 1)),
        normal_(terms.normal(Slot::clearcoat_normal, Field::clearcoat_normal_scale)),
        view_(terms.view()),
        nv_(max(dot(normal_, view_), 1e-4F)),
        fresnel_(coat_fresnel(nv_)) {}

  [[nodiscard]] Triple reflected(const Triple& direction) {
    const Triple half = normalized(direction + view_);
    const Scalar nl = max(dot(normal_, direction), 0.0F);
    const Scalar nh = min(max(dot(normal_, half), 0.0F), 1.0F);
    const Scalar lobe = ggx(squared_alpha(roughness_), nh, nl, nv_) * coat_fresnel(max(dot(view_, half), 0.0F));
    const Scalar value = strength_ * lobe * nl;
    return {value, value, value};
  }
  [[nodiscard]] Scalar passed() { return 1.0F - strength_ * fresnel_; }
  [[nodiscard]] Triple mirror() { return t_.child(Branch::coat) * (strength_ * fresnel_ * mirror_fade(roughness_)); }

 private:
  [[nodiscard]] static Scalar coat_fresnel(Scalar cosine) { return schlick(cosine) * 0.96F + 0.04F; }

  SurfaceTerms& t_;
  Scalar strength_, roughness_;
  Triple normal_, view_;
  Scalar nv_, fresnel_;
};

/// For the index of refraction that `terms` takes.
Triple layered_color(SurfaceTerms& terms) {
  BaseLayer base(terms);
  Triple sum = base.view_terms();
  if (terms.key().interface_only) return sum;
  const std::vector<VisibleLight>& lights = terms.key().lights;
  std::vector<Incidence> lamps;
  for (const VisibleLight& light : lights) lamps.push_back(terms.incidence(light));
  const auto add_lamps = [&](auto& layer) {
    for (std::size_t i = 0; i < lamps.size(); ++i)
      sum = terms.with(lights[i], sum, layer.reflected(lamps[i].direction) * lamps[i].irradiance);
  };
  add_lamps(base);
  if (terms.builder().shape(Field::sheen_color).sheen) {
    SheenLayer sheen(terms, base);
    sum = sum * sheen.passed();
    add_lamps(sheen);
  }
  if (terms.counts(kEmissionSource)) sum = sum + terms.emission();
  if (terms.builder().shape(Field::clearcoat).clearcoat) {
    CoatLayer coat(terms);
    sum = sum * coat.passed();
    add_lamps(coat);
    if (terms.has_child(Branch::coat)) sum = sum + coat.mirror();
  }
  return sum;
}

/// Does the material have an index of refraction for each channel?
bool has_indices(SurfaceTerms& terms) {
  ExpressionBuilder& b = terms.builder();
  return b.shape(Field::dispersion).disperses && b.shape(Field::thickness).thick &&
         b.shape(Field::transmission).transmits;
}

}  // namespace

Triple metallic_roughness_color(SurfaceTerms& terms) {
  if (!has_indices(terms)) return layered_color(terms);
  const auto in = [&](Channel channel) {
    terms.take(channel);
    return layered_color(terms);
  };
  const Triple red = in(Channel::red), green = in(Channel::green), blue = in(Channel::blue);
  return {red.x, green.y, blue.z};
}

}  // namespace relook
