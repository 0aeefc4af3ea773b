// Two frames side by side: exact differences, figures for how near they look, and the verdict by thresholds.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "compare/compare.h"
#include "compare/flip.h"
#include "compare/layer_comparison.h"
#include "compare/similarity.h"
#include "compare/thresholds.h"
#include "frame/frame.h"

namespace relook {

/// The first pixel in row order with the largest error.
struct WorstPixel {
  std::int32_t x = 0, y = 0;  // from the upper left corner of the display window
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
  std::optional<double> psnr, ssim;                  // see compare/similarity.h
  std::optional<FlipSummary> flip;                   // a is the reference
  std::vector<float> flip_errors;                    // [height * width], or empty
  std::uint64_t pixels_above_fail = 0, pixels_above_warn = 0;
  Verdict verdict = Verdict::equal;  // on all of the file

  // Of files (compare/file_comparison.h):
  bool has_picture = true;              // without, the figures above are those of the layer `own_layer`
  std::vector<LayerDifference> layers;  // of all parts
  std::size_t own_layer = 0;            // the picture's; without one, the first that differs, or the first
  std::string first_difference;         // "channel depth.Z"; "" when equal
};

/// Requires: frames of one size. `white`: also PSNR with this peak, SSIM and FLIP, for frames that differ.
[[nodiscard]] FrameComparison compare_closely(const Frame& a, const Frame& b, const Thresholds& thresholds,
                                              const std::optional<DisplayWhite>& white);

/// difference_json() with psnr, ssim, flip, worst_pixel, not_finite, pixels_above_fail, pixels_above_warn, verdict,
/// first_difference (null when equal) and layers. Channels that are not finite are "nan", "inf" or "-inf". Equal frames
/// have psnr null (infinite), ssim 1 and flip 0.
[[nodiscard]] Json comparison_json(const FrameComparison& comparison);

}  // namespace relook
