#include "color/path/path_surface.h"

#include <optional>

#include "color/surface/base_reflectance.h"
#include "color/surface/diffuse_lobe.h"
#include "color/surface/models.h"
#include "color/surface/specular_lobe.h"
#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "physics/lambert.h"
#include "physics/lobe_angles.h"
#include "physics/lobe_buckets.h"
#include "physics/phong.h"
#include "physics/rough_refraction.h"
#include "physics/sheen.h"

namespace relook {
namespace {

/// What the lobes of a surface make of light from one direction, times the cosine there, each with what lies above it.
struct LobeValues {
  Triple diffuse, specular, coat, transmission;
};

/// The roughness of a reflecting lobe behind other bounces.
Scalar floored_roughness(SurfaceTerms& t, Scalar roughness) { return floored(roughness, t.input(Input::alpha_floor)); }

Triple child_direction(SurfaceTerms& t, Branch branch) {
  return t.input3(Input::child_direction, static_cast<std::uint32_t>(branch));
}
Scalar child_share(SurfaceTerms& t, Branch branch) {
  return t.input(Input::child_share, 0, static_cast<std::uint32_t>(branch));
}
Triple proportion(SurfaceTerms& t, Field field) {
  const Scalar share = t.field(field);
  return {share, share, share};
}
/// The light that comes through a branch, before coverage. Columns that a surface has for one channel are made for
/// each (KHR_materials_dispersion).
struct ScatteredColumns {
  std::vector<Triple> weights;  // of `children`, without that of transparency
  Triple emission, ambient;
};

/// Metallic-roughness in its layers, from below: base, sheen, emission, coat.
class LayeredSurface {
 public:
  LayeredSurface(SurfaceTerms& terms, const PathKey& key)
      : t_(terms),
        is_inside_(key.inside),
        is_interface_(key.interface_only),
        is_blurred_(key.blurs && !key.gathers),
        base_(t_.base_color()),
        metallic_(t_.textured(Field::metallic, Slot::metallic_roughness, 2)),
        normal_(t_.normal(Slot::normal, Field::normal_scale)),
        view_(t_.view()),
        nv_(max(dot(normal_, view_), kLeastCosine)),
        may_transmit_(t_.builder().shape(Field::transmission).transmits),
        is_volume_(t_.builder().shape(Field::thickness).thick && may_transmit_),
        specular_(t_, floored_roughness(t_, t_.textured(Field::roughness, Slot::metallic_roughness, 1))),
        diffuse_{base_, metallic_, transmission()},
        reflectance_(t_, base_, metallic_),
        entered_(reflectance_.entered(reflectance_.dielectric(weight_at(interface_cosine()), nv_))) {
    if (is_interface_) return;
    if (t_.builder().shape(Field::sheen_color).sheen) add_sheen();
    if (!is_inside_ && t_.builder().shape(Field::clearcoat).clearcoat) add_coat();
  }

  /// `direction`: of the light.
  [[nodiscard]] LobeValues lobes(const Triple& direction) {
    const LobeAngles<Triple> at = lobe_angles(normal_, view_, direction);
    const Scalar weight = weight_at(at.vh);
    const Triple mirror = reflectance_.mixed(reflectance_.dielectric(weight, at.vh), weight, at.vh);
    LobeValues values{t_.grey(0), mirror * (specular_.precise_value(at, normal_, direction, view_, nv_) * at.nl),
                      t_.grey(0), t_.grey(0)};
    if (!is_interface_) values.diffuse = diffuse_.value(entered_) * at.nl;
    if (sheen_) {
      const Scalar cloth = sheen(sheen_->inverse_alpha, at.nh, at.nl, nv_) * at.nl;
      values.diffuse = values.diffuse * sheen_->passed + sheen_->color * cloth;
      values.specular = values.specular * sheen_->passed;
    }
    if (coat_) {
      const LobeAngles<Triple> on_coat = lobe_angles(coat_->normal, view_, direction);
      const Scalar lobe = precise_ggx(coat_->alpha2, on_coat.nh, half_sine2(coat_->normal, on_coat), on_coat.nl, coat_->nv) * coat_reflectance(schlick(on_coat.vh));
      const Scalar value = coat_->strength * lobe * on_coat.nl;
      values.diffuse = values.diffuse * coat_->passed;
      values.specular = values.specular * coat_->passed;
      values.coat = {value, value, value};
    }
    if (is_blurred_ && !is_volume_) values.transmission = let_through(mirrored_through(direction));
    return values;
  }

  /// The weight of a refracted ray: of its one way, or, blurred, of a direction of its lobe.
  [[nodiscard]] Triple refracted_weight() {
    if (!is_blurred_) return let_through(entered_);
    const Triple way = child_direction(t_, t_.refraction());
    const Scalar value = is_volume_ ? refracted_through(way) : mirrored_through(way);
    return let_through(value) * child_share(t_, t_.refraction());
  }
  /// Beer's law along a ray that is reflected inside a volume.
  [[nodiscard]] Triple within(const Triple& weight) {
    return is_volume_ && is_inside_ ? weight * t_.beer(child_length(Branch::reflection)) : weight;
  }
  [[nodiscard]] Triple ambient() {
    if (is_interface_) return t_.grey(0);
    return diffuse_.albedo(entered_) * t_.occlusion() * below(true);
  }
  /// What of the light from below the sheen, or from below the coat alone, gets out.
  [[nodiscard]] Scalar below(bool of_sheen) {
    Scalar share = t_.number(1);
    if (of_sheen && sheen_) share = share * sheen_->passed;
    return coat_ ? share * coat_->passed : share;
  }

 private:
  struct Sheen {
    Triple color;
    Scalar inverse_alpha, passed;
  };
  struct Coat {
    Scalar strength;
    Triple normal;
    Scalar nv, alpha2, passed;
  };

  void add_sheen() {
    const Triple color = t_.textured3(Field::sheen_color, Slot::sheen_color);
    const Scalar roughness = t_.textured(Field::sheen_roughness, Slot::sheen_roughness, 3);
    sheen_ = Sheen{color, inverse_sheen_alpha(roughness), below_sheen(color, nv_, roughness)};
  }
  void add_coat() {
    const Scalar strength = t_.textured(Field::clearcoat, Slot::clearcoat, 0);
    const Scalar roughness =
        floored_roughness(t_, t_.textured(Field::clearcoat_roughness, Slot::clearcoat_roughness, 1));
    const Triple normal = t_.normal(Slot::clearcoat_normal, Field::clearcoat_normal_scale);
    const Scalar nv = max(dot(normal, view_), kLeastCosine);
    coat_ = Coat{strength, normal, nv, square(alpha_of(roughness)),
                 1.0F - strength * coat_reflectance(schlick(nv))};
  }

  /// A share of the light that reaches the base, as it is let through: into a volume along the refracted ray.
  [[nodiscard]] Triple let_through(Scalar share) {
    const Scalar all = (1.0F - metallic_) * diffuse_.transmission * share;
    Triple weight{all, all, all};
    if (!is_volume_ || !is_inside_) weight = weight * base_;  // a volume tints once, where it is entered
    if (is_volume_ && !is_inside_) weight = weight * t_.beer(child_length(t_.refraction()));
    return weight * below(true);
  }
  /// Of a thin surface: what would be reflected on the other side, less what each microfacet reflects; with the cosine.
  [[nodiscard]] Scalar mirrored_through(const Triple& way) {
    const Triple up = way - normal_ * (dot(normal_, way) * 2.0F);
    const LobeAngles<Triple> at = lobe_angles(normal_, view_, up);
    return precise_ggx(blur_alpha2(), at.nh, half_sine2(normal_, at), at.nl, nv_) * at.nl * passed(at.vh);
  }
  /// Of a volume, likewise refracted.
  [[nodiscard]] Scalar refracted_through(const Triple& way) {
    const Scalar ior = max(t_.ior(), 1.0F);
    const Scalar eta = is_inside_ ? 1.0F / ior : ior;
    const RefractedAngles<Triple> at = refracted_angles(normal_, view_, way, eta, !is_inside_);
    const Triple flat = at.half - normal_ * at.nh;
    return rough_refraction(blur_alpha2(), at, dot(flat, flat), nv_, eta) * passed(at.vh);
  }
  /// What microfacets at this cosine with the view do not reflect.
  [[nodiscard]] Scalar passed(Scalar cosine) {
    return reflectance_.entered(reflectance_.dielectric(weight_at(cosine), cosine));
  }
  /// What scattered before does not widen what is let through.
  [[nodiscard]] Scalar blur_alpha2() {
    return square(alpha_of(t_.textured(Field::roughness, Slot::metallic_roughness, 1)));
  }
  [[nodiscard]] Scalar transmission() {
    return may_transmit_ ? t_.textured(Field::transmission, Slot::transmission, 0) : t_.number(0);
  }
  /// The weight between f0 and f90: exact for volumes, of which the inside may reflect totally.
  [[nodiscard]] Scalar weight_at(Scalar cosine) {
    return is_volume_ ? exact_weight(t_.ior(), is_inside_, cosine) : schlick(cosine);
  }
  /// From the inside, light leaves where the triangle or its vertex normals let it.
  [[nodiscard]] Scalar interface_cosine() {
    return is_inside_ ? max(nv_, dot(t_.input3(Input::geometric), view_)) : nv_;
  }
  [[nodiscard]] Scalar child_length(Branch branch) {
    return t_.input(Input::child_length, 0, static_cast<std::uint32_t>(branch));
  }

  SurfaceTerms& t_;
  bool is_inside_, is_interface_, is_blurred_;
  Triple base_;
  Scalar metallic_;
  Triple normal_, view_;
  Scalar nv_;
  bool may_transmit_, is_volume_;
  SpecularLobe specular_;
  DiffuseLobe diffuse_;
  BaseReflectance reflectance_;
  Scalar entered_;  // what a dielectric does not reflect towards the eye
  std::optional<Sheen> sheen_;
  std::optional<Coat> coat_;
};

/// Blinn-phong: its power lobe has the place of a coat.
class PhongSurface {
 public:
  explicit PhongSurface(SurfaceTerms& terms)
      : t_(terms), base_(t_.base_color()), normal_(t_.normal(Slot::normal, Field::normal_scale)) {}

  [[nodiscard]] LobeValues lobes(const Triple& direction) {
    const Scalar nl = max(dot(normal_, direction), 0.0F);
    const Scalar nh = max(dot(normal_, normalized(direction + t_.view())), 1e-7F);
    const Scalar shininess = floored_shininess(t_.field(Field::shininess), t_.input(Input::alpha_floor));
    const Triple power = t_.field3(Field::phong_specular) * phong_scale(shininess) * phong_lobe(shininess, nh);
    return {lambert(base_ * t_.field3(Field::phong_diffuse)) * nl, t_.grey(0), power * nl, t_.grey(0)};
  }
  [[nodiscard]] Triple ambient() { return t_.field3(Field::phong_ambient) * base_ * t_.occlusion(); }

 private:
  SurfaceTerms& t_;
  Triple base_, normal_;
};

template <class Surface>
Triple lobe_weight(SurfaceTerms& t, Surface& surface, Branch branch) {
  const LobeValues values = surface.lobes(child_direction(t, branch));
  const Triple value = branch == Branch::diffuse ? values.diffuse
                       : branch == Branch::coat  ? values.coat
                                                 : values.specular;
  return value * child_share(t, branch);
}

ScatteredColumns layered_columns(SurfaceTerms& t, const PathKey& key) {
  LayeredSurface surface(t, key);
  const Scalar shown = surface.below(false);
  ScatteredColumns columns{{}, {shown, shown, shown}, t.grey(0)};
  for (const Branch branch : branches_of(key.children)) {
    if (branch == Branch::transparency) continue;
    if (branch == Branch::reflection)
      columns.weights.push_back(surface.within(lobe_weight(t, surface, branch)));
    else if (branch == Branch::coat || branch == Branch::diffuse)
      columns.weights.push_back(lobe_weight(t, surface, branch));
    else  // of those that part, each brings its channel alone
      columns.weights.push_back(branch == t.refraction() ? surface.refracted_weight() : t.grey(0));
  }
  if (!key.gathers) columns.ambient = surface.ambient();
  return columns;
}

/// Does the material have an index of refraction for each channel?
bool has_indices(SurfaceTerms& t) {
  ExpressionBuilder& b = t.builder();
  return b.shape(Field::dispersion).disperses && b.shape(Field::thickness).thick &&
         b.shape(Field::transmission).transmits;
}

/// Calls make() for the material's index of refraction, or once for each channel's: each channel is then its own's.
template <class Make, class Mix>
auto by_channel(SurfaceTerms& t, const Make& make, const Mix& mix) {
  if (!has_indices(t)) return make();
  t.take(Channel::red);
  const auto red = make();
  t.take(Channel::green);
  const auto green = make();
  t.take(Channel::blue);
  const auto blue = make();
  return mix(red, green, blue);
}
Triple mixed_channels(const Triple& red, const Triple& green, const Triple& blue) { return {red.x, green.y, blue.z}; }

ScatteredColumns metallic_columns(SurfaceTerms& t, const PathKey& key) {
  return by_channel(
      t, [&] { return layered_columns(t, key); },
      [](const ScatteredColumns& red, const ScatteredColumns& green, const ScatteredColumns& blue) {
        ScatteredColumns all{{}, mixed_channels(red.emission, green.emission, blue.emission),
                             mixed_channels(red.ambient, green.ambient, blue.ambient)};
        for (std::size_t i = 0; i < red.weights.size(); ++i)
          all.weights.push_back(mixed_channels(red.weights[i], green.weights[i], blue.weights[i]));
        return all;
      });
}

ScatteredColumns phong_columns(SurfaceTerms& t, const PathKey& key) {
  PhongSurface surface(t);
  ScatteredColumns columns{{}, t.grey(1), key.gathers ? t.grey(0) : surface.ambient()};
  for (const Branch branch : branches_of(key.children)) {
    if (branch == Branch::reflection) columns.weights.push_back(proportion(t, Field::reflection));
    if (branch == Branch::refraction) columns.weights.push_back(proportion(t, Field::refraction));
    if (branch == Branch::diffuse || branch == Branch::coat)
      columns.weights.push_back(lobe_weight(t, surface, branch));
  }
  return columns;
}

/// A straight ray brings what coverage leaves, beside a blinn-phong surface's proportion.
Triple transparency_weight(SurfaceTerms& t, IlluminationModel model, Scalar coverage) {
  const Scalar rest = 1.0F - coverage;
  const Triple through{rest, rest, rest};
  if (model != IlluminationModel::blinn_phong) return through;
  return through + proportion(t, Field::transparency) * coverage;
}

PathColumns surface_columns(SurfaceTerms& t, const PathKey& key) {
  const IlluminationModel model = t.builder().shape(Field::model).model;
  const bool is_unlit = model == IlluminationModel::unlit;
  ScatteredColumns scattered{{}, t.grey(0), t.grey(0)};
  if (model == IlluminationModel::metallic_roughness) scattered = metallic_columns(t, key);
  if (model == IlluminationModel::blinn_phong) scattered = phong_columns(t, key);
  const Scalar coverage = t.coverage();
  PathColumns columns;
  std::size_t next = 0;
  for (const Branch branch : branches_of(key.children))
    columns.push_back(branch == Branch::transparency ? transparency_weight(t, model, coverage)
                                                     : scattered.weights[next++] * coverage);
  columns.push_back(scattered.emission * coverage);
  columns.push_back(scattered.ambient * coverage);
  columns.push_back(is_unlit ? t.base_color() * coverage : t.grey(0));
  columns.push_back({coverage, coverage, coverage});
  return columns;
}

/// All lobes, each by its weight, times the radiance of the sample.
template <class Surface>
Triple lit(SurfaceTerms& t, Surface& surface) {
  const LobeValues values = surface.lobes(t.input3(Input::light_direction));
  return values.diffuse * t.input(Input::light_weight, 0) + values.specular * t.input(Input::light_weight, 1) +
         values.coat * t.input(Input::light_weight, 2) + values.transmission * t.input(Input::light_weight, 3);
}

PathColumns light_columns(SurfaceTerms& t, const PathKey& key) {
  Triple value = t.grey(0);
  const IlluminationModel model = t.builder().shape(Field::model).model;
  if (model == IlluminationModel::metallic_roughness) {
    const auto make = [&] {
      LayeredSurface surface(t, key);
      return lit(t, surface);
    };
    value = by_channel(t, make, mixed_channels);
  } else if (model == IlluminationModel::blinn_phong) {
    PhongSurface surface(t);
    value = lit(t, surface);
  }
  return {value * t.input3(Input::light_radiance) * t.coverage()};
}

/// The tint of the Whitted integrator, less what the face reflects (an interface of its ior, met from outside); of
/// blinn-phong without the base colour, as its rays are weighted.
PathColumns filter_columns(SurfaceTerms& t) {
  const IlluminationModel model = t.builder().shape(Field::model).model;
  if (model == IlluminationModel::blinn_phong) {
    const Scalar coverage = t.coverage();
    const Scalar share = min(t.field(Field::refraction) + t.field(Field::transparency), 1.0F) * coverage + (1.0F - coverage);
    return {{share, share, share}};
  }
  const Triple tint = filter_color(t);
  if (model != IlluminationModel::metallic_roughness || !t.builder().shape(Field::transmission).transmits)
    return {tint};
  const bool is_volume = t.builder().shape(Field::thickness).thick;
  const Scalar cosine = t.input(Input::cosine);
  BaseReflectance reflectance(t, t.base_color(), t.textured(Field::metallic, Slot::metallic_roughness, 2));
  const Scalar weight = is_volume ? exact_weight(t.ior(), false, cosine) : schlick(cosine);
  const Scalar passed = reflectance.entered(reflectance.dielectric(weight, cosine));
  const Scalar coverage = t.coverage();
  const Scalar rest = 1.0F - coverage;
  // filter_color() has the open part in it, which reflects nothing.
  return {(tint - Triple{rest, rest, rest}) * passed + Triple{rest, rest, rest}};
}

}  // namespace

PathColumns path_columns(SurfaceTerms& terms, const PathKey& key) {
  switch (key.piece) {
    case PathPiece::light:
      return light_columns(terms, key);
    case PathPiece::filter:
      return filter_columns(terms);
    case PathPiece::surface:
      break;
  }
  return surface_columns(terms, key);
}

}  // namespace relook
