// Previews through OpenColorIO: what $OCIO says, or one clear line.
#include "frame/display_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "frame/preview.h"
#include "run_program.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

/// Linear to its square root, red and blue swapped.
const char* const kConfig = R"(ocio_profile_version: 2
roles: {default: raw, scene_linear: linear}
displays:
  Wall:
    - !<View> {name: Swapped roots, colorspace: roots}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: linear}
  - !<ColorSpace>
    name: roots
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}
)";

class DisplayViews : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(at("config.ocio")) << kConfig; }
  void TearDown() override { unsetenv("OCIO"); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::shared_ptr<const DisplayView> view_of(const std::string& config) {
    setenv("OCIO", config.c_str(), 1);
    return display_view_of_environment();
  }
  [[nodiscard]] std::string error_of(const std::string& config) const {
    try {
      (void)view_of(config);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  ProgramResult replay(const std::string& config, const std::string& run) const {
    return run_program(
        {"env", "OCIO=" + config, RELOOK_PROGRAM, "replay", at("c"), at("j.json"), "-o", at(run), "--quiet"});
  }
  void preprocess() const {
    ASSERT_EQ(run_program({RELOOK_PROGRAM, "preprocess", kScene, "-o", at("c"), "--resolution", "72x40", "--quiet"})
                  .exit_code,
              0);
    std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": [{"name": "dim", "edit": [
        {"op": "replace", "path": "/lights/Lamp/intensity", "value": 20}]}]})";
  }
  ScratchFolder folder_{"display_views"};
};

TEST_F(DisplayViews, are_those_of_the_config) {
  const std::shared_ptr<const DisplayView> view = view_of(at("config.ocio"));
  ASSERT_TRUE(view);
  const Rgba shown = view->apply(Rgba(0.25F, 0.5F, 0.0625F, 1));
  EXPECT_NEAR(shown.r, 0.25F, 1e-4F);
  EXPECT_NEAR(shown.g, std::sqrt(0.5F), 1e-4F);
  EXPECT_NEAR(shown.b, 0.5F, 1e-4F);
  Frame frame{2, 1, {Rgba(0.25F, 0.5F, 0.0625F, 1), Rgba(-1, 0, 9, 1)}};
  const auto pyramid = decode_pyramid(encode_png(frame, {view}), true, "preview", "");
  const std::vector<std::uint8_t> row(pyramid->texels8.begin(), pyramid->texels8.begin() + 7);
  EXPECT_EQ(row, (std::vector<std::uint8_t>{64, 180, 128, 255, 255, 0, 0}));
}

TEST_F(DisplayViews, are_none_without_a_config) {
  unsetenv("OCIO");
  EXPECT_FALSE(display_view_of_environment());
  EXPECT_FALSE(view_of(""));
}

TEST_F(DisplayViews, updated_previews_equal_fresh_ones) {
  const std::shared_ptr<const DisplayView> view = view_of(at("config.ocio"));
  Frame frame{70, 40, std::vector<Rgba>(70 * 40, Rgba(0.1F, 0.2F, 0.3F, 1))};
  PreviewEncoder encoder(70, 40, {view});
  encoder.update(frame);
  EXPECT_EQ(encoder.png(), encode_png(frame, {view}));
  EXPECT_NE(encoder.png(), encode_png(frame));
  frame.pixels[70 * 20 + 65] = Rgba(0.9F, 0.8F, 0.7F, 1);
  encoder.update(frame, ChangedPixels(std::vector<std::uint32_t>{70 * 20 + 65}, 70));
  EXPECT_EQ(encoder.png(), encode_png(frame, {view}));
}

TEST_F(DisplayViews, bad_configs_are_one_line) {
  std::ofstream(at("text.ocio")) << "this is\nno config: [";
  std::ofstream(at("empty.ocio"));
  std::string lost = kConfig;
  lost.replace(lost.find("colorspace: roots"), 17, "colorspace: lost!");
  std::ofstream(at("lost.ocio")) << lost;
  std::string blind = kConfig;
  blind.replace(blind.find("scene_linear: linear"), 20, "data: raw");
  std::ofstream(at("blind.ocio")) << blind;
  for (const std::string name : {"none.ocio", "text.ocio", "empty.ocio", "lost.ocio", "blind.ocio"}) {
    const std::string what = error_of(at(name));
    EXPECT_TRUE(what.starts_with(at(name) + ": $OCIO names no usable OpenColorIO config: ")) << name << ": " << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

TEST_F(DisplayViews, a_replay_uses_or_refuses_them_before_it_writes) {
  preprocess();
  const ProgramResult refused = replay(at("none.ocio"), "run");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_TRUE(refused.output.starts_with("relook: " + at("none.ocio") + ": $OCIO")) << refused.output;
  EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  EXPECT_FALSE(std::filesystem::exists(at("run")));
  ASSERT_EQ(replay(at("config.ocio"), "seen").exit_code, 0);
  ASSERT_EQ(replay("", "plain").exit_code, 0);
  for (const char* frame : {"/frames/0000.exr", "/frames/0001.exr"})
    EXPECT_EQ(frame_bytes(at("seen") + frame), frame_bytes(at("plain") + frame)) << "frames are linear";
  EXPECT_NE(read_file(at("seen/previews/0001.png")), read_file(at("plain/previews/0001.png")));
  const Bytes seen = read_file(at("seen/report.html")), plain = read_file(at("plain/report.html"));
  EXPECT_NE(text_of(seen).find("\"name\":\"Wall, Swapped roots\""), std::string_view::npos) << "for its page, too";
  EXPECT_NE(text_of(plain).find("id=\"display-view\">null<"), std::string_view::npos);
}

TEST_F(DisplayViews, oiiotool_shows_the_same) {
  if (run_program({"sh", "-c", "command -v oiiotool && command -v idiff"}).exit_code != 0)
    GTEST_SKIP() << "no oiiotool and idiff here; install openimageio-tools";
  preprocess();
  ASSERT_EQ(replay(at("config.ocio"), "seen").exit_code, 0);
  const ProgramResult shown =
      run_program({"env", "OCIO=" + at("config.ocio"), "oiiotool", at("seen/frames/0001.exr"), "--ch", "R,G,B",
                   "--ociodisplay:from=linear", "Wall", "Swapped roots", "-d", "uint8", "-o", at("shown.png")});
  ASSERT_EQ(shown.exit_code, 0) << shown.output;
  const ProgramResult difference =  // frames are rounded to half, previews are not: a code apart here and there
      run_program({"idiff", "-fail", "0.0079", "-warn", "0.0079", at("shown.png"), at("seen/previews/0001.png")});
  EXPECT_EQ(difference.exit_code, 0) << difference.output;
}

}  // namespace
}  // namespace relook
