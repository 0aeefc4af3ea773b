// What an import writes into lights where there are many, for Integrator::path: `sum`, the sum of light that those beyond
// the first sixteen share, and `rate`, the share of samples behind the first scattering (color/PATH.md says why). Both
// are values of the look document like any other from then on: no edit of one light changes those of others.
#pragma once
#include <span>
#include <string>

#include "scene/look/look.h"

namespace relook {

/// So many placed lights have a sum and all samples each; a light counts as often as nodes name it.
inline constexpr std::size_t kLightsAlone = 16;
/// No rate that is written is below this.
inline constexpr double kLeastRate = 0.25;
/// The name of the sum that all others share.
inline constexpr std::string_view kSumOfOthers = "others";

/// Writes `sum` and `rate` into those of these lights that have none. `names`: of /lights in the order in which they
/// come to have sums of their own; others are skipped, and count.
void write_light_shares(LookDocument& document, std::span<const std::string> names);

}  // namespace relook
