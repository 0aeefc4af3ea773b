// What may differ between two frames, and the verdict on what does.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace relook {

/// What may differ; without any, nothing may. A pixel's error is the largest of its channels. Differences that are not
/// finite are above every threshold, and no percentage lets them pass.
struct Thresholds {
  std::optional<double> fail = std::nullopt;       // errors above it count; none: any other bits count
  double fail_percent = 0;                         // of the pixels may count
  std::optional<double> hard_fail = std::nullopt;  // no error above it
  std::optional<double> fail_flip = std::nullopt;  // no mean FLIP above it
  std::optional<double> warn = std::nullopt, warn_percent = std::nullopt;
  std::optional<double> hard_warn = std::nullopt, warn_flip = std::nullopt;

  [[nodiscard]] bool counts_as_failure(double error) const { return !fail || error > *fail; }
  [[nodiscard]] bool counts_as_warning(double error) const { return !warn || error > *warn; }
};

enum class Verdict : std::uint8_t { equal, within, warning, failure };  // ordered: the worst counts
[[nodiscard]] std::string_view verdict_name(Verdict verdict);

/// What thresholds look at.
struct ErrorFigures {
  std::uint64_t pixels_compared = 0, pixels_different = 0;
  std::uint64_t pixels_above_fail = 0, pixels_above_warn = 0;
  double max_error = 0;  // infinite when a difference is not finite
  std::optional<double> mean_flip = std::nullopt;
};
[[nodiscard]] Verdict verdict_of(const ErrorFigures& figures, const Thresholds& thresholds);

}  // namespace relook
