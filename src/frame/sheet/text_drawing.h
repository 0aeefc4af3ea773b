// Text as coverage, for labels in images. FreeType and the font, DejaVu Sans, stand in a module of their own
// (base/system/module.h), the font as bytes within it: labels look the same everywhere, also where no font is
// installed.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relook {

/// One line of text.
struct TextMask {
  std::uint32_t width = 0, height = 0;  // pixels; the height is that of the font, whatever the text
  std::vector<unsigned char> coverage;  // [height * width], row 0 on top; 255: covered
};

/// What the module exports, as relook_draw_text. False: `error` says why.
using DrawText = bool(std::string_view text, double pixels, TextMask& mask, std::string& error);

/// Draws well-formed UTF-8 from left to right, `pixels` from one line to the next, nearly. What the font lacks is a
/// box. Throws Error without the module.
[[nodiscard]] TextMask drawn_text(std::string_view text, double pixels);

/// Lines of at most `width` pixels, broken between words and, where a word is too long, within it. What has no room in
/// `most_lines` is left out, and the last line ends in an ellipsis.
[[nodiscard]] std::vector<TextMask> drawn_lines(std::string_view text, double pixels, std::uint32_t width,
                                                std::size_t most_lines);

}  // namespace relook
