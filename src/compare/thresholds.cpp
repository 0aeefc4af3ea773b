#include "compare/thresholds.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace relook {
namespace {

struct Limits {
  double percent;
  std::optional<double> hard, flip;
};

bool is_exceeded(const ErrorFigures& figures, const Limits& limits, std::uint64_t above) {
  const bool has_many =
      static_cast<double>(above) > limits.percent / 100 * static_cast<double>(figures.pixels_compared);
  const bool has_hard = limits.hard && figures.max_error > *limits.hard;
  const bool looks_different = limits.flip && figures.mean_flip && *figures.mean_flip > *limits.flip;
  return has_many || has_hard || looks_different || !std::isfinite(figures.max_error);
}

bool warns(const Thresholds& thresholds) {
  return thresholds.warn || thresholds.warn_percent || thresholds.hard_warn || thresholds.warn_flip;
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"equal", "within", "warning", "failure"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Verdict verdict_of(const ErrorFigures& figures, const Thresholds& thresholds) {
  if (figures.pixels_different == 0) return Verdict::equal;
  const Limits fail{thresholds.fail_percent, thresholds.hard_fail, thresholds.fail_flip};
  if (is_exceeded(figures, fail, figures.pixels_above_fail)) return Verdict::failure;
  const Limits warn{thresholds.warn_percent.value_or(0), thresholds.hard_warn, thresholds.warn_flip};
  if (warns(thresholds) && is_exceeded(figures, warn, figures.pixels_above_warn)) return Verdict::warning;
  return Verdict::within;
}

}  // namespace relook
