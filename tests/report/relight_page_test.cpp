// `replay --relight` as a user has it: files beside the frames, what becomes of them, and the panel of the page, whose
// frames are held against replays of the journal steps that it gives.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "base/files.h"
#include "frame/frame_file.h"
#include "frame/half_bits.h"
#include "page_browser.h"
#include "run_folder.h"

namespace relook {
namespace {

Json replace(const std::string& path, Json value) {
  return Json::array({{{"op", "replace"}, {"path", path}, {"value", std::move(value)}}});
}

/// Lights of every kind that a page has sliders for: a lamp, two that share a sum, an area with a temperature, what
/// emits, the environment, ambient light.
const char* const kLights = R"([
  {"op": "add", "path": "/lights/Softbox", "value": {"type": "rect", "intensity": 40,
    "size": 2, "rect": {"aspect": 2}, "extras": {"relook": {"temperature": 4500}}}},
  {"op": "add", "path": "/nodes/Softbox", "value": {"translation": [3, 3, 2], "rotation": [-0.2, 0.45, 0.1, 0.865],
    "extensions": {"EXT_lights_area": {"light": "Softbox"}}}},
  {"op": "add", "path": "/lights/Left", "value": {"type": "point", "intensity": 20, "color": [1, 0.5, 0.25],
    "extras": {"relook": {"sum": "pair"}}}},
  {"op": "add", "path": "/nodes/Left", "value": {"translation": [-3, 2, 2], "extensions": {"KHR_lights_punctual": {"light": "Left"}}}},
  {"op": "add", "path": "/lights/Right", "value": {"type": "point", "intensity": 30, "color": [0.25, 0.5, 1],
    "extras": {"relook": {"sum": "pair"}}}},
  {"op": "add", "path": "/nodes/Right", "value": {"translation": [3, 1, 3], "extensions": {"KHR_lights_punctual": {"light": "Right"}}}},
  {"op": "add", "path": "/lights/Spare", "value": {"type": "point", "intensity": 0}},
  {"op": "add", "path": "/nodes/Spare", "value": {"translation": [0, 4, 2], "extensions": {"KHR_lights_punctual": {"light": "Spare"}}}},
  {"op": "replace", "path": "/materials/Marble/emissiveFactor", "value": [0.5, 0.25, 0.125]}])";

class RelightRun : public RunFolderTest {
 protected:
  void SetUp() override {
    std::ofstream(at("lights.json")) << kLights;
    write_journal("j.json", steps_of_lights());
    const ProgramResult made = relook({"preprocess", kScene, "--look", at("lights.json"), "-o", at("c"), "--resolution",
                                       "96x54", "--samples", "4", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }
  static std::vector<Json> steps_of_lights() {
    return {{{"name", "warmer"}, {"edit", replace("/lights/Lamp/color", {1, 0.7, 0.4})}},
            {{"name", "how bright"}, {"wedge", {{"path", "/lights/Softbox/intensity"}, {"values", {20, 80}}}}},
            {{"name", "slide"}, {"edit", replace("/nodes/CentralSphere/translation", {0.3, 1.3, 0})}},
            color_step("paint", 0.2)};
  }
  [[nodiscard]] bool is_there(const std::string& file) const { return std::filesystem::exists(at(file)); }

  /// The frames of the steps that the page gave, behind those of the journal.
  std::vector<Frame> replayed(std::size_t count) {
    std::vector<Json> steps = steps_of_lights();
    for (std::size_t i = 0; i < count; ++i) {
      const Bytes bytes = read_file(at("relit_" + std::to_string(i) + ".json"));
      steps.push_back(parse_json(text_of(bytes), "relit.json"));
    }
    write_journal("relit.json", steps);
    const ProgramResult result = replay("relit", {"--report", "none", "--verify"}, "relit.json");
    EXPECT_EQ(result.exit_code, 0) << result.output;
    std::vector<Frame> frames;
    for (std::size_t i = steps.size() - count; i < steps.size() && result.exit_code == 0; ++i) {
      char frame[64];
      std::snprintf(frame, sizeof frame, "relit/frames/%04zu.exr", i + 1);
      frames.push_back(decode_exr(at(frame)));
    }
    return frames;
  }
};

/// Places of two halves among all halves: neighbours are one apart. Requires: neither is negative.
int apart(std::uint16_t a, std::uint16_t b) { return std::abs(static_cast<int>(a) - static_cast<int>(b)); }

TEST_F(RelightRun, frames_lit_in_the_page_are_those_of_the_journal_steps_that_it_gives) {
  ASSERT_EQ(replay("run", {"--relight"}).exit_code, 0);
  const auto entry = [](const char* label, const char* preview, Json turns) {
    return Json{{"label", label}, {"preview", preview}, {"turns", std::move(turns)}};
  };
  const Json entries = Json::array(
      {entry("0", "previews/0000.png", Json::array({{"Lamp", "stops", 1}})),
       entry(
           "0", "previews/0000.png",
           Json::array({{"pair", "stops", -1.5}, {"pair", "red", 0.25}, {"Softbox", "solo", 1}, {"pair", "solo", 1}})),
       entry("1", "previews/0001.png",
             Json::array({{"Marble", "stops", 2}, {"Environment", "blue", 0.1}, {"Lamp", "mute", 1}})),
       entry("2_01", "previews/0002_01.png",
             Json::array({{"Softbox", "stops", 1}, {"Softbox", "green", 0.3}, {"Ambient light", "mute", 1}})),
       entry("2", "previews/0002_02.png", Json::array({{"Spare", "mute", 1}, {"Spare", "stops", 6}})),
       entry("4", "previews/0004.png", Json::array({{"Environment", "stops", -3}, {"Lamp", "stops", -8}}))});
  // The pixels that it has written are read below.
  use_in_browser("relight_page.py", at("run"), {{"entries", entries}, {"without", nullptr}}, folder_);
  if (IsSkipped() || HasFailure()) return;
  const std::vector<Frame> frames = replayed(entries.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    const Bytes relit = read_file(at("relit_" + std::to_string(i) + ".bin"));
    const std::size_t pixels = frame.pixels.size();
    ASSERT_EQ(relit.size(), pixels * 6) << i;
    std::size_t off = 0, exact = 0;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, &relit[2 * (channel * pixels + pixel)], sizeof bits);
        const int distance = apart(bits, half_bits(frame.pixels[pixel][static_cast<int>(channel)]));
        off += distance > 2 ? 1U : 0U;
        exact += distance == 0 ? 1U : 0U;
      }
    EXPECT_EQ(off, 0U) << entries[i].dump() << ": values more than two halves apart";
    EXPECT_GT(exact, pixels * 3 / 2) << entries[i].dump();
  }
}

TEST_F(RelightRun, a_run_without_layers_says_how_to_get_them) {
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_FALSE(is_there("run/relight"));
  use_in_browser("relight_page.py", at("run"), {{"entries", Json::array()}, {"without", "1"}}, folder_);
}

TEST_F(RelightRun, files_are_noted_and_made_where_they_are_missing) {
  ASSERT_EQ(replay("plain").exit_code, 0);
  ASSERT_EQ(replay("run", {"--relight", "--steps", "0-2"}).exit_code, 0);
  EXPECT_TRUE(is_there("run/relight/0002_01.exr"));
  EXPECT_FALSE(is_there("run/relight/0003.exr"));
  ASSERT_EQ(replay("run", {"--steps", "3-"}).exit_code, 0);
  EXPECT_FALSE(is_there("run/relight/0003.exr"));
  ASSERT_EQ(replay("run", {"--relight"}).exit_code, 0);
  std::map<std::string, std::string> whole = hashes_below(at("run") + "/relight");
  EXPECT_EQ(whole.size(), 6U);
  EXPECT_EQ(hashes_below(at("run") + "/frames"), hashes_below(at("plain") + "/frames"));
  ASSERT_EQ(replay("at_once", {"--relight", "--memory", "256M"}).exit_code, 0);
  EXPECT_EQ(hashes_below(at("at_once") + "/relight"), whole) << "whatever is in memory, and in whatever parts";
  EXPECT_NE(replay("run", {"--relight"}).output.find("complete"), std::string::npos) << "nothing to do";

  std::filesystem::remove(at("run") + "/relight/0001.exr");
  std::ofstream(at("run") + "/relight/0003.exr", std::ios::app) << "more";
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_EQ(hashes_below(at("run") + "/frames").size(), 6U);
  ASSERT_EQ(replay("run", {"--relight"}).exit_code, 0);
  EXPECT_EQ(hashes_below(at("run") + "/relight"), whole);
  ASSERT_EQ(replay("run", {"--relight", "--fresh"}).exit_code, 0);
  EXPECT_EQ(hashes_below(at("run") + "/relight"), whole);
}

TEST_F(RelightRun, files_of_steps_that_are_replaced_go_and_foreign_ones_are_refused) {
  ASSERT_EQ(replay("run", {"--relight"}).exit_code, 0);
  std::vector<Json> steps = steps_of_lights();
  steps.resize(1);
  write_journal("j.json", steps);
  ASSERT_EQ(replay("run", {"--overwrite"}).exit_code, 0);
  EXPECT_EQ(hashes_below(at("run") + "/relight").size(), 2U);
  EXPECT_FALSE(is_there("run/pixels/relight_00003_1.js"));

  write_journal("j.json", steps_of_lights());
  std::filesystem::create_directories(at("other") + "/relight");
  ASSERT_EQ(replay("other", {"--steps", "0"}).exit_code, 1) << "a folder that is no run";
  std::ofstream(at("run") + "/relight/0003.exr") << "mine";
  const ProgramResult refused = replay("run", {"--relight"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("0003.exr"), std::string::npos) << refused.output;
}

TEST_F(RelightRun, whitted_frames_are_no_sums_and_are_refused_in_a_line) {
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("w"), "--resolution", "32x18", "--quiet"})
                .exit_code,
            0);
  const ProgramResult refused = relook({"replay", at("w"), at("j.json"), "-o", at("run"), "--relight"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("--relight"), std::string::npos) << refused.output;
  EXPECT_FALSE(is_there("run/frames"));
}

}  // namespace
}  // namespace relook
