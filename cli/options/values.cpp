#include "options/values.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"

namespace relook {
namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view text, std::string_view expected) {
  throw UsageError(std::string(option) + ": \"" + std::string(text) + "\" is not " + std::string(expected));
}

/// A number that takes up all of `text`.
template <class T>
std::optional<T> whole_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::uint64_t parse_size(std::string_view option, std::string_view text) {
  constexpr double kMostBytes = 9007199254740992.0;  // 2^53: exact in a double
  std::string_view number = text;
  if (number.ends_with('B')) number.remove_suffix(1);
  double unit = 1;
  for (const auto& [letter, bytes] :
       {std::pair{'K', 1024.0}, {'M', 1048576.0}, {'G', 1073741824.0}, {'T', 1099511627776.0}}) {
    if (!number.ends_with(letter)) continue;
    number.remove_suffix(1);
    unit = bytes;
    break;
  }
  const std::optional<double> value = whole_number<double>(number);
  if (!value || !std::isfinite(*value) || *value < 0 || *value * unit > kMostBytes)
    refuse(option, text, "a size like 300M or 2G");
  return static_cast<std::uint64_t>(*value * unit);
}

std::pair<std::uint32_t, std::uint32_t> parse_resolution(std::string_view option, std::string_view text) {
  constexpr std::uint32_t kLargestSide = 16384;
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const auto width = whole_number<std::uint32_t>(text.substr(0, cross));
    const auto height = whole_number<std::uint32_t>(text.substr(cross + 1));
    if (width && height && *width >= 1 && *height >= 1 && *width <= kLargestSide && *height <= kLargestSide)
      return {*width, *height};
  }
  refuse(option, text, "a resolution like 1280x720, up to 16384x16384");
}

std::pair<std::uint32_t, std::uint32_t> parse_pixel(std::string_view option, std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos) {
    const auto x = whole_number<std::uint32_t>(text.substr(0, comma));
    const auto y = whole_number<std::uint32_t>(text.substr(comma + 1));
    if (x && y) return {*x, *y};
  }
  refuse(option, text, "a pixel like 120,45");
}

Lens parse_lens(std::string_view option, std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string_view::npos) {
    const auto radius = whole_number<float>(text.substr(0, colon)), focus = whole_number<float>(text.substr(colon + 1));
    if (radius && focus && is_lens({*radius, *focus})) return {*radius, *focus};
  }
  refuse(option, text, "a lens like 0.02:3, its radius and where it is sharp, in metres");
}

double parse_percent(std::string_view option, std::string_view text, bool zero_allowed) {
  std::string_view number = text;
  if (number.ends_with('%')) number.remove_suffix(1);
  const std::optional<double> value = whole_number<double>(number);
  const bool is_fitting = value && (*value > 0 || (zero_allowed && *value == 0)) && *value <= 100;
  if (!is_fitting)
    refuse(option, text, zero_allowed ? "a percentage from 0 to 100" : "a percentage above 0, up to 100");
  return *value;
}

StepRange parse_steps(std::string_view option, std::string_view text) {
  const std::string_view expected = "a range of steps like 3, 2-5 or 4-";
  const std::size_t dash = text.find('-');
  const auto first = whole_number<std::uint32_t>(text.substr(0, dash));
  if (!first) refuse(option, text, expected);
  if (dash == std::string_view::npos) return {*first, first};
  if (dash + 1 == text.size()) return {*first, std::nullopt};
  const auto last = whole_number<std::uint32_t>(text.substr(dash + 1));
  if (!last || *last < *first) refuse(option, text, expected);
  return {*first, last};
}

std::vector<std::string> marked_values(int argc, const char* const* argv) {
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_number = word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
    words.push_back(is_number || word.starts_with('[') ? " " + word : word);
  }
  return words;
}

}  // namespace relook
