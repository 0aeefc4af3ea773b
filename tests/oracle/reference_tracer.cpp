// The oracle's rays: the nearest surface, what stands before a light, what a ray brings.
#include "reference_tracer.h"

#include <algorithm>
#include <cmath>

#include "pi.h"

namespace relook {
namespace {

constexpr double kOffset = 1e-5;

Imath::V3f single(Vec v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

}  // namespace

ReferenceTracer::ReferenceTracer(const Scene& scene, std::uint32_t max_depth) : scene_(scene), max_depth_(max_depth) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (!object.alive) continue;
    if (object.deformation || object.displacement) shaped_[i] = shaped_mesh(scene, object);
    for (const WorldTriangle& triangle : world_triangles(scene, i)) triangles_.push_back(triangle);
  }
}

ReferenceTracer::Found ReferenceTracer::nearest(Vec origin, Vec direction) const {
  Found best;
  for (const WorldTriangle& triangle : triangles_) {
    const LineHit hit = intersect(triangle, origin, direction);
    if (!hit.inside || hit.t <= 0 || (best.triangle && hit.t > best.t)) continue;
    if (best.triangle && hit.t == best.t) {  // the tie rule: object key, then primitive
      const std::uint64_t key = scene_.objects[triangle.object].key, old = scene_.objects[best.triangle->object].key;
      if (key > old || (key == old && triangle.primitive > best.triangle->primitive)) continue;
    }
    if (is_met(triangle, hit, direction)) best = {&triangle, hit.t, hit.u, hit.v};
  }
  return best;
}

Vec ReferenceTracer::tint_of(const Found& crossing, Vec direction, double inside_length, double footprint) const {
  Surface s = surface_at(crossing, {Vec(0, 0, 0), direction, 0, 0});
  s.width = footprint;
  s.incidence = 1;
  s.with_level = true;
  read_material(s);
  const Material& m = *s.material;
  if (!s.optics.passes_light) return Vec(0, 0, 0);
  Vec through(0, 0, 0);
  if (m.model == IlluminationModel::metallic_roughness)
    through = (s.optics.volume && s.inside ? Vec(1, 1, 1) : s.base) * s.transmission * (1 - s.metallic);
  if (m.model == IlluminationModel::blinn_phong)
    through = s.base * std::min(1.0, double{m.refraction} + m.transparency);
  if (s.optics.volume && s.inside && std::isfinite(m.attenuation_distance))
    for (int c = 0; c < 3; ++c)
      through[c] *= std::pow(double{m.attenuation_color[c]}, inside_length / m.attenuation_distance);
  return Vec(1, 1, 1) * (1 - s.coverage) + through * s.coverage;
}

Vec ReferenceTracer::visibility(Vec p, Vec toward, double distance, double footprint) const {
  std::vector<Found> crossings;
  for (const WorldTriangle& triangle : triangles_) {
    const LineHit hit = intersect(triangle, p, toward);
    if (hit.inside && hit.t > 0 && hit.t < distance && is_met(triangle, hit, -toward))
      crossings.push_back({&triangle, hit.t, hit.u, hit.v});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Found& a, const Found& b) { return a.t < b.t; });
  Vec light(1, 1, 1);
  std::map<std::uint32_t, double> entered;  // object -> where the segment last went in
  for (const Found& crossing : crossings) {
    const std::uint32_t object = crossing.triangle->object;
    light *= tint_of(crossing, toward, crossing.t - entered[object], footprint);
    entered[object] = crossing.t;
  }
  return light;
}

std::vector<ReferenceTracer::Arriving> ReferenceTracer::lamps(const Surface& s) const {
  std::vector<Arriving> arriving;
  for (const LightId id : scene_.light_order) {
    const Light& light = scene_.light(id);
    Vec toward = -Vec(light.direction), irradiance = color_of(light.color) * double{light.intensity};
    double distance = 1e9;
    if (light.kind != LightKind::directional) {
      const Vec way = Vec(light.position) - s.p;
      distance = way.length();
      toward = way / distance;
      irradiance *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0) / std::max(distance * distance, 1e-8);
    }
    if (light.kind == LightKind::spot) {
      const double outer = std::cos(double{light.outer_cone}), inner = std::cos(double{light.inner_cone});
      const double t = (Vec(light.direction).dot(-toward) - outer) / (inner - outer);
      irradiance *= std::pow(std::clamp(t, 0.0, 1.0), 2);
    }
    if (s.smooth.dot(toward) <= 0) continue;
    const Vec start = s.p + s.lift * std::clamp(1 - s.ng.dot(toward) / 0.1, 0.0, 1.0) + s.ng * kOffset;
    const Vec way = light.kind == LightKind::directional ? toward * distance : Vec(light.position) - start;
    arriving.push_back({toward, irradiance * visibility(start, way.normalized(), way.length(), s.width / s.incidence)});
  }
  return arriving;
}

Vec ReferenceTracer::environment(Vec direction) const {
  const Environment& environment = scene_.environment;
  Vec value = color_of(environment.color) * double{environment.intensity};
  if (!environment.image) return value;
  const double turned = std::atan2(direction.x, -direction.z) + environment.rotation;
  const Uv uv(static_cast<float>(0.5 + turned / (2 * kPi)), static_cast<float>(std::acos(direction.y) / kPi));
  const Rgba texel = sample(*environment.image, uv, 0, {Wrap::repeat, Wrap::clamp});
  return value * Vec(texel.r, texel.g, texel.b);
}

ReferenceTracer::Answer ReferenceTracer::spawn(const Surface& s, const Ray& ray, Vec direction, double fresnel) const {
  if (ray.generation >= max_depth_ || ray.fresnel * fresnel < 1e-3) return {};
  const Vec origin = s.p + s.ng * (direction.dot(s.ng) > 0 ? kOffset : -kOffset);
  return trace({origin, direction, s.width, ray.spread, ray.generation + 1, ray.fresnel * fresnel, ray.channel});
}

ReferenceTracer::Answer ReferenceTracer::trace(const Ray& ray) const {
  const Found found = nearest(ray.origin, ray.direction);
  if (!found.triangle) return {environment(ray.direction), 0, 0};
  const Surface s = surface_at(found, ray);
  Answer answer{s.base, s.coverage, found.t};
  if (s.material->model == IlluminationModel::metallic_roughness) answer.color = metallic_roughness(s, ray);
  if (s.material->model == IlluminationModel::blinn_phong) answer.color = blinn_phong(s, ray);
  if (!s.optics.transparent) return answer;
  const Answer behind = spawn(s, ray, ray.direction, 1);
  if (s.material->model == IlluminationModel::blinn_phong)
    answer.color += behind.color * double{s.material->transparency};
  answer.color = answer.color * s.coverage + behind.color * (1 - s.coverage);
  answer.alpha = s.coverage + (1 - s.coverage) * behind.alpha;
  return answer;
}

Frame ReferenceTracer::frame() const {
  const Camera& camera = scene_.camera;
  Frame frame{camera.width, camera.height, {}};
  for (std::uint32_t y = 0; y < camera.height; ++y) {
    for (std::uint32_t x = 0; x < camera.width; ++x) {
      const CameraRay ray = camera_ray(camera, static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      const Vec start = Vec(ray.origin) + Vec(ray.direction) * double{ray.start};
      const double width = double{ray.width} + double{ray.spread} * double{ray.start};
      const Answer answer = trace({start, Vec(ray.direction), width, ray.spread, 1, 1});
      const Imath::V3f color = single(answer.color);
      frame.pixels.emplace_back(color.x, color.y, color.z, static_cast<float>(answer.alpha));
    }
  }
  return frame;
}

}  // namespace relook
