// --exposure: what people look at is brighter or darker, what is compared and composited is not.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/json.h"
#include "compare/compare.h"
#include "frame/frame_file.h"
#include "frame/preview.h"
#include "run_program.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

TEST(Exposure, previews_show_the_frame_times_a_power_of_two) {
  Frame frame{5, 1, {}};
  for (const float value : {0.0F, 0.003F, 0.1F, 40.0F, 3e5F}) frame.pixels.emplace_back(value, value * 0.5F, -value, 1);
  for (const double stops : {-100.0, -3.5, 0.0, 2.0, 100.0}) {
    Frame times = frame;
    const auto gain = static_cast<float>(std::exp2(stops));
    for (Rgba& pixel : times.pixels) pixel = Rgba(pixel.r * gain, pixel.g * gain, pixel.b * gain, pixel.a);
    EXPECT_EQ(encode_png(frame, {nullptr, stops}), encode_png(times)) << stops;
  }
  EXPECT_NE(encode_png(frame, {nullptr, 2}), encode_png(frame));
}

class ExposedRun : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": [
      {"name": "red", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                                "value": [0.9, 0.1, 0.1, 1]}]},
      {"name": "glass", "wedge": {"path": "/materials/Glass/extensions/KHR_materials_ior/ior", "values": [1.2, 1.7]}}]})";
    ASSERT_EQ(
        relook({"preprocess", kScene, "-o", at("c"), "--integrator", "whitted", "--resolution", "72x40", "--quiet"})
            .exit_code,
        0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] ProgramResult replay(const std::string& run, const std::vector<std::string>& further) const {
    std::vector<std::string> arguments{"replay", at("c"), at("j.json"), "-o", at(run), "--progress", "none"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return relook(arguments);
  }
  [[nodiscard]] Json report(const std::string& run) const {
    return parse_json(text_of(read_file(at(run + "/report.json"))), "report.json");
  }
  /// Everything but what stands in the header.
  void expect_same_pixels(const std::string& a, const std::string& b) const {
    EXPECT_EQ(compare_frames(decode_exr(at(a)), decode_exr(at(b))).pixels_different, 0U) << a;
  }
  const std::vector<std::string> kStems{"0000", "0001", "0002_01", "0002_02"};
  ScratchFolder folder_{"exposure"};
};

TEST_F(ExposedRun, differs_in_previews_headers_and_report_alone) {
  ASSERT_EQ(replay("plain", {}).exit_code, 0);
  ASSERT_EQ(replay("bright", {"--exposure", "2.5"}).exit_code, 0);
  for (const std::string& stem : kStems) {
    expect_same_pixels("bright/frames/" + stem + ".exr", "plain/frames/" + stem + ".exr");
    EXPECT_EQ(own_frame_meta(at("bright/frames/" + stem + ".exr"))->exposure, "2.5");
    EXPECT_EQ(own_frame_meta(at("plain/frames/" + stem + ".exr"))->exposure, "");
    EXPECT_NE(read_file(at("bright/previews/" + stem + ".png")), read_file(at("plain/previews/" + stem + ".png")));
  }
  EXPECT_EQ(report("plain")["options"]["exposure"], 0);
  EXPECT_EQ(report("bright")["options"]["exposure"], 2.5);
  for (const Json& step : report("bright")["steps"]) EXPECT_EQ(step["exposure"], 2.5) << step["name"];
  // What a replay writes is what render writes.
  for (const char* name : {"last.png", "last.exr"})
    ASSERT_EQ(relook({"render", kScene, "-o", at(name), "--integrator", "whitted", "--resolution", "72x40", "--journal",
                      at("j.json"), "--exposure", "2.5", "--quiet"})
                  .exit_code,
              0);
  EXPECT_EQ(read_file(at("last.png")), read_file(at("bright/previews/0002_02.png")));
  EXPECT_EQ(read_file(at("last.exr")), read_file(at("bright/frames/0002_02.exr")));
}

TEST_F(ExposedRun, another_exposure_is_no_other_run) {
  ASSERT_EQ(replay("run", {"--exposure", "3"}).exit_code, 0);
  ASSERT_EQ(replay("dark", {"--exposure", "-3"}).exit_code, 0);
  const ProgramResult again = replay("run", {"--exposure", "-3"});
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(again.output.find("warning"), std::string::npos) << again.output;
  for (const std::string& stem : kStems)
    for (const std::string& file : {"previews/" + stem + ".png", "frames/" + stem + ".exr"})
      EXPECT_EQ(read_file(at("run/" + file)), read_file(at("dark/" + file))) << file;
  EXPECT_EQ(report("run")["options"]["exposure"], -3);
  EXPECT_NE(replay("run", {"--exposure=-3"}).output.find("complete"), std::string::npos);
}

TEST_F(ExposedRun, is_a_number_of_stops) {
  for (const char* wrong : {"nan", "inf", "100.5", "-101", "bright"}) {
    const ProgramResult result = replay("refused", {"--exposure", wrong});
    EXPECT_EQ(result.exit_code, 1) << wrong << ": " << result.output;
    EXPECT_NE(result.output.find("--exposure"), std::string::npos) << result.output;
    EXPECT_FALSE(fs::exists(at("refused")));
  }
}

TEST_F(ExposedRun, pages_show_it) {
  ASSERT_EQ(replay("plain", {}).exit_code, 0);
  ASSERT_EQ(replay("bright", {"--exposure", "4", "--overlays"}).exit_code, 0);
  const std::string page(text_of(read_file(at("bright/report.html"))));
  EXPECT_NE(page.find("\"exposure\":4"), std::string::npos);
  const auto compared = [&](const std::string& name, const std::vector<std::string>& further) {
    std::vector<std::string> words{"compare", at("plain/frames/0000.exr"), at("plain/frames/0001.exr"), "--html",
                                   at(name)};
    words.insert(words.end(), further.begin(), further.end());
    EXPECT_EQ(relook(words).exit_code, 10);
    return text_of(read_file(at(name)));
  };
  EXPECT_NE(compared("a.html", {}), compared("b.html", {"--exposure", "4"}));
  EXPECT_EQ(compared("c.html", {}), compared("d.html", {"--exposure", "0"}));
}

TEST_F(ExposedRun, outlines_stay_white) {
  ASSERT_EQ(replay("dark", {"--exposure", "-20", "--overlays"}).exit_code, 0);
  const auto overlay = decode_pyramid(read_file(at("dark/overlays/0001_groups.png")), true, "overlay", "");
  std::size_t white = 0;
  for (std::size_t i = 0; i < std::size_t{72} * 40; ++i) white += overlay->texels8[4 * i] == 255 ? 1 : 0;
  EXPECT_GT(white, 0U);
}

}  // namespace
}  // namespace relook
