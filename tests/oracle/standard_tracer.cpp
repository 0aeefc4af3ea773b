#include "standard_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "light/environment_light.h"
#include "light/point_set.h"
#include "light/spherical_rect.h"
#include "path_reference_light.h"
#include "path_reference_surface.h"
#include "physics/lobe_shares.h"
#include "pi.h"

namespace relook {
namespace {

constexpr double kBeyond = 1e30, kLift = 1e-6;

double brightness(const Vec& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }
double power_weight(double own, double other) { return own * own / (own * own + other * other); }

struct Axes {
  Vec x, y;
};
Axes axes_around(const Vec& n) {
  const Vec x = tilted(n, 0, 0);
  return {x, n.cross(x)};
}

/// A rectangle from a place, sampled evenly over its solid angle.
struct SeenRect {
  Vec right, up, back;  // unit
  SphericalRect rect;

  [[nodiscard]] double density() const { return rect.is_regular() ? 1 / rect.solid_angle() : 0; }
  [[nodiscard]] Vec to(const Uv& u) const {
    const PlanePoint at = rect.point(u);
    return right * at.x + up * at.y - back * rect.height();
  }
};
SeenRect seen_rect(const Light& light, const Vec& from) {
  const Vec to = Vec(light.position) - from, right = Vec(light.right).normalized(), up = Vec(light.up).normalized();
  const double x = to.dot(right), y = to.dot(up), a = Vec(light.right).length(), b = Vec(light.up).length();
  const Vec back(light.direction);
  return {right, up, back, SphericalRect(x - a, x + a, y - b, y + b, -to.dot(back))};
}

}  // namespace

/// Stratified over a pixel's samples, independent from vertex to vertex and purpose to purpose.
class StandardTracer::Numbers {
 public:
  Numbers(std::uint32_t pixel, std::uint32_t sample, std::uint64_t seed, bool is_stratified)
      : key_{pixel, is_stratified ? sample : 0}, history_(child_history(seed, is_stratified ? 0 : sample)) {}

  [[nodiscard]] Uv point(Purpose purpose, std::uint64_t name = 0) const {
    return sample_point(key_, history_, purpose, name);
  }
  [[nodiscard]] double number(Purpose purpose, std::uint64_t name = 0) const {
    return sample_number(key_, history_, purpose, name);
  }
  void next_vertex() { history_ = child_history(history_, 1); }

 private:
  SampleKey key_;
  std::uint64_t history_;
};

StandardTracer::StandardTracer(const Scene& scene, const ViewOptions& view, SamplingRules rules)
    : PathReference(scene, view.diffuse_depth, view.max_depth, view.glossy_depth),
      rules_(rules),
      threshold_(rules.split ? double{EnvironmentLight(scene.environment.image).threshold()} : 0),
      map_(map_of_samples()) {}

LuminanceMap StandardTracer::map_of_samples() const {
  const auto& image = scene_.environment.image;
  if (!image) return LuminanceMap(1, 1, [](auto, auto) { return 0.0; });
  const std::uint32_t width = image->levels[0].width, height = image->levels[0].height;
  return LuminanceMap(width, height, [&](std::uint32_t column, std::uint32_t row) {
    const Uv uv((static_cast<float>(column) + 0.5F) / static_cast<float>(width),
                (static_cast<float>(row) + 0.5F) / static_cast<float>(height));
    const Rgba texel = relook::sample(*image, uv, 0, {Wrap::repeat, Wrap::clamp});
    return std::max(brightness(Vec(texel.r, texel.g, texel.b)) - threshold_, 0.0);
  });
}

StandardTracer::Surroundings StandardTracer::seen(const Vec& way) const {
  Ray ray{};
  ray.way = way;
  const Vec all = surroundings(ray);
  if (map_.empty()) return {Vec(0, 0, 0), all};
  const Environment& environment = scene_.environment;
  const double tint = brightness(color_of(environment.color)) * environment.intensity;
  const double sky = std::min(threshold_ * tint / std::max(brightness(all), 1e-30), 1.0);
  return {all * (1 - sky), all * sky};
}

StandardTracer::Lobes StandardTracer::lobes_of(const Surface& s) const {
  Lobes lobes{};
  if (rules_.plain_shares) {
    const double reflectance = exact_reflectance(std::min(s.nv, 1.0), s.material->ior);
    const bool is_metal = s.material->metallic == 1;
    const LobeShares shares = lobe_shares({!is_metal, true, false}, bucket_of_metallic(s.material->metallic),
                                          static_cast<float>(reflectance), 0);
    const double specular = is_metal ? 1 : std::max(double{shares.specular}, rules_.least_specular);
    lobes.share = {1 - specular, specular};
  } else {
    const double below = brightness(s.base()) * (1.0 - s.material->metallic) * s.entered();
    const double above = brightness(s.reflectance(s.nv));
    lobes.share = {below / (below + above), above / (below + above)};
  }
  lobes.alpha = s.alpha;
  if (rules_.buckets) {
    const AlphaBucket bucket = bucket_of_alpha(static_cast<float>(s.alpha));
    lobes.alpha = bucket.representative();
    lobes.even = bucket.lower() >= 0.25F ? 0.1 : 0;
  }
  return lobes;
}

Vec StandardTracer::drawn(const Surface& s, const Lobes& lobes, Kind kind, const Uv& u) {
  if (kind == kDiffuse) return tilted(s.n, std::sqrt(1 - double{u.x}), 2 * kPi * u.y);
  if (u.x < lobes.even) return tilted(s.n, std::sqrt(1 - u.x / lobes.even), 2 * kPi * u.y);
  const double first = (u.x - lobes.even) / (1 - lobes.even);
  // A visible normal (Dupuy and Benyoub 2023).
  const auto [x, y] = axes_around(s.n);
  Vec view(s.view.dot(x), s.view.dot(y), 0);
  view *= std::sqrt(std::max(1 - s.nv * s.nv, 0.0) / std::max(view.length2(), 1e-30));
  const Vec stretched = Vec(view.x * lobes.alpha, view.y * lobes.alpha, std::min(s.nv, 1.0)).normalized();
  const double z = (1 - first) * (1 + stretched.z) - stretched.z, sine = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  const Vec cap = Vec(sine * std::cos(2 * kPi * u.y), sine * std::sin(2 * kPi * u.y), z) + stretched;
  const Vec h = (x * (cap.x * lobes.alpha) + y * (cap.y * lobes.alpha) + s.n * cap.z).normalized();
  return (h * (2 * s.view.dot(h)) - s.view).normalized();
}

double StandardTracer::density_of(const Surface& s, const Lobes& lobes, Kind kind, const Vec& way) {
  if (way.dot(s.ng) <= 0) return 0;
  const double even = std::max(s.n.dot(way), 0.0) / kPi;
  if (kind == kDiffuse) return even;
  const Vec h = (s.view + way).normalized();
  const double nh = s.n.dot(h), vh = s.view.dot(h), a2 = lobes.alpha * lobes.alpha, nv = std::min(s.nv, 1.0);
  if (nh <= 0 || vh <= 0) return lobes.even * even;
  const double d = nh * nh * a2 + (h - s.n * nh).length2();
  const double seen = 2 / (nv + std::sqrt(nv * nv * (1 - a2) + a2));
  return lobes.even * even + (1 - lobes.even) * a2 / (kPi * d * d) * seen / 4;
}

Vec StandardTracer::weighed(const Surface& s, const Lobes& lobes, const Vec& way, double density) const {
  const double diffuse = lobes.share[kDiffuse] * density_of(s, lobes, kDiffuse, way);
  const double specular = lobes.share[kSpecular] * density_of(s, lobes, kSpecular, way);
  if (!rules_.apart) return (s.diffuse(way) + s.specular(way)) * (power_weight(density, diffuse + specular) / density);
  return (s.diffuse(way) * power_weight(density, diffuse) + s.specular(way) * power_weight(density, specular)) /
         density;
}

Vec StandardTracer::gathered(const Surface& s, const Lobes& lobes, const Numbers& numbers) const {
  Vec sum(0, 0, 0);
  const auto add = [&](const Vec& way, double distance, double density, const Vec& radiance) {
    const Vec light = s.n.dot(way) > 0 ? weighed(s, lobes, way, density) * radiance : Vec(0, 0, 0);
    if (largest(light) > 0) sum += light * passed(segment_origin(s, way), way, distance, true);
  };
  for (const LightId id : scene_.light_order) {
    const Light& light = scene_.light(id);
    if (light.kind != LightKind::rect) continue;
    const SeenRect rect = seen_rect(light, s.p);
    if (rect.density() == 0) continue;
    const Vec to = rect.to(numbers.point(Purpose::light, name_hash(light.node)));
    add(to.normalized(), to.length(), rect.density(), radiance_of(light));
  }
  if (!map_.empty()) {
    const Uv u = numbers.point(Purpose::light);
    const Vec way = map_.draw(u.x, u.y);
    if (const double density = map_.density(way); density > 0) add(way, kBeyond, density, seen(way).sampled);
  }
  return sum;
}

Vec StandardTracer::met(const Step& step, const Found& found) const {
  const double end = found.triangle != nullptr ? found.t : kBeyond;
  Vec sum(0, 0, 0);
  for (const LightId id : scene_.light_order) {
    const Light& light = scene_.light(id);
    if (light.kind != LightKind::rect || (!step.density && !light.visible)) continue;
    const auto t = crossing(light, step.ray.origin, step.ray.way);
    if (!t || *t >= end) continue;
    const double other = seen_rect(light, step.ray.origin).density();
    sum += radiance_of(light) * (step.density ? power_weight(*step.density, other) : 1);
  }
  if (found.triangle != nullptr) return sum;
  const Surroundings all = seen(step.ray.way);
  return sum + all.rest + all.sampled * (step.density ? power_weight(*step.density, map_.density(step.ray.way)) : 1);
}

std::optional<StandardTracer::Step> StandardTracer::scattered(const Surface& s, const Lobes& lobes, const Step& before,
                                                              const Numbers& numbers) const {
  const Kind drawing = numbers.number(Purpose::lobe) < lobes.share[kDiffuse] ? kDiffuse : kSpecular;
  const Vec way = drawn(s, lobes, drawing, numbers.point(Purpose::lobe));
  const Vec values[] = {s.diffuse(way), s.specular(way)};
  double density = lobes.share[drawing] * density_of(s, lobes, drawing, way);
  Vec reflected = values[drawing];
  // Depths and floors follow a lobe. Where the ray is of both, one of them is drawn by what it reflects, so that what
  // is scattered further on has the mean of the two.
  Kind kind = drawing;
  double share = 1;
  if (!rules_.apart) {
    density += lobes.share[1 - drawing] * density_of(s, lobes, drawing == kDiffuse ? kSpecular : kDiffuse, way);
    reflected = values[kDiffuse] + values[kSpecular];
    const double diffuse = brightness(values[kDiffuse]) / std::max(brightness(reflected), 1e-300);
    kind = numbers.number(Purpose::coverage) < diffuse ? kDiffuse : kSpecular;
    share = kind == kDiffuse ? diffuse : 1 - diffuse;
  }
  if (!(density > 0) || largest(reflected) <= 0 || share <= 0) return std::nullopt;
  Step next{before.ray, before.on * reflected / density, before.on * values[kind] / (density * share), density};
  Ray& ray = next.ray;
  ray.origin = s.p + s.ng * kLift;
  ray.way = way;
  ray.is_eye = false;
  ++(kind == kDiffuse ? ray.diffuse : ray.glossy);
  const bool is_last = before.ray.generation >= max_depth_;
  ray.gathers = is_last || ray.diffuse > diffuse_depth_ || ray.glossy > glossy_depth_;
  ++ray.generation;
  const double bucket = bucket_of_alpha(static_cast<float>(s.alpha)).lower();
  ray.floor = std::max(ray.floor, kind == kDiffuse ? 0.25 : std::min(bucket, 0.25));
  return next;
}

Vec StandardTracer::sample(const Ray& eye, Numbers numbers) const {
  Step step{eye, Vec(1, 1, 1), Vec(1, 1, 1), std::nullopt};
  Vec sum(0, 0, 0);
  for (;;) {
    const Found found = nearest(step.ray.origin, step.ray.way);
    sum += step.met * met(step, found);
    if (found.triangle == nullptr || step.ray.gathers) return sum;
    const Surface s = surface_at(found, step.ray.way, step.ray.floor);
    const Lobes lobes = lobes_of(s);
    sum += step.on * gathered(s, lobes, numbers);
    const std::optional<Step> next = scattered(s, lobes, step, numbers);
    if (!next) return sum;
    step = *next;
    numbers.next_vertex();
  }
}

std::vector<Vec> StandardTracer::pixels(std::uint32_t samples, std::uint64_t seed) const {
  const Camera& camera = scene_.camera;
  std::vector<Vec> pixels(std::size_t{camera.width} * camera.height, Vec(0, 0, 0));
  parallel_for(camera.height, [&](std::size_t row) {
    const auto y = static_cast<std::uint32_t>(row);
    for (std::uint32_t x = 0; x < camera.width; ++x) {
      Vec& pixel = pixels[row * camera.width + x];
      for (std::uint32_t k = 0; k < samples; ++k) {
        const Numbers numbers(pixel_key(x, y), k, child_history(seed + 1, 7), !rules_.unstratified);
        const Uv at = numbers.point(Purpose::pixel);
        pixel += sample(eye_ray(x + double{at.x}, y + double{at.y}), numbers) / samples;
      }
    }
  });
  return pixels;
}

}  // namespace relook
