// glTF 2.0 Appendix B with KHR_materials_{ior, specular, transmission, volume, anisotropy, iridescence, clearcoat,
// sheen, emissive_strength} as a colour expression. SHADING.md has the formulas.
#include <numbers>
#include <optional>

#include "color/surface/surface_terms.h"
#include "color/surface/thin_film.h"

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

/// A direction in the frame of a brushed surface.
struct Brushed {
  Scalar along, across, up;  // cosines with the two axes and the normal
};

/// D V of the anisotropic GGX lobe (Burley 2012; Heitz 2014 section 5.4).
Scalar brushed_ggx(Scalar alpha_along, Scalar alpha_across, const Brushed& half, const Brushed& light,
                   const Brushed& view) {
  const auto square = [](Scalar x) { return x * x; };
  const Scalar both = alpha_along * alpha_across;
  const Scalar stretched =
      square(alpha_across * half.along) + square(alpha_along * half.across) + square(both * half.up);
  const Scalar share = both / max(stretched, 1e-12F);
  const Scalar distribution = both * share * share * kInversePi;
  const auto length = [&](const Brushed& w) {
    return sqrt(square(alpha_along * w.along) + square(alpha_across * w.across) + square(w.up));
  };
  return distribution * (0.5F / max(light.up * length(view) + view.up * length(light), 1e-7F));
}

/// KHR_materials_anisotropy at a hit: which way the lobe is wider, and by how much.
class Brush {
 public:
  explicit Brush(SurfaceTerms& terms) {
    const auto [tangent, bitangent] = terms.axes(Slot::anisotropy);
    const Scalar cosine = terms.field(Field::anisotropy_rotation, 0);
    const Scalar sine = terms.field(Field::anisotropy_rotation, 1);
    Scalar x = cosine, y = sine;
    if (terms.has(Slot::anisotropy)) {
      const Scalar u = terms.texel(Slot::anisotropy, 0) * 2.0F - 1.0F;
      const Scalar v = terms.texel(Slot::anisotropy, 1) * 2.0F - 1.0F;
      const Scalar scale = 1.0F / sqrt(max(u * u + v * v, 1e-30F));
      x = (cosine * u - sine * v) * scale;
      y = (sine * u + cosine * v) * scale;
    }
    along_ = tangent * x + bitangent * y;
    across_ = bitangent * x - tangent * y;
    const Scalar strength = terms.textured(Field::anisotropy, Slot::anisotropy, 2);
    is_there_ = dot(along_, along_);
    strength2_ = strength * strength;
  }

  /// `isotropic` where the mesh gives no tangents; it is D V without anisotropy.
  [[nodiscard]] Scalar lobe(Scalar roughness, const Triple& half, Scalar nh, const Triple& light, Scalar nl,
                            const Triple& view, Scalar nv, Scalar isotropic) const {
    const Scalar rough = max(roughness, 0.05F);
    const Scalar alpha = rough * rough;
    const auto seen = [&](const Triple& way, Scalar up) { return Brushed{dot(along_, way), dot(across_, way), up}; };
    const Scalar lobe = brushed_ggx(widened(alpha), alpha, seen(half, nh), seen(light, nl), seen(view, nv));
    return if_positive(is_there_, lobe, isotropic);
  }
  /// Of the wider direction: a surface mirrors as far as it is smooth both ways.
  [[nodiscard]] Scalar mirror_roughness(Scalar roughness) const {
    return if_positive(is_there_, sqrt(widened(roughness * roughness)), roughness);
  }

 private:
  [[nodiscard]] Scalar widened(Scalar alpha) const { return alpha + (1.0F - alpha) * strength2_; }

  Triple along_, across_;
  Scalar is_there_, strength2_;
};

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
        nv_(max(dot(normal_, view_), 1e-4F)) {
    if (t_.builder().shape(Field::anisotropy).anisotropic) brush_.emplace(terms);
    // The inside of a volume is an interface of its ior alone.
    if (t_.builder().shape(Field::iridescence).iridescent && !t_.key().interface_only) film_ = film();
  }

  [[nodiscard]] Triple normal() const { return normal_; }
  [[nodiscard]] Scalar nv() const { return nv_; }

  /// (diffuse + spec) NL, for one lamp.
  [[nodiscard]] Triple reflected(const Triple& direction) {
    const Triple half = normalized(direction + view_);
    const Scalar nl = max(dot(normal_, direction), 0.0F);
    const Scalar nh = min(max(dot(normal_, half), 0.0F), 1.0F);
    const Scalar vh = max(dot(view_, half), 0.0F);
    const Scalar weight = schlick(vh);
    const Triple dielectric = dielectric_fresnel(weight, vh);
    const Triple diffuse = base_ * (diffuse_share(dielectric) * kInversePi);
    const Scalar isotropic = ggx(alpha2_, nh, nl, nv_);
    const Scalar lobe =
        brush_ ? brush_->lobe(roughness_, half, nh, direction, nl, view_, nv_, isotropic) : isotropic;
    const Triple spec = fresnel(dielectric, weight, vh) * lobe;
    return (diffuse + spec) * nl;
  }

  /// Ambient light, mirror and transmission: what depends on the view alone.
  [[nodiscard]] Triple view_terms() {
    const bool volume = t_.builder().shape(Field::thickness).thick && may_transmit();
    const Scalar weight = volume ? exact_weight(t_, interface_cosine()) : schlick(nv_);
    const Triple dielectric = dielectric_fresnel(weight, nv_);
    const Triple mirror = fresnel(dielectric, weight, nv_);
    const Scalar fade = mirror_fade(brush_ ? brush_->mirror_roughness(roughness_) : roughness_);
    Triple sum = t_.grey(0);
    if (!t_.key().interface_only && t_.counts(kAmbientSource))
      sum = t_.ambient() * t_.occlusion() * (base_ * diffuse_share(dielectric) + mirror * (1.0F - fade));
    if (t_.has_child(Branch::reflection)) {
      Triple seen = t_.child(Branch::reflection) * mirror * fade;
      if (volume && t_.key().inside) seen = seen * t_.beer(child_length(Branch::reflection));
      sum = sum + seen;
    }
    if (t_.has_child(t_.refraction())) {
      const Scalar share = (1.0F - metallic_) * transmission_ * passed(dielectric);
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
    return t_.input(Input::child_length, 0, static_cast<std::uint32_t>(branch));
  }
  [[nodiscard]] Triple dielectric_f0() {
    const Scalar ior = t_.ior();
    const Scalar root = (ior - 1.0F) / (ior + 1.0F);
    const Triple color = t_.textured3(Field::specular_color, Slot::specular_color) * (root * root);
    return Triple{min(color.x, 1.0F), min(color.y, 1.0F), min(color.z, 1.0F)} * specular_;
  }
  [[nodiscard]] ThinFilm film() {
    Scalar thickness = t_.field(Field::iridescence_maximum);
    if (t_.has(Slot::iridescence_thickness)) {
      const Scalar least = t_.field(Field::iridescence_minimum);
      thickness = least + (thickness - least) * t_.texel(Slot::iridescence_thickness, 1);
    }
    return {t_.field(Field::iridescence_ior), thickness};
  }
  /// As much of the film over a bare surface as iridescence says.
  [[nodiscard]] Triple filmed(const Triple& bare, const Triple& f0, Scalar cosine) {
    if (!film_) return bare;
    const Scalar share = t_.textured(Field::iridescence, Slot::iridescence, 0);
    return bare * (1.0F - share) + film_fresnel(*film_, f0, cosine) * share;
  }
  /// `weight`: between f0 and f90; `cosine`: of incidence.
  [[nodiscard]] Triple dielectric_fresnel(Scalar weight, Scalar cosine) {
    return filmed(f0_ + (Triple{specular_, specular_, specular_} - f0_) * weight, f0_, cosine);
  }
  /// Dielectric and metal, mixed; `weight` and `cosine` as for dielectric_fresnel.
  [[nodiscard]] Triple fresnel(const Triple& dielectric, Scalar weight, Scalar cosine) {
    const Triple metal = filmed(base_ + (t_.grey(1) - base_) * weight, base_, cosine);
    return dielectric * (1.0F - metallic_) + metal * metallic_;
  }
  /// What a dielectric does not reflect.
  [[nodiscard]] Scalar passed(const Triple& dielectric) {
    const Scalar rest = 1.0F - largest(dielectric);
    return film_ ? max(rest, 0.0F) : rest;
  }
  [[nodiscard]] Scalar diffuse_share(const Triple& dielectric) {
    return (1.0F - metallic_) * (1.0F - transmission_) * passed(dielectric);
  }

  SurfaceTerms& t_;
  Triple base_;
  Scalar metallic_, roughness_, alpha2_, transmission_, specular_;
  Triple f0_, normal_, view_;
  Scalar nv_;
  std::optional<Brush> brush_;
  std::optional<ThinFilm> film_;
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
