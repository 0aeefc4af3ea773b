// Where coverage sends a ray under Integrator::path: what sampling may read of it is the bucket of the filtered value,
// so that edits within a bucket keep every ray. Called per hit (trace/tree), and for edits of materials (edit/).
#pragma once
#include <cstdint>

namespace relook {

/// How much of a surface is there.
enum class CoverageBucket : std::uint8_t { none, little, half, most, all };

/// Of a filtered value: what texels of 0 or 1 alone are mixed to lies within kRounding of them.
[[nodiscard]] constexpr CoverageBucket bucket_of_coverage(float coverage) {
  constexpr float kRounding = 0x1p-20F;
  if (coverage < 1.0F / 64) return coverage < kRounding ? CoverageBucket::none : CoverageBucket::little;
  if (coverage > 63.0F / 64) return coverage > 1 - kRounding ? CoverageBucket::all : CoverageBucket::most;
  return CoverageBucket::half;
}

/// The share of the rays behind a scattering that go straight on; the others stop. Near 0 and 1 the rare way keeps
/// 1/64, so that no light is lost. The coverage, or the rest, over the share of its way is less than 2.
[[nodiscard]] constexpr float passing_share(CoverageBucket bucket) {
  switch (bucket) {
    case CoverageBucket::none:
      return 1;
    case CoverageBucket::little:
      return 63.0F / 64;
    case CoverageBucket::half:
      return 0.5F;
    case CoverageBucket::most:
      return 1.0F / 64;
    case CoverageBucket::all:
      break;
  }
  return 0;
}

}  // namespace relook
