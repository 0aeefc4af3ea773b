// `relook sheet`: every frame asked for is on it, its pixels are the previews' or the frames', and nothing else is
// written or replaced.
#include <gtest/gtest.h>

#include "frame/frame_file.h"
#include "frame/sheet/contact_sheet.h"
#include "report/own_file.h"
#include "report/run_folder.h"

namespace relook {
namespace {

class Sheet : public RunFolderTest {
 protected:
  void SetUp() override {
    RunFolderTest::SetUp();
    std::vector<Json> steps = steps_of_journal();
    steps.push_back({{"name", "grid"},
                     {"wedge",
                      {{{"path", "/materials/Glass/extensions/KHR_materials_ior/ior"}, {"values", {1.2, 1.6}}},
                       {{"path", "/materials/Paint/pbrMetallicRoughness/roughnessFactor"},
                        {"values", {0.1, 0.5, 0.9}},
                        {"label", "gloss"}}}}});
    write_journal("j.json", steps);
    ASSERT_EQ(replay("run").exit_code, 0);
  }
  [[nodiscard]] ProgramResult sheet(const std::string& output, const std::vector<std::string>& further = {}) const {
    std::vector<std::string> arguments{"sheet", at("run"), "-o", at(output), "--progress", "none"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return relook(arguments);
  }
  [[nodiscard]] static Json json_of(const ProgramResult& result) { return parse_json(result.output, "--json"); }
  /// Whether a frame stands in a sheet, pixel by pixel.
  static bool holds(const Frame& sheet, const Frame& frame) {
    const auto is_at = [&](std::uint32_t left, std::uint32_t top) {
      for (std::uint32_t y = 0; y < frame.height; ++y)
        for (std::uint32_t x = 0; x < frame.width; ++x)
          for (int channel = 0; channel < 3; ++channel)
            if (sheet.pixels[std::size_t{top + y} * sheet.width + left + x][channel] !=
                frame.pixels[std::size_t{y} * frame.width + x][channel])
              return false;
      return true;
    };
    for (std::uint32_t y = 0; y + frame.height <= sheet.height; ++y)
      for (std::uint32_t x = 0; x + frame.width <= sheet.width; ++x)
        if (is_at(x, y)) return true;
    return false;
  }
};

TEST_F(Sheet, an_exr_holds_the_frames_bit_for_bit) {
  const ProgramResult result = sheet("sheet.exr", {"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(json_of(result)["pictures"], 1 + 1 + 3 + 1 + 3 + 1 + 6);
  const Frame drawn = decode_exr(at("sheet.exr"));
  for (const char* name : {"0000", "0002_02", "0004_03", "0006_05"})
    EXPECT_TRUE(holds(drawn, decode_exr(at("run/frames/" + std::string(name) + ".exr")))) << name;
  EXPECT_TRUE(is_own_file(at("sheet.exr"), OwnKind::frame));
}

TEST_F(Sheet, steps_columns_and_width_are_obeyed) {
  const Json all = json_of(sheet("a.png", {"--json", "--columns", "2"}));
  const Json some = json_of(sheet("a.png", {"--json", "--columns", "2", "--steps", "4-4"}));
  EXPECT_EQ(some["pictures"], 3);
  EXPECT_LT(some["height"], all["height"]);
  EXPECT_TRUE(is_own_file(at("a.png"), OwnKind::preview)) << "so that it was replaced";
  const ProgramResult narrow = sheet("narrow.exr", {"--width", "16", "--steps", "0-0"});
  ASSERT_EQ(narrow.exit_code, 0) << narrow.output;
  const Frame drawn = decode_exr(at("narrow.exr"));
  Frame base = scaled_down(decode_exr(at("run/frames/0000.exr")), 16);
  for (Rgba& pixel : base.pixels)
    for (int channel = 0; channel < 3; ++channel) pixel[channel] = stored_value(pixel[channel], PixelFormat::half);
  EXPECT_TRUE(holds(drawn, base));
}

TEST_F(Sheet, wrong_asks_are_one_line_and_write_nothing) {
  write_text("mine.png", "not a picture");
  expect_refused("", {"--overwrite"}, [&] { return sheet("mine.png"); });
  expect_refused("", {".exr", ".png"}, [&] { return sheet("sheet.jpg"); });
  expect_refused("", {"--steps"}, [&] { return sheet("sheet.png", {"--steps", "90-99"}); });
  expect_refused("", {"--exposure"}, [&] { return sheet("sheet.exr", {"--exposure", "1"}); });
  const ProgramResult none = relook({"sheet", at("c"), "-o", at("sheet.png")});
  EXPECT_EQ(none.exit_code, 2) << none.output;
  EXPECT_FALSE(std::filesystem::exists(at("sheet.png")));
}

}  // namespace
}  // namespace relook
