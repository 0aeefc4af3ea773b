// What sampling may read of a material's values: the buckets in which an alpha and a metallic value lie. Edits within a
// bucket keep every ray.
#pragma once
#include <bit>
#include <cstdint>

#include "physics/scalar.h"

namespace relook {

/// The alphas in [2^k, 2^(k+1)), for k from -9 on; [1/2, 1] for k = -1, so that the usual roughness of 1 has no bucket
/// to itself; everything below 2^-9 lies in the lowest (alpha_of is never that narrow).
struct AlphaBucket {
  std::int8_t k;

  static constexpr int kLowest = -9, kHighest = -1;

  [[nodiscard]] constexpr float lower() const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(k + 127) << 23);
  }
  /// 2^(k + 1/2): the alpha whose density samples all lobes of the bucket.
  [[nodiscard]] constexpr float representative() const { return lower() * 1.41421356F; }

  auto operator<=>(const AlphaBucket&) const = default;
};

[[nodiscard]] constexpr AlphaBucket bucket_of_alpha(float alpha) {
  constexpr float kLeast = AlphaBucket{AlphaBucket::kLowest}.lower();
  const float clamped = alpha > kLeast ? (alpha < 1.0F ? alpha : 1.0F) : kLeast;
  const int k = static_cast<int>(std::bit_cast<std::uint32_t>(clamped) >> 23) - 127;
  return {static_cast<std::int8_t>(k < AlphaBucket::kHighest ? k : AlphaBucket::kHighest)};
}

/// The exponents in [2^k, 2^(k+1)) of Blinn and Phong's lobe, for k from 0 on; those below 1 for k = -1.
struct ShininessBucket {
  std::int8_t k;

  /// The lower end: the exponent that samples all lobes of the bucket, none of which has a tail that it misses.
  [[nodiscard]] constexpr float representative() const {
    return k < 0 ? 0.0F : std::bit_cast<float>(static_cast<std::uint32_t>(k + 127) << 23);
  }
  /// Of GGX lobes about as wide as the narrowest of the bucket: alpha^2 = 2 / (n + 2) (Walter et al. 2007, section 5.2).
  [[nodiscard]] AlphaBucket as_alpha() const;

  auto operator<=>(const ShininessBucket&) const = default;
};

[[nodiscard]] constexpr ShininessBucket bucket_of_shininess(float shininess) {
  if (shininess < 1.0F) return {-1};
  return {static_cast<std::int8_t>(static_cast<int>(std::bit_cast<std::uint32_t>(shininess) >> 23) - 127)};
}

inline AlphaBucket ShininessBucket::as_alpha() const {
  const float end = k < 0 ? 1.0F : 2.0F * representative();
  return bucket_of_alpha(sqrt(2.0F / (end + 2.0F)));
}

/// A shininess whose lobe is about as wide as that of `alpha_floor`, or wider.
template <class S, class A>
[[nodiscard]] S floored_shininess(S shininess, A alpha_floor) {
  return min(shininess, 2.0F / max(square(alpha_floor), 1e-9F) - 2.0F);
}

/// The least alpha of reflecting lobes behind one of this bucket, on its own; 1/4 behind a diffuse one.
[[nodiscard]] constexpr float alpha_floor_behind(AlphaBucket bucket) {
  return bucket.lower() < 0.25F ? bucket.lower() : 0.25F;
}
inline constexpr float kAlphaFloorBehindDiffuse = 0.25F;

/// How much wider cones grow along a ray of a lobe, metres per metre: a fraction of what its directions spread by, as
/// neighbours in a pixel look at the same place. A diffuse lobe has an alpha of 1.
[[nodiscard]] constexpr float cone_spread_behind(AlphaBucket bucket) { return bucket.lower() * 0.25F; }
inline constexpr float kConeSpreadBehindDiffuse = 0.25F;

/// A roughness whose alpha is at least `alpha_floor`: a step up, as the square of a rounded root may be below it.
template <class S, class A>
[[nodiscard]] S floored(S roughness, A alpha_floor) {
  return max(roughness, sqrt(alpha_floor) * 1.0000001F);
}

enum class MetallicBucket : std::uint8_t { dielectric, mixed, metal };

/// Of a filtered value.
[[nodiscard]] constexpr MetallicBucket bucket_of_metallic(float metallic) {
  if (metallic < 1.0F / 64) return MetallicBucket::dielectric;
  return metallic > 63.0F / 64 ? MetallicBucket::metal : MetallicBucket::mixed;
}

}  // namespace relook
