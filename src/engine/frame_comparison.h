// Two frames side by side: exact differences, figures for how near they look, and the verdict by thresholds.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "engine/compare.h"
#include "engine/flip.h"
#include "engine/image.h"

namespace relook {

/// What may differ; without any, nothing may. A pixel's error is the largest of its channels. Differences that are not
/// finite are above every threshold and in no percentage.
struct Thresholds {
  std::optional<double> fail = std::nullopt;       // errors above it count; none: any other bits count
  double fail_percent = 0;                         // of the pixels may count
  std::optional<double> hard_fail = std::nullopt;  // no error above it
  std::optional<double> fail_flip = std::nullopt;  // no mean FLIP above it
  std::optional<double> warn = std::nullopt, warn_percent = std::nullopt;
  std::optional<double> hard_warn = std::nullopt, warn_flip = std::nullopt;
};

enum class Verdict : std::uint8_t { equal, within, warning, failure };  // ordered: the worst counts
[[nodiscard]] std::string_view verdict_name(Verdict verdict);

/// The first pixel in row order with the largest error.
struct WorstPixel {
  std::uint32_t x = 0, y = 0;
  Rgba a, b;
  double error = 0;  // infinite when not finite; 0 when only bits differ, as in 0 and -0
};

struct FlipSummary {
  double mean = 0, largest = 0;
  ExposureRange exposures;
};

struct FrameComparison {
  FrameDifference difference;
  std::uint64_t not_finite_a = 0, not_finite_b = 0;  // pixels with NaN or infinite channels
  std::optional<WorstPixel> worst;                   // when a pixel differs
  std::optional<double> psnr, ssim;                  // see engine/similarity.h
  std::optional<FlipSummary> flip;                   // a is the reference
  std::vector<float> flip_errors;                    // [height * width], or empty
  std::uint64_t pixels_above_fail = 0, pixels_above_warn = 0;
  Verdict verdict = Verdict::equal;
};

/// Requires: frames of one size. `looks`: also PSNR, SSIM and FLIP, for frames that differ.
[[nodiscard]] FrameComparison compare_closely(const Frame& a, const Frame& b, const Thresholds& thresholds, bool looks);

/// difference_json() with psnr, ssim, flip, worst_pixel, not_finite, pixels_above_fail, verdict. Channels that are not
/// finite are "nan", "inf" or "-inf". Equal frames have psnr null (infinite), ssim 1 and flip 0.
[[nodiscard]] Json comparison_json(const FrameComparison& comparison);

}  // namespace relook
