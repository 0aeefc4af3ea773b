// A frame: what a camera sees, pixel by pixel.
#pragma once
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "base/tiles.h"

namespace relook {

struct Frame {
  std::uint32_t width = 0, height = 0;
  std::vector<Rgba> pixels;  // [height * width], row 0 on top; float32 linear Rec.709, a = coverage
};

}  // namespace relook
