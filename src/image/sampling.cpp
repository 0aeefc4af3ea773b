#include "image/sampling.h"

#include <algorithm>
#include <cmath>

#include "physics/cosine_sample.h"

namespace relook {
namespace {

/// Position of sample k of n in the unit pixel: a regular grid for square n, else a Hammersley point set.
Uv position_in_pixel(std::uint32_t k, std::uint32_t n) {
  std::uint32_t side = 1;
  while (side * side < n) ++side;
  const auto of = [](std::uint32_t i, std::uint32_t count) {
    return (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
  };
  if (side * side == n) return Uv(of(k % side, side), of(k / side, side));
  float reversed = 0, digit = 0.5F;
  for (std::uint32_t bits = k; bits != 0; bits >>= 1, digit *= 0.5F)
    if ((bits & 1U) != 0) reversed += digit;
  return Uv(of(k, n), std::min(reversed + 0.5F / static_cast<float>(n), 0.999F));
}

/// The ray of the same place in the image through another place of the lens.
CameraRay through_lens(const Camera& camera, const Lens& lens, const CameraRay& ray, const Uv& on_lens) {
  const DiscPlace at(on_lens);
  const float across = lens.radius * at.radius;
  const Direction aside =
      camera.right * (across * portable_cos_turns(at.turns)) + camera.up * (across * portable_sin_turns(at.turns));
  const Direction way = ray.direction * (lens.focus / ray.direction.dot(camera.forward)) - aside;
  const float scale = 1.0F / std::sqrt(way.dot(way));
  const Direction direction = way * scale;
  const float slant = 1.0F / direction.dot(camera.forward);
  return {ray.origin + aside, direction, ray.spread, ray.width, camera.near * slant, camera.far * slant};
}

}  // namespace

PrimaryRays::PrimaryRays(const Camera& camera, const ViewOptions& view)
    : camera_(camera), lens_(view.lens), is_path_(view.integrator == Integrator::path) {
  for (std::uint32_t k = 0; k < view.samples; ++k) in_pixel_.push_back(position_in_pixel(k, view.samples));
}

SpawnedRay PrimaryRays::through(std::uint32_t x, std::uint32_t y, std::uint32_t k) const {
  const SampleKey key{pixel_key(x, y), k};
  const Uv place = is_path_ ? sample_point(key, 0, Purpose::pixel) : in_pixel_[k];
  CameraRay ray = camera_ray(camera_, static_cast<float>(x) + place.x, static_cast<float>(y) + place.y);
  if (lens_.radius > 0) ray = through_lens(camera_, lens_, ray, sample_point(key, 0, Purpose::lens));
  SpawnedRay primary{ray.origin, ray.direction, ray.width, ray.spread};
  if (is_path_) primary.path.key = key;
  primary.start = ray.start;
  primary.end = ray.end;
  return primary;
}

SpawnedRay PrimaryRays::ray(const TileRect& rect, std::uint32_t sample) const {
  const auto samples = static_cast<std::uint32_t>(in_pixel_.size());
  const std::uint32_t pixel = sample / samples, width = rect.width();
  return through(rect.x0 + pixel % width, rect.y0 + pixel / width, sample % samples);
}

void PrimaryRays::append(const TileRect& rect, std::uint32_t first, std::uint32_t last,
                         std::vector<SpawnedRay>& rays) const {
  const auto samples = static_cast<std::uint32_t>(in_pixel_.size());
  const std::uint32_t width = rect.width();
  std::uint32_t k = first % samples, x = first / samples % width, y = first / samples / width;
  for (std::uint32_t sample = first; sample < last; ++sample) {
    rays.push_back(through(rect.x0 + x, rect.y0 + y, k));
    if (++k < samples) continue;
    k = 0;
    if (++x < width) continue;
    x = 0;
    ++y;
  }
}

Rgba pixel_color(const Rgba* samples, std::uint32_t count) {
  if (count == 1) return samples[0];
  Rgba sum = samples[0];
  for (std::uint32_t k = 1; k < count; ++k) sum = sum + samples[k];
  const auto n = static_cast<float>(count);
  return Rgba(sum.r / n, sum.g / n, sum.b / n, sum.a / n);
}

}  // namespace relook
