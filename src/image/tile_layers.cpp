#include "image/tile_layers.h"

#include <algorithm>

#include "base/error.h"
#include "base/vector_clones.h"

namespace relook {
namespace {

constexpr std::size_t kValuesOfPixel = 3;
constexpr LightColor kBlack{0, 0, 0};

/// As layer() does it.
RELOOK_VECTOR_CLONES
void scale(std::span<const double> sums, double color, double samples, float* values) {
  for (std::size_t i = 0; i < sums.size(); ++i) values[i] = static_cast<float>(color * sums[i] / samples);
}

RELOOK_VECTOR_CLONES
void add(const float* __restrict values, std::size_t count, float* __restrict sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += values[i];
}

}  // namespace

bool TileLayers::shows(std::span<const LightColor> colors) const {
  if (shown_.size() != colors.size() || empty()) return false;
  for (std::size_t i = 0; i < colors.size(); ++i)
    if (layers_[i].has_light && shown_[i] != colors[i]) return false;
  return true;
}

void TileLayers::begin(const PackedSums& sums, std::uint32_t samples, Working& working) {
  layers_.resize(sums.sums());
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i].has_light = !sums.is_zero(i);
    layers_[i].is_worked_out = false;
  }
  working.sums.resize(sums.pixels());
  sums.coverage_values(working.sums);
  coverage_.resize(sums.pixels());
  scale(working.sums, 1, samples, coverage_.data());
}

void TileLayers::work_out(const PackedSums& sums, std::size_t sum, const LightColor& color, std::uint32_t samples,
                          Layer& layer, Working& working) {
  const std::size_t pixels = sums.pixels();
  working.sums.resize(pixels);
  layer.values.resize(kValuesOfPixel * pixels);
  for (std::size_t channel = 0; channel < kValuesOfPixel; ++channel) {
    sums.channel_values(sum, channel, working.sums);
    scale(working.sums, color[channel], samples, layer.values.data() + channel * pixels);
  }
  layer.color = color;
  layer.is_worked_out = true;
}

TileLayers::Planes TileLayers::compose(const PackedSums& sums, std::span<const LightColor> colors,
                                       std::uint32_t samples, Working& working) {
  require(colors.size() == sums.sums(), "a colour a sum");
  if (empty()) begin(sums, samples, working);
  const std::size_t pixels = sums.pixels();
  working.pixels.assign(kValuesOfPixel * pixels, 0.0F);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    // A layer of zeros, of either sign, changes nothing: the sum begins with +0. The layer before stays for when the
    // light is on again.
    if (!layer.has_light || colors[i] == kBlack) continue;
    if (!layer.is_worked_out || layer.color != colors[i]) work_out(sums, i, colors[i], samples, layer, working);
    add(layer.values.data(), layer.values.size(), working.pixels.data());
  }
  shown_.assign(colors.begin(), colors.end());
  const std::span<const float> all(working.pixels);
  return {all.subspan(0, pixels), all.subspan(pixels, pixels), all.subspan(2 * pixels, pixels), coverage_};
}

std::size_t TileLayers::bytes() const {
  std::size_t bytes = layers_.capacity() * sizeof(Layer) + shown_.capacity() * sizeof(LightColor) +
                      coverage_.capacity() * sizeof(float);
  for (const Layer& layer : layers_) bytes += layer.values.capacity() * sizeof(float);
  return bytes;
}

}  // namespace relook
