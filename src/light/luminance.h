// Luminance of linear Rec.709 colours, as the split of an environment and the sampling of emission weigh them.
#pragma once
#include "base/math.h"

namespace relook {

/// Y of ITU-R BT.709, summed from red to blue.
[[nodiscard]] inline float luminance(const Color& c) { return c.x * 0.2126F + c.y * 0.7152F + c.z * 0.0722F; }

}  // namespace relook
