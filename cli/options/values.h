// Values of options: sizes, resolutions, percentages. Each throws UsageError that names the option.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/report.h"
#include "scene/camera.h"

namespace relook {

/// "512", "64K", "300M", "2G", "1.5G" (powers of 1024), with or without a final "B". In bytes.
[[nodiscard]] std::uint64_t parse_size(std::string_view option, std::string_view text);
/// "1280x720": 1..16384 each.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_resolution(std::string_view option, std::string_view text);
/// "120,45": a pixel, column and row.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_pixel(std::string_view option, std::string_view text);
/// "0.02:3": radius and distance of focus in metres, 1e-9..1e9 each.
[[nodiscard]] Lens parse_lens(std::string_view option, std::string_view text);
/// "50" or "50%": 0 < value <= 100 or, with `zero_allowed`, 0 <= value <= 100.
[[nodiscard]] double parse_percent(std::string_view option, std::string_view text, bool zero_allowed);

/// "3", "2-5", "4-": first <= last.
[[nodiscard]] StepRange parse_steps(std::string_view option, std::string_view text);

/// The command line with values marked by a space that CLI11 would take for an option (-1..1:5) or a list ([1,0,0]).
[[nodiscard]] std::vector<std::string> marked_values(int argc, const char* const* argv);

}  // namespace relook
