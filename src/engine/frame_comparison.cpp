#include "engine/frame_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "engine/similarity.h"

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

struct Limits {
  double percent;
  std::optional<double> hard, flip;
};

bool is_exceeded(const FrameComparison& comparison, const Limits& limits, std::uint64_t above) {
  const FrameDifference& difference = comparison.difference;
  if (difference.pixels_different == 0) return false;
  const bool has_many =
      static_cast<double>(above) > limits.percent / 100 * static_cast<double>(difference.pixels_compared);
  const bool has_hard = limits.hard && difference.max_error > *limits.hard;
  const bool looks_different = limits.flip && comparison.flip && comparison.flip->mean > *limits.flip;
  return has_many || has_hard || looks_different || !std::isfinite(difference.max_error);
}

bool warns(const Thresholds& thresholds) {
  return thresholds.warn || thresholds.warn_percent || thresholds.hard_warn || thresholds.warn_flip;
}

Verdict verdict_of(const FrameComparison& comparison, const Thresholds& thresholds) {
  if (comparison.difference.pixels_different == 0) return Verdict::equal;
  const Limits fail{thresholds.fail_percent, thresholds.hard_fail, thresholds.fail_flip};
  if (is_exceeded(comparison, fail, comparison.pixels_above_fail)) return Verdict::failure;
  const Limits warn{thresholds.warn_percent.value_or(0), thresholds.hard_warn, thresholds.warn_flip};
  if (warns(thresholds) && is_exceeded(comparison, warn, comparison.pixels_above_warn)) return Verdict::warning;
  return Verdict::within;
}

void visit_pixels(const Frame& a, const Frame& b, const Thresholds& thresholds, FrameComparison& comparison) {
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgba &first = a.pixels[i], &second = b.pixels[i];
    comparison.not_finite_a += is_finite(first) ? 0 : 1;
    comparison.not_finite_b += is_finite(second) ? 0 : 1;
    if (std::memcmp(&first, &second, sizeof first) == 0) continue;
    const double error = pixel_error(first, second);
    comparison.pixels_above_fail += !thresholds.fail || error > *thresholds.fail ? 1 : 0;
    comparison.pixels_above_warn += !thresholds.warn || error > *thresholds.warn ? 1 : 0;
    if (!comparison.worst || error > comparison.worst->error)
      comparison.worst = WorstPixel{static_cast<std::uint32_t>(i % a.width), static_cast<std::uint32_t>(i / a.width),
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
  if (comparison.difference.pixels_different == 0) return {{"mean", 0}, {"max", 0}};
  if (!comparison.flip) return nullptr;
  const FlipSummary& flip = *comparison.flip;
  return {{"mean", flip.mean},
          {"max", flip.largest},
          {"start_exposure", flip.exposures.start},
          {"stop_exposure", flip.exposures.stop},
          {"exposures", flip.exposures.count}};
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"equal", "within", "warning", "failure"};
  return kNames[static_cast<std::size_t>(verdict)];
}

FrameComparison compare_closely(const Frame& a, const Frame& b, const Thresholds& thresholds, bool looks) {
  FrameComparison comparison;
  comparison.difference = compare_frames(a, b);
  visit_pixels(a, b, thresholds, comparison);
  const bool is_equal = comparison.difference.pixels_different == 0;
  if (is_equal) comparison.ssim = 1;
  if (!is_equal && looks) {
    comparison.psnr = psnr(a, b, comparison.difference);
    comparison.ssim = ssim(a, b);
    if (std::optional<FlipErrors> flip = hdr_flip(a, b)) {
      comparison.flip = {flip->mean(), double{*std::ranges::max_element(flip->errors)}, flip->exposures};
      comparison.flip_errors = std::move(flip->errors);
    }
  }
  comparison.verdict = verdict_of(comparison, thresholds);
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
  return json;
}

}  // namespace relook
