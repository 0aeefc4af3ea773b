#include "frame/sheet/text_drawing.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "base/system/module.h"

namespace relook {
namespace {

constexpr std::string_view kEllipsis = "\u2026";

/// The offset behind the character at `at`.
std::size_t next_character(std::string_view text, std::size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
  return at;
}

/// The largest prefix, in whole characters, that with `tail` is no wider than `width`.
std::size_t fitting_bytes(std::string_view text, std::string_view tail, double pixels, std::uint32_t width) {
  std::vector<std::size_t> ends;
  for (std::size_t at = 0; at < text.size();) ends.push_back(at = next_character(text, at));
  const auto is_too_wide = [&](std::size_t end) {
    return drawn_text(std::string(text.substr(0, end)).append(tail), pixels).width > width;
  };
  const auto first_wide = std::ranges::partition_point(ends, [&](std::size_t end) { return !is_too_wide(end); });
  return first_wide == ends.begin() ? 0 : *(first_wide - 1);
}

/// The bytes of the next line: as many whole words as fit, or as much of one as does.
std::size_t line_bytes(std::string_view text, double pixels, std::uint32_t width) {
  const std::size_t fits = fitting_bytes(text, "", pixels, width);
  if (fits == text.size()) return fits;
  const std::size_t space = text.substr(0, fits + 1).rfind(' ');
  if (space != std::string_view::npos && space > 0) return space;
  return fits > 0 ? fits : next_character(text, 0);
}

constexpr std::size_t kMostBytes = 2000;  // of a label: no more fits anywhere

}  // namespace

TextMask drawn_text(std::string_view text, double pixels) {
  static auto* const draw =
      reinterpret_cast<DrawText*>(module_function("librelook_text.so", "relook_draw_text", "draw labels"));
  TextMask mask;
  std::string error;
  const bool is_drawn = draw(text, pixels, mask, error);
  set_float_mode();
  if (!is_drawn) throw Error(ExitCode::io, "librelook_text.so", "", error);
  return mask;
}

std::vector<TextMask> drawn_lines(std::string_view text, double pixels, std::uint32_t width, std::size_t most_lines) {
  std::string rest = printable(text.substr(0, kMostBytes));
  std::vector<TextMask> lines;
  while (!rest.empty() && lines.size() < most_lines) {
    std::size_t bytes = line_bytes(rest, pixels, width);
    std::string line = rest.substr(0, bytes);
    if (bytes < rest.size() && lines.size() + 1 == most_lines) {
      bytes = fitting_bytes(rest, kEllipsis, pixels, width);
      line = rest.substr(0, bytes).append(kEllipsis);
      rest.clear();
    } else {
      rest.erase(0, bytes);
      rest.erase(0, std::min(rest.find_first_not_of(' '), rest.size()));
    }
    lines.push_back(drawn_text(line, pixels));
  }
  return lines;
}

}  // namespace relook
