// HDR-FLIP: LDR-FLIP at each of a range of exposures that suits the reference, tone mapped; the largest error of each
// pixel. P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moeller: "Visualizing Errors in Rendered High Dynamic Range
// Images", Eurographics 2021.
#pragma once
#include <optional>
#include <vector>

#include "frame/frame.h"

namespace relook {

struct ExposureRange {
  double start = 0, stop = 0;  // in stops: colours are multiplied by 2^exposure
  int count = 2;               // evenly spaced, both ends included
};

/// From the exposure at which the brightest pixel is mapped to 0.85 to that of the median pixel, about a stop apart.
[[nodiscard]] ExposureRange flip_exposures(const Frame& reference);

struct FlipErrors {
  ExposureRange exposures;
  std::vector<float> errors;  // [height * width], in [0, 1]
  [[nodiscard]] double mean() const;
};

/// Alpha is not looked at; negative values count as 0. None when a colour is not finite. Pixels with nothing but equal
/// pixels around them cost nothing. Requires: frames of one size, not empty.
[[nodiscard]] std::optional<FlipErrors> hdr_flip(const Frame& reference, const Frame& test);

}  // namespace relook
