#include "light/point_set.h"

#include "base/hash.h"
#include "base/vector_clones.h"
#include "light/point_lanes.h"

namespace relook {
namespace {

constexpr float kLastFloatBelowOne = 0x1.fffffep-1F;
constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio, odd (Steele et al. 2014, SplitMix)

/// A permutation of 64-bit numbers without visible structure ("mix13" of Stafford 2011, "Better Bit Mixing").
constexpr std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EB;
  return x ^ (x >> 31U);
}

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x << 16U) | (x >> 16U);
  x = ((x & 0x00FF00FFU) << 8U) | ((x >> 8U) & 0x00FF00FFU);
  x = ((x & 0x0F0F0F0FU) << 4U) | ((x >> 4U) & 0x0F0F0F0FU);
  x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
  return ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
}

/// Owen's nested uniform scrambling of a number whose bits stand in reverse: each bit is flipped or not by a hash of
/// the seed and of the bits below it. Every step is a permutation in which a bit depends on lower ones only (Laine and
/// Karras 2011, section 3.1). Steps and constants: Vegdahl 2021, "Building a Better LK Hash", but both the summand and
/// the odd factor come from a seed of 64 bits.
constexpr std::uint32_t scrambled_from_below(std::uint32_t x, std::uint64_t seed) {
  x ^= x * 0x3D20ADEAU;
  x += static_cast<std::uint32_t>(seed);
  x *= static_cast<std::uint32_t>(seed >> 32U) | 1U;
  x ^= x * 0x05526C56U;
  x ^= x * 0x53A22864U;
  return x;
}

/// Bits of the second coordinate of Sobol's point `index`, in reverse. Digit i is the sum over j >= i of binomial(j, i)
/// times bit j of the index, modulo 2: five steps, for the matrix is the Kronecker power of (1 1; 0 1).
constexpr std::uint32_t second_sobol_reversed(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0F0F0F0FU;
  index ^= (index >> 8U) & 0x00FF00FFU;
  return index ^ (index >> 16U);
}

constexpr float unit_number(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits >> 8U)) * 0x1p-24F;
}

/// Of the set that a number belongs to. `dimensions` keeps sets of points and of numbers apart.
constexpr std::uint64_t set_seed(std::uint32_t pixel, std::uint64_t history, Purpose purpose, std::uint64_t name,
                                 std::uint64_t dimensions) {
  const std::uint64_t who = (std::uint64_t{pixel} << 32U) | (dimensions << 8U) | static_cast<std::uint64_t>(purpose);
  return mixed(mixed(mixed(who + kGoldenGamma) + history) + name);
}

constexpr std::uint32_t shuffled(std::uint32_t sample, std::uint64_t seed) {
  return reversed(scrambled_from_below(reversed(sample), seed));
}

}  // namespace

std::uint32_t pixel_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = x ^ ((y << 16U) | (y >> 16U));
  // A permutation: Mueller 2012, "What integer hash function are good that accepts an integer hash key?".
  key = (key ^ (key >> 16U)) * 0x45D9F3BU;
  key = (key ^ (key >> 16U)) * 0x45D9F3BU;
  return key ^ (key >> 16U);
}

namespace {

[[gnu::always_inline]] inline void find_point(std::uint32_t pixel, std::uint32_t sample, std::uint64_t history,
                                              Purpose purpose, std::uint64_t name, float& out_x, float& out_y) {
  const std::uint64_t seed = set_seed(pixel, history, purpose, name, 2);
  const std::uint32_t index = shuffled(sample, seed);
  const std::uint32_t x = scrambled_from_below(index, mixed(seed + kGoldenGamma));
  const std::uint32_t y = scrambled_from_below(second_sobol_reversed(index), mixed(seed + 2 * kGoldenGamma));
  out_x = unit_number(reversed(x));
  out_y = unit_number(reversed(y));
}

}  // namespace

Uv sample_point(const SampleKey& key, std::uint64_t history, Purpose purpose, std::uint64_t name) {
  Uv point;
  find_point(key.pixel, key.sample, history, purpose, name, point.x, point.y);
  return point;
}

RELOOK_VECTOR_CLONES
void sample_points(const PointKeys& keys, Purpose purpose, std::uint64_t name, PointLanes& points) {
  for (std::size_t lane = 0; lane < kPointLanes; ++lane)
    find_point(keys.pixel[lane], keys.sample[lane], keys.history[lane], purpose, name, points.x[lane], points.y[lane]);
}

float sample_number(const SampleKey& key, std::uint64_t history, Purpose purpose, std::uint64_t name) {
  const std::uint64_t seed = set_seed(key.pixel, history, purpose, name, 1);
  return unit_number(reversed(scrambled_from_below(shuffled(key.sample, seed), mixed(seed + kGoldenGamma))));
}

float remapped(float number, float first, float share) {
  const float left = share > 0 ? (number - first) / share : 0.0F;
  return left > 0 ? (left < kLastFloatBelowOne ? left : kLastFloatBelowOne) : 0.0F;
}

std::uint64_t name_hash(std::string_view name) { return hash64(bytes_of(name)); }

std::uint64_t child_history(std::uint64_t history, std::uint32_t branch) {
  return mixed(history + (std::uint64_t{branch} + 1) * kGoldenGamma);
}

}  // namespace relook
