#include "scene/procedural.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace relook {
namespace {

std::uint32_t lattice_hash(std::int32_t x, std::int32_t y, std::int32_t z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8DA6B343U + static_cast<std::uint32_t>(y) * 0xD8163841U +
                    static_cast<std::uint32_t>(z) * 0xCB1AB31FU;
  h ^= h >> 15;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12;
  h *= 0x297A2D39U;
  return h ^ (h >> 15);
}

float gradient(std::uint32_t hash, float x, float y, float z) {
  const std::uint32_t h = hash & 15U;
  const float u = h < 8 ? x : y;
  const float v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
  return ((h & 1U) != 0 ? -u : u) + ((h & 2U) != 0 ? -v : v);
}

float fade(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }
float mix(float a, float b, float t) { return a + t * (b - a); }

/// Sum of octaves of noise, each twice as fine and half as strong; about [-1, 1].
float fractal_noise(Point p, std::int32_t octaves) {
  float sum = 0, strength = 1, total = 0;
  for (std::int32_t i = 0; i < octaves; ++i) {
    sum += strength * gradient_noise(p);
    total += strength;
    strength *= 0.5F;
    p = p * 2.0F + Point(17.0F, 31.0F, 47.0F);
  }
  return sum / total;
}

/// Keeps coordinates where the lattice is exact; anything else reads the origin.
Point bounded(Point p) {
  constexpr float kLargest = 1e6F;
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::fabs(p[axis]) <= kLargest)) return Point(0, 0, 0);
  return p;
}

/// The mixing weight of color2, in [0, 1].
float weight(const Procedural& t, Point p) {
  switch (t.kind) {
    case ProceduralKind::marble:
      return 0.5F + 0.5F * portable_sin_turns(p.x + 2.0F * t.turbulence * fractal_noise(p, t.octaves));
    case ProceduralKind::wood: {
      const float radius = std::sqrt(p.x * p.x + p.z * p.z);
      const float rings = radius + 0.25F * t.turbulence * fractal_noise(p, t.octaves);
      return rings - portable_floor(rings);
    }
    case ProceduralKind::checker: {
      constexpr float kNudge = 1e-4F;  // planes through the lattice fall to one side
      const float sum = portable_floor(p.x + kNudge) + portable_floor(p.y + kNudge) + portable_floor(p.z + kNudge);
      return sum - 2.0F * portable_floor(sum * 0.5F);
    }
    case ProceduralKind::noise:
      return 0.5F + t.turbulence * fractal_noise(p, t.octaves);
  }
  return 0;
}

}  // namespace

float gradient_noise(Point position) {
  const float fx = portable_floor(position.x), fy = portable_floor(position.y), fz = portable_floor(position.z);
  const auto ix = static_cast<std::int32_t>(fx), iy = static_cast<std::int32_t>(fy), iz = static_cast<std::int32_t>(fz);
  const float x = position.x - fx, y = position.y - fy, z = position.z - fz;
  const float u = fade(x), v = fade(y), w = fade(z);
  const auto corner = [&](std::int32_t dx, std::int32_t dy, std::int32_t dz) {
    return gradient(lattice_hash(ix + dx, iy + dy, iz + dz), x - static_cast<float>(dx), y - static_cast<float>(dy),
                    z - static_cast<float>(dz));
  };
  const float low = mix(mix(corner(0, 0, 0), corner(1, 0, 0), u), mix(corner(0, 1, 0), corner(1, 1, 0), u), v);
  const float high = mix(mix(corner(0, 0, 1), corner(1, 0, 1), u), mix(corner(0, 1, 1), corner(1, 1, 1), u), v);
  return mix(low, high, w);
}

Rgba evaluate(const Procedural& texture, Point position) {
  const float w = std::clamp(weight(texture, bounded(position * texture.scale)), 0.0F, 1.0F);
  const Color a = texture.color1, b = texture.color2;
  return Rgba(a.x * (1.0F - w) + b.x * w, a.y * (1.0F - w) + b.y * w, a.z * (1.0F - w) + b.z * w, 1.0F);
}

}  // namespace relook
