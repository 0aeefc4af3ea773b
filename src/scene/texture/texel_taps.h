// A lookup in a pyramid in two steps: which texels it takes and how much of each, then their mean. In between a caller
// may ask for the texels of several lookups, which the processor then fetches side by side: a pyramid is larger than its
// caches. sample() (texture.h) is both steps at once.
#pragma once
#include <array>
#include <cstddef>

#include "scene/texture/texture.h"

namespace relook {

struct TexelTaps {
  /// The four texels around a place of a level, by index in the texel array: above, then below, from left to right. The
  /// nearest one alone where `is_nearest`: the first.
  struct Square {
    std::array<std::size_t, 4> texels;
    float right, below;  // shares of the right and of the lower ones
  };
  Square fine, coarse;  // `coarse`: if there is one
  float coarse_share;
  bool has_coarse, is_nearest;
};

/// `uv`, `level`: as sample() has them. Fills `taps` in place: copies of what has just been written are slow.
void find_taps(const TexturePyramid& pyramid, Uv uv, float level, const TextureSampler& sampler, TexelTaps& taps);
[[nodiscard]] Rgba value_of(const TexturePyramid& pyramid, const TexelTaps& taps);

/// Asks for the texels.
inline void prefetch(const TexturePyramid& pyramid, const TexelTaps& taps) {
  const auto ask = [&](const TexelTaps::Square& square, std::size_t corner) {
    const std::size_t first = square.texels[corner] * 4;
    if (pyramid.format == TexelFormat::float32)
      __builtin_prefetch(pyramid.texels32.data() + first);
    else
      __builtin_prefetch(pyramid.texels8.data() + first);
  };
  ask(taps.fine, 0);
  if (!taps.is_nearest) ask(taps.fine, 2);
  if (!taps.has_coarse) return;
  ask(taps.coarse, 0);
  if (!taps.is_nearest) ask(taps.coarse, 2);
}

}  // namespace relook
