// The layers of one tile (frame/light_sums.h), light by light, as its pixels are added up from them: packed sums and
// colours in, pixels out. Layers are kept, so that an edit of one light's colour works that layer out again and adds
// the others as they are. They follow from the sums: whoever changes these drops the layers.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frame/light_sums.h"

namespace relook {

class TileLayers {
 public:
  /// Memory to work in, for one call at a time.
  struct Working {
    std::vector<float> pixels;
    std::vector<double> sums;
  };
  /// Pixels of a tile, channel by channel: R, G, B, A.
  using Planes = std::array<std::span<const float>, 4>;

  /// Is nothing kept?
  [[nodiscard]] bool empty() const { return shown_.empty(); }
  /// Have the pixels that were composed last these colours, as far as the tile has light of them?
  [[nodiscard]] bool shows(std::span<const LightColor> colors) const;
  /// The pixels, each as compose() has it. They live in `working`. Requires: `sums` are the ones of the call before, if
  /// any layers are kept; a colour a sum.
  [[nodiscard]] Planes compose(const PackedSums& sums, std::span<const LightColor> colors, std::uint32_t samples,
                               Working& working);
  /// Nothing is kept but memory, for another tile.
  void forget() { shown_.clear(); }
  /// Memory that they take.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Layer {
    LightColor color{};         // by which the values are worked out
    std::vector<float> values;  // [3 * pixels], channel by channel
    bool has_light = false;
    bool is_worked_out = false;
  };

  void begin(const PackedSums& sums, std::uint32_t samples, Working& working);
  static void work_out(const PackedSums& sums, std::size_t sum, const LightColor& color, std::uint32_t samples,
                       Layer& layer, Working& working);

  std::vector<Layer> layers_;      // one a sum
  std::vector<LightColor> shown_;  // one a sum; none: nothing is kept
  std::vector<float> coverage_;    // [pixels]
};

/// About how long layers take to be worked out again.
inline constexpr double kLayerSecondsPerByte = 5e-10;

}  // namespace relook
