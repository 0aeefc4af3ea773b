// The module behind frame/sheet/text_drawing.h. The only file that sees FreeType.
#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "frame/sheet/text_drawing.h"

// The bytes of RELOOK_FONT, a file.
asm(".pushsection .rodata\n"
    ".hidden relook_font\n.hidden relook_font_end\n"
    ".global relook_font\n.global relook_font_end\n"
    "relook_font:\n.incbin \"" RELOOK_FONT
    "\"\n"
    "relook_font_end:\n.popsection\n");
extern "C" const unsigned char relook_font[], relook_font_end[];

namespace {

constexpr FT_Long kUnit = 64;  // FreeType's numbers are 26.6

void check(FT_Error error) {
  if (error != 0) throw std::runtime_error("FreeType's error " + std::to_string(error));
}

class Font {
 public:
  Font() {
    check(FT_Init_FreeType(&library_));
    check(FT_New_Memory_Face(library_, relook_font, relook_font_end - relook_font, 0, &face_));
  }
  void draw(std::string_view text, double pixels, relook::TextMask& mask);

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

/// The next code point of well-formed UTF-8, which leaves `text`.
FT_ULong take_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) -> FT_ULong {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const FT_ULong first = byte(0);
  const std::size_t bytes = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  FT_ULong code = bytes == 1 ? first : first & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) code = code << 6 | (byte(i) & 0x3FU);
  text.remove_prefix(std::min(bytes, text.size()));
  return code;
}

/// Adds a glyph's bitmap, as far as it lies within the mask.
void add(const FT_GlyphSlot glyph, FT_Long x, FT_Long baseline, relook::TextMask& mask) {
  const FT_Bitmap& bitmap = glyph->bitmap;
  for (unsigned row = 0; row < bitmap.rows; ++row) {
    const FT_Long y = baseline - glyph->bitmap_top + row;
    if (y < 0 || y >= mask.height) continue;
    for (unsigned column = 0; column < bitmap.width; ++column) {
      const FT_Long at = x + glyph->bitmap_left + column;
      if (at < 0 || at >= mask.width) continue;
      unsigned char& covered = mask.coverage[static_cast<std::size_t>(y * mask.width + at)];
      covered = std::max(covered,
                         bitmap.buffer[static_cast<std::size_t>(row) * static_cast<unsigned>(bitmap.pitch) + column]);
    }
  }
}

void Font::draw(std::string_view text, double pixels, relook::TextMask& mask) {
  check(FT_Set_Char_Size(face_, 0, std::lround(pixels * kUnit), 72, 72));
  const FT_Size_Metrics& metrics = face_->size->metrics;
  const auto for_each_glyph = [&](int flags, const auto& use) {
    FT_Long x = 0;
    FT_UInt before = 0;
    for (std::string_view rest = text; !rest.empty();) {
      const FT_UInt glyph = FT_Get_Char_Index(face_, take_code_point(rest));
      FT_Vector kerning{};
      if (before != 0 && glyph != 0) check(FT_Get_Kerning(face_, before, glyph, FT_KERNING_DEFAULT, &kerning));
      check(FT_Load_Glyph(face_, glyph, FT_LOAD_TARGET_LIGHT | flags));
      use(x + kerning.x);
      x += kerning.x + face_->glyph->advance.x;
      before = glyph;
    }
    return x;
  };
  const FT_Long width = for_each_glyph(FT_LOAD_DEFAULT, [](FT_Long) {});
  mask.width = static_cast<std::uint32_t>((width + kUnit - 1) / kUnit) + 1;  // a last glyph may lean over its advance
  mask.height = static_cast<std::uint32_t>((metrics.ascender - metrics.descender + kUnit - 1) / kUnit);
  mask.coverage.assign(std::size_t{mask.width} * mask.height, 0);
  const FT_Long baseline = (metrics.ascender + kUnit - 1) / kUnit;
  for_each_glyph(FT_LOAD_RENDER, [&](FT_Long x) { add(face_->glyph, x / kUnit, baseline, mask); });
}

}  // namespace

extern "C" bool relook_draw_text(std::string_view text, double pixels, relook::TextMask& mask, std::string& error) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  try {
    static Font font;
    font.draw(text, pixels, mask);
    return true;
  } catch (const std::exception& exception) {
    error = exception.what();
    return false;
  }
}
