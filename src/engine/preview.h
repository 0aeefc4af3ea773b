// Previews: 8-bit sRGB PNG files of a frame over black, for looking at, never for comparing.
#pragma once
#include "base/files.h"
#include "engine/image.h"

namespace relook {

/// The bytes of an RGB PNG file; the same in every run. NaN becomes black.
[[nodiscard]] Bytes encode_png(const Frame& frame);

}  // namespace relook
