// Contact sheets: pictures keep their pixels, labels stay in their places, text is whatever scenes call things.
#include "frame/sheet/contact_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "frame/sheet/text_drawing.h"

namespace relook {
namespace {

Frame gradient(std::uint32_t width, std::uint32_t height) {
  Frame frame{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const float value = static_cast<float>(i) / static_cast<float>(width * height);
    frame.pixels.emplace_back(value * 2, value, value * value, 1.0F);
  }
  return frame;
}

Frame plain(std::uint32_t width, std::uint32_t height, const Rgba& color) {
  return {width, height, std::vector<Rgba>(std::size_t{width} * height, color)};
}

TEST(ContactSheet, scaling_takes_the_mean_of_what_a_pixel_covers) {
  Frame frame = plain(4, 2, {0, 0, 0, 1});
  for (std::uint32_t i = 0; i < 8; ++i) frame.pixels[i].r = static_cast<float>(i);
  const Frame half = scaled_down(frame, 2);
  ASSERT_EQ(half.width, 2U);
  ASSERT_EQ(half.height, 1U);
  EXPECT_EQ(half.pixels[0].r, (0 + 1 + 4 + 5) / 4.0F);
  EXPECT_EQ(half.pixels[1].r, (2 + 3 + 6 + 7) / 4.0F);
  const Frame third = scaled_down(frame, 3);  // 4/3 by 2/2 pixels: one and a third
  EXPECT_EQ(third.height, 2U);
  EXPECT_NEAR(third.pixels[0].r, (0 + 1 / 3.0 * 1) / (4 / 3.0), 1e-6);
  EXPECT_EQ(scaled_down(frame, 9).pixels, frame.pixels);
  EXPECT_EQ(scaled_down(plain(37, 23, {0.25F, 0.5F, 1, 1}), 11).pixels, plain(11, 7, {0.25F, 0.5F, 1, 1}).pixels);
}

TEST(ContactSheet, what_is_displayed_has_the_bytes_of_previews) {
  const Frame frame = gradient(97, 31);
  for (const double exposure : {0.0, -1.5}) {
    const PreviewStyle style{nullptr, exposure};
    EXPECT_EQ(encode_displayed(as_displayed(frame, style), style), encode_png(frame, style));
  }
}

TEST(ContactSheet, lines_keep_their_width) {
  for (const char* text :
       {"a", "autumn leaves in the evening sun", "an_unbroken_name_that_is_far_too_long_for_a_picture", " ",
        "\xff\xfe broken", "\u30ac\u30e9\u30b9 \u03bb \u00e4", "two\nlines\tand a tab"}) {
    const std::vector<TextMask> lines = drawn_lines(text, 13, 90, 2);
    EXPECT_LE(lines.size(), 2U) << text;
    for (const TextMask& line : lines) EXPECT_LE(line.width, 90U) << text;
  }
  EXPECT_TRUE(drawn_lines("", 13, 90, 2).empty());
  EXPECT_EQ(drawn_lines("autumn leaves", 13, 1000, 2).size(), 1U);
  EXPECT_EQ(drawn_lines(std::string(100'000, 'x'), 13, 90, 3).size(), 3U);
  EXPECT_LE(drawn_lines("narrow", 13, 1, 2).size(), 2U);
}

TEST(ContactSheet, text_covers_pixels) {
  const TextMask mask = drawn_text("EV", 20);
  EXPECT_GT(std::ranges::count(mask.coverage, 255), 20);
  EXPECT_GE(mask.height, 20U);
  EXPECT_GT(drawn_text("EVEV", 20).width, mask.width);
}

ContactSheet sheet_of(std::size_t count) {
  ContactSheet sheet;
  sheet.title = "product";
  sheet.groups.emplace_back();
  for (std::size_t i = 0; i < count; ++i)
    sheet.groups[0].pictures.push_back(
        {plain(100, 50, {0, 0.5F, 0, 1}), "look " + std::to_string(i), {"roughness 0.5"}});
  return sheet;
}

std::ptrdiff_t green_pixels(const Frame& frame) {
  return std::ranges::count_if(frame.pixels, [](const Rgba& p) { return p.r == 0 && p.g == 0.5F && p.b == 0; });
}

TEST(ContactSheet, every_picture_is_there_whole) {
  for (const std::uint32_t columns : {0U, 1U, 3U, 50U}) {
    ContactSheet sheet = sheet_of(7);
    sheet.columns = columns;
    const Frame drawn = draw_contact_sheet(sheet);
    EXPECT_EQ(green_pixels(drawn), 7 * 100 * 50);
    EXPECT_TRUE(std::ranges::all_of(drawn.pixels, [](const Rgba& pixel) { return pixel.a == 1; }));
    EXPECT_TRUE(std::ranges::any_of(drawn.pixels, [](const Rgba& pixel) { return pixel == Rgba(1, 1, 1, 1); }));
  }
}

TEST(ContactSheet, a_grid_keeps_rows_columns_and_empty_places) {
  ContactSheet sheet = sheet_of(6);
  sheet.groups[0].pictures[4].frame = {};
  sheet.groups[0].grid = SheetGroup::Grid{{"intensity", {"10", "60"}}, {"colour", {"red", "green", "blue"}}};
  const Frame drawn = draw_contact_sheet(sheet);
  EXPECT_EQ(green_pixels(drawn), 5 * 100 * 50);
  EXPECT_GT(drawn.width, 3 * 100U);
  EXPECT_LT(drawn.width, 5 * 100U);
}

TEST(ContactSheet, nothing_is_a_sheet_too) {
  EXPECT_GT(draw_contact_sheet({}).width, 0U);
  EXPECT_GT(draw_contact_sheet(sheet_of(0)).width, 0U);
}

TEST(ContactSheet, too_large_a_sheet_is_refused) {
  ContactSheet sheet = sheet_of(800);
  sheet.columns = 1000;
  EXPECT_THROW((void)draw_contact_sheet(sheet), UsageError);
}

}  // namespace
}  // namespace relook
