// Two frames on disk, compared in all that they hold. Parts are matched by name, a part without one with the other
// file's first. Data windows need not be the same; display windows must have one size, and another place of them is a
// difference. Headers are not compared otherwise.
#pragma once
#include "compare/frame_comparison.h"
#include "frame/exr_file.h"
#include "frame/frame.h"

namespace relook {

struct FileComparison {
  FrameComparison comparison;
  Frame a, b;  // R, G, B and A of the first part that has them, if both files have them there; else empty
};

/// `white`: also PSNR with this peak, SSIM and FLIP, for pictures that differ. Throws InputError for files that are not
/// read, display windows of two sizes, and data windows too far apart.
[[nodiscard]] FileComparison compare_exr_files(const ExrFile& a, const ExrFile& b, const Thresholds& thresholds,
                                               const std::optional<DisplayWhite>& white);

}  // namespace relook
