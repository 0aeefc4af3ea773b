#include "path_reference.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "path_reference_light.h"
#include "path_reference_surface.h"
#include "pi.h"

namespace relook {
namespace {

constexpr double kOffset = 1e-6;
constexpr std::size_t kPartSize = 16;
const Vec kBlack(0, 0, 0);

double number(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec normal_of(const WorldTriangle& t) { return (t.b - t.a).cross(t.c - t.a); }
bool is_black(const Vec& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace

PathReference::PathReference(const Scene& scene, unsigned diffuse_depth, unsigned max_depth, unsigned glossy_depth)
    : scene_(scene), diffuse_depth_(diffuse_depth), max_depth_(max_depth), glossy_depth_(glossy_depth) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].alive) continue;
    const std::vector<WorldTriangle> triangles = world_triangles(scene, i);
    for (std::size_t first = 0; first < triangles.size(); first += kPartSize) {
      Part part{triangles_.size(), 0, kBlack, 0};
      Imath::Box3d box;
      for (std::size_t t = first; t < std::min(first + kPartSize, triangles.size()); ++t) {
        triangles_.push_back(triangles[t]);
        for (const Vec& corner : {triangles[t].a, triangles[t].b, triangles[t].c}) box.extendBy(corner);
      }
      part.end = triangles_.size();
      part.middle = box.center();
      part.radius2 = box.size().length2() / 4 * (1 + 1e-9);
      parts_.push_back(part);
    }
  }
}

template <class Visitor>
void PathReference::visit_crossings(const Vec& origin, const Vec& way, const Visitor& visit) const {
  for (const Part& part : parts_) {
    const Vec to = part.middle - origin;
    if ((to - way * to.dot(way)).length2() > part.radius2) continue;
    for (std::size_t i = part.first; i < part.end; ++i) {
      const LineHit hit = intersect(triangles_[i], origin, way);
      if (hit.inside && hit.t > 0) visit(Found{&triangles_[i], hit.t, hit.u, hit.v});
    }
  }
}

bool PathReference::is_met(const WorldTriangle& triangle, const Vec& way) const {
  const Object& object = scene_.objects[triangle.object];
  const double side = normal_of(triangle).dot(way);
  const bool is_back = (Imath::M44d(object.to_world).determinant() < 0 ? -side : side) > 0;
  return !is_back || scene_.material(object.material).double_sided;
}

PathReference::Ray PathReference::eye_ray(double across, double down) const {
  const CameraRay from = camera_ray(scene_.camera, static_cast<float>(across), static_cast<float>(down));
  Ray ray{};
  ray.origin = Vec(from.origin);
  ray.way = Vec(from.direction).normalized();
  return ray;
}

PathReference::Found PathReference::nearest(const Vec& origin, const Vec& way) const {
  Found best;
  visit_crossings(origin, way, [&](const Found& found) {
    if ((!best.triangle || found.t < best.t) && is_met(*found.triangle, way)) best = found;
  });
  return best;
}

PathReference::Surface PathReference::surface_at(const Found& found, const Vec& way, double floor) const {
  const WorldTriangle& triangle = *found.triangle;
  Surface s{};
  s.object = &scene_.objects[triangle.object];
  s.material = &scene_.material(s.object->material);
  const Mesh& mesh = scene_.mesh(s.object->mesh);
  s.optics = surface_optics(*s.material, mesh);
  s.p = triangle.a * (1 - found.u - found.v) + triangle.b * found.u + triangle.c * found.v;
  const Imath::M44d world(s.object->to_world);
  Vec front = normal_of(triangle).normalized();
  if (world.determinant() < 0) front = -front;
  s.inside = front.dot(way) > 0;
  s.ng = s.n = s.inside ? -front : front;
  s.lift = kBlack;
  if (!mesh.normals.empty()) {
    const auto& [i, j, k] = mesh.triangles[triangle.primitive];
    const std::uint32_t corners[] = {i, j, k};
    const double weights[] = {1 - found.u - found.v, found.u, found.v};
    Vec at = kBlack, normal = kBlack, lift = kBlack;
    for (int c = 0; c < 3; ++c) at += Vec(mesh.positions[corners[c]]) * weights[c];
    for (int c = 0; c < 3; ++c) {
      const Vec one = Vec(mesh.normals[corners[c]]) * (s.inside ? -1.0 : 1.0);
      normal += one * weights[c];
      lift += one * (weights[c] * std::max((Vec(mesh.positions[corners[c]]) - at).dot(one), 0.0));
    }
    world.multDirMatrix(lift, s.lift);
    world.inverse().transposed().multDirMatrix(normal, s.n);
    s.n.normalize();
    if (s.n.dot(s.ng) < 0) s.n = -s.n;
  }
  s.view = -way;
  s.nv = std::max(s.n.dot(s.view), 1e-4);
  s.alpha = std::max(std::pow(std::max(double{s.material->roughness}, 0.05), 2), floor);
  s.blur_alpha = std::pow(std::max(double{s.material->roughness}, 0.05), 2);
  s.coat_alpha = std::max(std::pow(std::max(double{s.material->clearcoat_roughness}, 0.05), 2), floor);
  return s;
}

Vec PathReference::passed(const Vec& from, const Vec& way, double distance, bool is_sized) const {
  std::vector<Found> crossings;
  visit_crossings(from, way, [&](const Found& found) {
    if (found.t < distance && is_met(*found.triangle, is_sized ? way : -way)) crossings.push_back(found);
  });
  std::ranges::sort(crossings, {}, &Found::t);
  Vec light(1, 1, 1);
  std::map<std::uint32_t, double> entered;
  for (const Found& found : crossings) {
    double& entry = entered[found.triangle->object];
    light *= surface_at(found, way, 0).tint(found.t - entry);
    entry = found.t;
  }
  return light;
}

Vec PathReference::segment_origin(const Surface& s, const Vec& way) {
  return s.p + s.lift * std::clamp(1 - s.ng.dot(way) / 0.1, 0.0, 1.0) + s.ng * kOffset;
}

Vec PathReference::surroundings(const Ray& ray) const {
  const Environment& environment = scene_.environment;
  Vec value = color_of(environment.color) * double{environment.intensity};
  if (!environment.image) return value;
  const double turned = std::atan2(ray.way.x, -ray.way.z) + environment.rotation;
  const Uv uv(static_cast<float>(0.5 + turned / (2 * kPi)), static_cast<float>(std::acos(ray.way.y) / kPi));
  const Rgba texel = sample(*environment.image, uv, 0, {Wrap::repeat, Wrap::clamp});
  return value * Vec(texel.r, texel.g, texel.b);
}

Vec PathReference::crossed(const Ray& ray, double end) const {
  Vec sum = kBlack;
  for (const LightId id : scene_.light_order) {
    const Light& light = scene_.light(id);
    if (!has_shape(light) || !ray.meets_lights || (ray.is_eye && !light.visible)) continue;
    if (ray.from != nullptr &&
        light.excludes(ObjectId(static_cast<std::uint32_t>(ray.from - scene_.objects.data()))))
      continue;
    const auto t = crossing(light, ray.origin, ray.way);
    if (t && *t < end) sum += radiance_of(light) * share_of(light, ray.origin);
  }
  return sum;
}

Vec PathReference::of_light(const Light& light, const Surface& s, const Ray& ray, Random& random) const {
  Vec way, arriving;  // radiance over the density of the sample, or irradiance
  double distance = 1e30;
  if (light.kind == LightKind::suns) return kBlack;
  const bool is_sized = has_shape(light) || light.kind == LightKind::emission;
  if (light.kind == LightKind::emission) {
    double area = 0;
    for (const WorldTriangle& t : triangles_)
      if (scene_.objects[t.object].material == light.material) area += normal_of(t).length() / 2;
    double left = number(random) * area;
    const WorldTriangle* chosen = nullptr;
    for (const WorldTriangle& t : triangles_) {
      if (scene_.objects[t.object].material != light.material) continue;
      chosen = &t;
      if ((left -= normal_of(t).length() / 2) < 0) break;
    }
    const double root = std::sqrt(number(random)), v = root * number(random);
    const Vec to = chosen->a * (1 - root) + chosen->b * (root - v) + chosen->c * v - s.p;
    way = to.normalized();
    if (!is_met(*chosen, way)) return kBlack;
    distance = to.length() - 1e-5;
    arriving = radiance_of(light) * (area * std::fabs(normal_of(*chosen).normalized().dot(way)) / to.length2());
  } else if (traits_of(light.kind).has_size) {
    double x = 2 * number(random) - 1, y = 2 * number(random) - 1, area = 4;
    if (light.kind == LightKind::disk) {
      const double radius = std::sqrt(number(random)), turn = 2 * kPi * number(random);
      x = radius * std::cos(turn), y = radius * std::sin(turn), area = kPi;
    }
    const Vec to = Vec(light.position) + Vec(light.right) * x + Vec(light.up) * y - s.p;
    area *= Vec(light.right).cross(Vec(light.up)).length();
    way = to.normalized();
    distance = to.length();
    arriving = radiance_of(light) * (area * std::max(-Vec(light.direction).dot(way), 0.0) / to.length2());
  } else if (is_sized) {
    Vec axis = -Vec(light.direction);
    double least = std::cos(light.angle / 2.0);
    if (light.radius > 0) {
      axis = Vec(light.position) - s.p;
      least = std::sqrt(std::max(1 - light.radius * double{light.radius} / axis.length2(), 0.0));
    }
    way = tilted(axis.normalized(), least + (1 - least) * number(random), 2 * kPi * number(random));
    distance = crossing(light, s.p, way).value_or(0);
    arriving = radiance_of(light) * (share_of(light, s.p) * 2 * kPi * (1 - least));
  } else if (traits_of(light.kind).has_place) {
    const Vec to = Vec(light.position) - s.p;
    way = to.normalized();
    distance = to.length();
    arriving = color_of(light.color) * (light.intensity * share_of(light, s.p) /
                                        std::max(to.length2(), ray.from != nullptr ? 1e-4 : 1e-8));
  } else {
    way = -Vec(light.direction);
    arriving = color_of(light.color) * double{light.intensity};
  }
  if (s.n.dot(way) <= 0) {
    // Unless what sent the ray has the same light by a segment of its own.
    const bool is_let_through = is_sized ? (ray.is_eye || ray.meets_lights) && Surface::is_wide(s.blur_alpha)
                                         : !ray.has_lamps;
    if (s.optics.volume || !is_let_through || s.ng.dot(way) >= 0) return kBlack;
    const Vec light_there = s.through(way) * arriving;
    return is_black(light_there) ? kBlack : light_there * passed(s.p - s.ng * kOffset, way, distance, is_sized);
  }
  Vec value = s.diffuse(way);
  if (!is_sized || Surface::is_wide(s.alpha)) value += s.specular(way);
  if (!is_sized || Surface::is_wide(s.coat_alpha)) value += s.coating(way);
  const Vec light_there = value * arriving;
  if (is_black(light_there)) return kBlack;
  return light_there * passed(segment_origin(s, way), way, distance, is_sized);
}

Vec PathReference::gathered(const Surface& s, const Ray& ray, Random& random) const {
  Vec sum = kBlack;
  if (s.is_interface()) return sum;
  const ObjectId object(static_cast<std::uint32_t>(s.object - scene_.objects.data()));
  for (const LightId id : scene_.light_order)
    if (!scene_.light(id).excludes(object)) sum += of_light(scene_.light(id), s, ray, random);
  return sum;
}

Vec PathReference::scattered(const Surface& s, const Ray& ray, Random& random) const {
  enum class Kind { diffuse, specular, coat, through };
  std::vector<Kind> kinds;
  if (!s.is_interface()) kinds.push_back(Kind::diffuse);
  kinds.push_back(Kind::specular);
  if (s.coat() > 0) kinds.push_back(Kind::coat);
  if (s.blurs()) kinds.push_back(Kind::through);
  const Kind kind = kinds[static_cast<std::size_t>(number(random) * static_cast<double>(kinds.size()))];
  const double u = number(random), turn = 2 * kPi * number(random);
  Ray next = ray;
  next.generation = ray.generation + 1;
  if (ray.from == nullptr) next.straight = 0;
  next.from = s.object;
  next.is_eye = false;
  next.has_lamps = !s.is_interface();
  Vec weight;
  double alpha = 1;
  if (kind == Kind::diffuse) {
    next.way = tilted(s.n, std::sqrt(u), turn);
    weight = s.diffuse(next.way) * (kPi / std::max(s.n.dot(next.way), 1e-12));
    next.floor = std::max(ray.floor, 0.25);
    ++next.diffuse;
    next.gathers = next.diffuse > diffuse_depth_ || ray.generation >= max_depth_;
    next.meets_lights = false;
  } else {
    const bool is_through = kind == Kind::through;
    alpha = is_through ? s.blur_alpha : kind == Kind::coat ? s.coat_alpha : s.alpha;
    const double nh = 1 / std::sqrt(1 + alpha * alpha * u / (1 - u)), sine2 = 1 - nh * nh;
    const Vec h = tilted(s.n, nh, turn);
    const double vh = s.view.dot(h);
    if (vh <= 0) return kBlack;
    next.way = (h * (2 * vh) - s.view).normalized();
    double bent = 1 / (4 * vh);  // solid angle of half vectors over that of ways
    if (is_through && s.optics.volume) {
      const double inner = 1 - (1 - vh * vh) / (s.eta() * s.eta());
      if (inner <= 0) return kBlack;
      next.way = (h * (vh / s.eta() - std::sqrt(inner)) - s.view / s.eta()).normalized();
      bent = s.eta() * s.eta() * -next.way.dot(h) / (s.view + next.way * s.eta()).length2();
    } else if (is_through) {
      next.way -= s.n * (2 * s.n.dot(next.way));
    }
    const double d = nh * nh * alpha * alpha + sine2;
    const double density = alpha * alpha / (kPi * d * d) * nh * bent;
    weight = (is_through ? s.through(next.way) : kind == Kind::coat ? s.coating(next.way) : s.specular(next.way)) / density;
    const double bucket = std::exp2(std::min(std::floor(std::log2(alpha)), -1.0));  // its lower end
    next.floor = std::max(ray.floor, std::min(bucket, 0.25));
    next.glossy += is_through ? 0 : 1;
    next.gathers = next.glossy > glossy_depth_ || ray.generation >= max_depth_;
    const bool is_sampled = is_through ? !s.optics.volume : !s.is_interface();
    next.meets_lights = !Surface::is_wide(alpha) || !is_sampled;
    if (is_through) {
      next.meets_lights = next.meets_lights && (ray.is_eye || ray.meets_lights);
      next.has_lamps = ray.has_lamps || is_sampled;
    }
  }
  if (kind == Kind::specular && s.optics.refracts && s.optics.counts_in_cutoff)
    next.fresnel *= exact_reflectance(std::min(s.inside ? std::max(s.nv, s.ng.dot(s.view)) : s.nv, 1.0),
                                      s.is_interface() ? 1 / s.optics.ior : s.optics.ior);
  const double side = kind == Kind::through ? -1 : 1;
  if (next.way.dot(s.ng) * side <= 0 || is_black(weight) || next.fresnel < 1e-3) return kBlack;
  next.origin = s.p + s.ng * (side * kOffset);
  next.within = s.optics.volume && s.inside == (side > 0) ? s.material : nullptr;
  return weight * static_cast<double>(kinds.size()) * radiance(next, random);
}

Vec PathReference::refracted(const Surface& s, const Ray& ray, Random& random) const {
  if (!s.optics.refracts || ray.generation >= max_depth_ + (ray.gathers ? 8 : 0)) return kBlack;
  Ray next = ray;
  ++next.generation;
  const double eta = s.is_interface() ? 1.0 / s.optics.ior : double{s.optics.ior};
  const double cosine = std::min(s.inside ? std::max(s.nv, s.ng.dot(s.view)) : s.nv, 1.0);
  if (s.optics.counts_in_cutoff) next.fresnel *= 1 - exact_reflectance(cosine, eta);
  if (next.fresnel < 1e-3) return kBlack;
  Vec weight = s.is_interface() ? Vec(1, 1, 1) : s.base();
  weight *= (1.0 - s.material->metallic) * s.material->transmission * s.entered() * s.below_coat();
  next.origin = s.p - s.ng * kOffset;
  if (s.optics.bent) {
    Vec n = s.n;
    double c = std::min(s.nv, 1.0), sine2 = (1 - c * c) / (eta * eta);
    if (sine2 >= 1 && s.inside) {
      n = s.ng;
      c = std::min(std::max(s.ng.dot(s.view), s.nv), 1.0);
      sine2 = (1 - c * c) / (eta * eta);
    }
    if (sine2 >= 1) return kBlack;
    next.way = (ray.way / eta + n * (c / eta - std::sqrt(1 - sine2))).normalized();
    next.is_eye = false;
    next.within = s.inside ? nullptr : s.material;
  }
  return weight * radiance(next, random);
}

Vec PathReference::radiance(const Ray& ray, Random& random) const {
  const Found found = nearest(ray.origin, ray.way);
  Vec sum = crossed(ray, found.triangle ? found.t : 1e31);
  if (!found.triangle) return sum + surroundings(ray);
  const Surface s = surface_at(found, ray.way, ray.floor);
  const Material& material = *s.material;
  const double coverage = s.coverage();
  Vec own = kBlack;
  if (material.model == IlluminationModel::unlit) {
    own = s.base();
  } else {
    if (ray.is_eye || ray.meets_lights)
      own += color_of(material.emissive) * (material.emissive_strength * s.below_coat());
    if (!ray.gathers) own += gathered(s, ray, random) + scattered(s, ray, random);
    if (!s.blurs() || ray.gathers) own += refracted(s, ray, random);
  }
  sum += own * coverage;
  if (coverage < 1 && ray.straight < 16) {
    Ray straight = ray;
    straight.origin = s.p - s.ng * kOffset;
    ++straight.straight;
    sum += radiance(straight, random) * (1 - coverage);
  }
  if (ray.within != nullptr && std::isfinite(ray.within->attenuation_distance))
    for (int c = 0; c < 3; ++c)
      sum[c] *= std::pow(double{ray.within->attenuation_color[c]}, found.t / ray.within->attenuation_distance);
  return sum;
}

std::vector<PathReference::Pixel> PathReference::pixels(unsigned samples, std::uint64_t seed) const {
  const Camera& camera = scene_.camera;
  Random random(seed);
  std::vector<Pixel> result;
  for (std::uint32_t y = 0; y < camera.height; ++y) {
    for (std::uint32_t x = 0; x < camera.width; ++x) {
      Vec sum = kBlack, squares = kBlack;
      for (unsigned k = 0; k < samples; ++k) {
        const double across = x + number(random), down = y + number(random);
        const Vec value = radiance(eye_ray(across, down), random);
        sum += value;
        squares += value * value;
      }
      const Vec mean = sum / samples;
      result.push_back({mean, (squares / samples - mean * mean) / (samples - 1.0)});
    }
  }
  return result;
}

}  // namespace relook
