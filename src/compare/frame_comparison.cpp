#include "compare/frame_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::array kChannels{&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a};

bool is_finite(const Rgba& pixel) {
  return std::ranges::all_of(kChannels, [&](auto channel) { return std::isfinite(pixel.*channel); });
}

/// The largest difference of a channel; infinite when a differing channel is not finite.
double pixel_error(const Rgba& a, const Rgba& b) {
  double largest = 0;
  for (const auto channel : kChannels) {
    if (std::memcmp(&(a.*channel), &(b.*channel), sizeof(float)) == 0) continue;
    const double error = std::abs(double{a.*channel} - double{b.*channel});
    largest = std::max(largest, std::isnan(error) ? std::numeric_limits<double>::infinity() : error);
  }
  return largest;
}

ErrorFigures figures_of(const FrameComparison& comparison) {
  const FrameDifference& difference = comparison.difference;
  ErrorFigures figures{difference.pixels_compared, difference.pixels_different, comparison.pixels_above_fail,
                       comparison.pixels_above_warn, difference.max_error};
  if (comparison.flip) figures.mean_flip = comparison.flip->mean;
  return figures;
}

void visit_pixels(const Frame& a, const Frame& b, const Thresholds& thresholds, FrameComparison& comparison) {
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgba &first = a.pixels[i], &second = b.pixels[i];
    comparison.not_finite_a += is_finite(first) ? 0 : 1;
    comparison.not_finite_b += is_finite(second) ? 0 : 1;
    if (std::memcmp(&first, &second, sizeof first) == 0) continue;
    const double error = pixel_error(first, second);
    comparison.pixels_above_fail += thresholds.counts_as_failure(error) ? 1 : 0;
    comparison.pixels_above_warn += thresholds.counts_as_warning(error) ? 1 : 0;
    if (!comparison.worst || error > comparison.worst->error)
      comparison.worst = WorstPixel{static_cast<std::int32_t>(i % a.width), static_cast<std::int32_t>(i / a.width),
                                    first, second, error};
  }
}

Json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json channels_json(const Rgba& pixel) {
  Json channels = Json::array();
  for (const auto channel : kChannels) {
    const float value = pixel.*channel;
    if (std::isfinite(value))
      channels.push_back(value);
    else
      channels.push_back(std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
  }
  return channels;
}

Json worst_json(const std::optional<WorstPixel>& worst) {
  if (!worst) return nullptr;
  return {{"x", worst->x},
          {"y", worst->y},
          {"error", number_or_null(worst->error)},
          {"a", channels_json(worst->a)},
          {"b", channels_json(worst->b)}};
}

Json flip_json(const FrameComparison& comparison) {
  if (comparison.has_picture && !comparison.worst) return {{"mean", 0}, {"max", 0}};
  if (!comparison.flip) return nullptr;
  const FlipSummary& flip = *comparison.flip;
  return {{"mean", flip.mean},
          {"max", flip.largest},
          {"start_exposure", flip.exposures.start},
          {"stop_exposure", flip.exposures.stop},
          {"exposures", flip.exposures.count}};
}

}  // namespace

FrameComparison compare_closely(const Frame& a, const Frame& b, const Thresholds& thresholds,
                                const std::optional<DisplayWhite>& white) {
  FrameComparison comparison;
  comparison.difference = compare_frames(a, b);
  visit_pixels(a, b, thresholds, comparison);
  const bool is_equal = comparison.difference.pixels_different == 0;
  if (is_equal) comparison.ssim = 1;
  if (!is_equal && white) {
    comparison.psnr = psnr(comparison.difference, *white);
    comparison.ssim = ssim(a, b);
    if (std::optional<FlipErrors> flip = hdr_flip(a, b)) {
      comparison.flip = {flip->mean(), double{*std::ranges::max_element(flip->errors)}, flip->exposures};
      comparison.flip_errors = std::move(flip->errors);
    }
  }
  comparison.verdict = verdict_of(figures_of(comparison), thresholds);
  return comparison;
}

Json comparison_json(const FrameComparison& comparison) {
  Json json = difference_json(comparison.difference);
  json["psnr"] = number_or_null(comparison.psnr);
  json["ssim"] = number_or_null(comparison.ssim);
  json["flip"] = flip_json(comparison);
  json["worst_pixel"] = worst_json(comparison.worst);
  json["not_finite"] = {comparison.not_finite_a, comparison.not_finite_b};
  json["pixels_above_fail"] = comparison.pixels_above_fail;
  json["pixels_above_warn"] = comparison.pixels_above_warn;
  json["verdict"] = verdict_name(comparison.verdict);
  json["first_difference"] =
      comparison.first_difference.empty() ? Json(nullptr) : Json(printable(comparison.first_difference));
  json["layers"] = Json::array();
  for (const LayerDifference& layer : comparison.layers) json["layers"].push_back(layer_json(layer));
  return json;
}

}  // namespace relook
