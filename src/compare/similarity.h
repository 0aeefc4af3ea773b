// Whole-frame figures for how near two frames are.
#pragma once
#include <optional>

#include "compare/compare.h"
#include "frame/frame.h"

namespace relook {

/// Scene-linear value that a display shows as white: the peak of PSNR. The brightest pixel would not do: where a frame
/// has a highlight of 10,000, every picture would be near every other.
struct DisplayWhite {
  double value = 1;  // above 0
};

/// Peak signal-to-noise ratio in decibels, over all channels: 20 log10(white / RMS error). None when the frames are
/// equal (it is infinite) or differ by something that is not finite.
[[nodiscard]] std::optional<double> psnr(const FrameDifference& difference, DisplayWhite white);

/// Mean structural similarity of what previews show, the luma (Rec.709) of sRGB codes in [0, 1]. Z. Wang, A. Bovik,
/// H. Sheikh, E. Simoncelli: "Image Quality Assessment: From Error Visibility to Structural Similarity", 2004: Gaussian
/// window of 11 x 11 pixels and deviation 1.5, where it fits; K1 = 0.01, K2 = 0.03. 1 for frames that look equal. None
/// for a frame smaller than the window. NaN counts as black.
[[nodiscard]] std::optional<double> ssim(const Frame& a, const Frame& b);

}  // namespace relook
