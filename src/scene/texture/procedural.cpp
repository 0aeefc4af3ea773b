#include "scene/texture/procedural.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "base/vector_clones.h"

namespace relook {
namespace {

// Inlined by force: only then is the loop over lanes vectorised for each instruction set.
[[gnu::always_inline]] inline std::uint32_t lattice_hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t h = x * 0x8DA6B343U + y * 0xD8163841U + z * 0xCB1AB31FU;
  h ^= h >> 15;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12;
  h *= 0x297A2D39U;
  return h ^ (h >> 15);
}

[[gnu::always_inline]] inline float gradient(std::uint32_t hash, float x, float y, float z) {
  const std::uint32_t h = hash & 15U;
  const float u = h < 8 ? x : y;
  const float v = h < 4 ? y : (((h == 12) | (h == 14)) ? x : z);
  return ((h & 1U) != 0 ? -u : u) + ((h & 2U) != 0 ? -v : v);
}

[[gnu::always_inline]] inline float fade(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }
[[gnu::always_inline]] inline float mix(float a, float b, float t) { return a + t * (b - a); }

/// Gradient noise, about [-1, 1], 0 on the integer lattice: the fade curve and gradients of K. Perlin, Improving Noise
/// (2002), with an integer hash for the permutation table.
[[gnu::always_inline]] inline float noise(float px, float py, float pz) {
  const float fx = portable_floor(px), fy = portable_floor(py), fz = portable_floor(pz);
  const auto ix = static_cast<std::uint32_t>(static_cast<std::int32_t>(fx));
  const auto iy = static_cast<std::uint32_t>(static_cast<std::int32_t>(fy));
  const auto iz = static_cast<std::uint32_t>(static_cast<std::int32_t>(fz));
  const float x = px - fx, y = py - fy, z = pz - fz;
  const float u = fade(x), v = fade(y), w = fade(z);
  const float x1 = x - 1.0F, y1 = y - 1.0F, z1 = z - 1.0F;
  const float low = mix(
      mix(gradient(lattice_hash(ix, iy, iz), x, y, z), gradient(lattice_hash(ix + 1, iy, iz), x1, y, z), u),
      mix(gradient(lattice_hash(ix, iy + 1, iz), x, y1, z), gradient(lattice_hash(ix + 1, iy + 1, iz), x1, y1, z), u),
      v);
  const float high = mix(
      mix(gradient(lattice_hash(ix, iy, iz + 1), x, y, z1), gradient(lattice_hash(ix + 1, iy, iz + 1), x1, y, z1), u),
      mix(gradient(lattice_hash(ix, iy + 1, iz + 1), x, y1, z1),
          gradient(lattice_hash(ix + 1, iy + 1, iz + 1), x1, y1, z1), u),
      v);
  return mix(low, high, w);
}

constexpr float kLargest = 0x1p22F;

/// Clamps coordinates to kLargest, where floats are half a cycle apart: finer octaves stand still there. A loop of its
/// own, since in add_octave() it would keep the compiler from vectorising.
void bound(std::vector<float>& coordinates) {
  for (float& x : coordinates) {
    x = x > -kLargest ? x : -kLargest;
    x = x < kLargest ? x : kLargest;
  }
}

/// sum[i] += strength * noise(p[i]), and p moves on to the next octave.
RELOOK_VECTOR_CLONES
void add_octave(std::size_t lanes, float strength, float* __restrict x, float* __restrict y, float* __restrict z,
                float* __restrict sum) {
  for (std::size_t i = 0; i < lanes; ++i) {
    sum[i] += strength * noise(x[i], y[i], z[i]);
    x[i] = x[i] * 2.0F + 17.0F;
    y[i] = y[i] * 2.0F + 31.0F;
    z[i] = z[i] * 2.0F + 47.0F;
  }
}

/// Positions in cycles. Those beyond kLargest, and those that are not finite, read the origin.
struct Positions {
  std::vector<float> x, y, z;

  Positions(const Procedural& t, std::span<const float> px, std::span<const float> py, std::span<const float> pz)
      : x(px.begin(), px.end()), y(py.begin(), py.end()), z(pz.begin(), pz.end()) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] *= t.scale;
      y[i] *= t.scale;
      z[i] *= t.scale;
      const bool is_near = std::fabs(x[i]) <= kLargest && std::fabs(y[i]) <= kLargest && std::fabs(z[i]) <= kLargest;
      if (!is_near) x[i] = y[i] = z[i] = 0;
    }
  }
};

/// Sum of octaves of noise, each twice as fine and half as strong; about [-1, 1].
std::vector<float> fractal_noise(Positions p, std::int32_t octaves) {
  std::vector<float> sum(p.x.size(), 0.0F);
  float strength = 1, total = 0;
  for (std::int32_t i = 0; i < octaves; ++i) {
    bound(p.x);
    bound(p.y);
    bound(p.z);
    add_octave(sum.size(), strength, p.x.data(), p.y.data(), p.z.data(), sum.data());
    total += strength;
    strength *= 0.5F;
  }
  for (float& value : sum) value = value / total;
  return sum;
}

float checker(float x, float y, float z) {
  constexpr float kNudge = 1e-4F;  // planes through the lattice fall to one side
  const float sum = portable_floor(x + kNudge) + portable_floor(y + kNudge) + portable_floor(z + kNudge);
  return sum - 2.0F * portable_floor(sum * 0.5F);
}

float pattern(const Procedural& t, float x, float z, float noise_value) {
  if (t.kind == ProceduralKind::marble) return 0.5F + 0.5F * portable_sin_turns(x + 2.0F * t.turbulence * noise_value);
  if (t.kind == ProceduralKind::noise) return 0.5F + t.turbulence * noise_value;
  const float rings = std::sqrt(x * x + z * z) + 0.25F * t.turbulence * noise_value;
  return rings - portable_floor(rings);
}

}  // namespace

void procedural_weights(const Procedural& texture, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> weight) {
  const Positions p(texture, x, y, z);
  if (texture.kind == ProceduralKind::checker) {
    for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = checker(p.x[i], p.y[i], p.z[i]);
    return;
  }
  const std::vector<float> noise_values = fractal_noise(p, texture.octaves);
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = std::clamp(pattern(texture, p.x[i], p.z[i], noise_values[i]), 0.0F, 1.0F);
}

Rgba evaluate(const Procedural& texture, Point position) {
  float weight = 0;
  procedural_weights(texture, {&position.x, 1}, {&position.y, 1}, {&position.z, 1}, {&weight, 1});
  const Color a = texture.color1, b = texture.color2;
  const float rest = 1.0F - weight;
  return Rgba(a.x * rest + b.x * weight, a.y * rest + b.y * weight, a.z * rest + b.z * weight, 1.0F);
}

}  // namespace relook
