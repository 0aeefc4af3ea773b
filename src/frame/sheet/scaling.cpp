// scaled_down(), as_displayed() and encode_displayed() of contact_sheet.h.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "frame/sheet/contact_sheet.h"

namespace relook {
namespace {

/// The part of a side's old pixels that a new one covers: the pixels [first, first + weights.size()).
struct Coverage {
  std::uint32_t first = 0;
  std::vector<double> weights;  // they sum to 1
};

std::vector<Coverage> coverage_of(std::uint32_t from, std::uint32_t to) {
  std::vector<Coverage> all(to);
  for (std::uint32_t i = 0; i < to; ++i) {
    const double begin = static_cast<double>(i) * from / to, end = static_cast<double>(i + 1) * from / to;
    all[i].first = static_cast<std::uint32_t>(begin);
    for (std::uint32_t k = all[i].first; k < from && k < end; ++k)
      all[i].weights.push_back((std::min<double>(k + 1, end) - std::max<double>(k, begin)) / (end - begin));
  }
  return all;
}

float finite(float value) { return std::isfinite(value) ? value : 0.0F; }

Rgba mean(const Frame& frame, const Coverage& columns, const Coverage& rows) {
  std::array<double, 4> sum{};
  for (std::size_t y = 0; y < rows.weights.size(); ++y)
    for (std::size_t x = 0; x < columns.weights.size(); ++x) {
      const Rgba& pixel = frame.pixels[(rows.first + y) * frame.width + columns.first + x];
      const double weight = rows.weights[y] * columns.weights[x];
      for (int channel = 0; channel < 4; ++channel)
        sum[static_cast<std::size_t>(channel)] += weight * static_cast<double>(finite(pixel[channel]));
    }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2]),
          static_cast<float>(sum[3])};
}

constexpr double kMostCode = 255;

float srgb_encoded(float light) {
  const auto value = static_cast<double>(light);
  if (!(value > 0)) return 0;
  if (value <= 0.0031308) return static_cast<float>(value * 12.92);
  return static_cast<float>(1.055 * std::pow(std::min(value, 1.0), 1 / 2.4) - 0.055);
}

float srgb_decoded(double encoded) {
  return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

/// The light of each code.
std::array<float, 256> code_lights() {
  std::array<float, 256> lights{};
  for (std::size_t code = 0; code < lights.size(); ++code)
    lights[code] = srgb_decoded(static_cast<double>(code) / kMostCode);
  return lights;
}

/// Light to codes, for a display whose codes are not said to be sRGB in the file.
class LightView final : public DisplayView {
 public:
  [[nodiscard]] Rgba apply(const Rgba& light) const override {
    return {srgb_encoded(light.r), srgb_encoded(light.g), srgb_encoded(light.b), light.a};
  }
  [[nodiscard]] std::string id() const override { return "light"; }
  [[nodiscard]] std::string name() const override { return "light"; }
};

}  // namespace

Frame scaled_down(const Frame& frame, std::uint32_t width) {
  require(width > 0, "a picture has a width");
  if (frame.width <= width) return frame;
  const double height = static_cast<double>(frame.height) * width / frame.width;
  Frame scaled{width, std::max(1U, static_cast<std::uint32_t>(std::lround(height))), {}};
  scaled.pixels.resize(std::size_t{scaled.width} * scaled.height);
  const std::vector<Coverage> columns = coverage_of(frame.width, scaled.width);
  const std::vector<Coverage> rows = coverage_of(frame.height, scaled.height);
  parallel_for(scaled.height, [&](std::size_t y) {
    for (std::size_t x = 0; x < scaled.width; ++x)
      scaled.pixels[y * scaled.width + x] = mean(frame, columns[x], rows[y]);
  });
  return scaled;
}

Frame as_displayed(const Frame& frame, const PreviewStyle& style) {
  static const std::array<float, 256> lights = code_lights();
  PreviewEncoder encoder(frame.width, frame.height, style);
  encoder.update(frame);
  const std::span<const unsigned char> codes = encoder.codes();
  Frame shown{frame.width, frame.height, std::vector<Rgba>(frame.pixels.size())};
  for (std::size_t i = 0; i < shown.pixels.size(); ++i)
    shown.pixels[i] = {lights[codes[3 * i]], lights[codes[3 * i + 1]], lights[codes[3 * i + 2]], 1};
  return shown;
}

Bytes encode_displayed(const Frame& light, const PreviewStyle& style) {
  return encode_png(light, {style.view ? std::make_shared<const LightView>() : nullptr, 0});
}

}  // namespace relook
