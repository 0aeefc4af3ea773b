// Frames with --aovs as scripts and other programs see them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "layer_file.h"
#include "run_program.h"

namespace relook {
namespace {

const char* const kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "slide", "select": ["/nodes/CentralSphere"], "drag": [
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.1, 1, 0]}],
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.2, 1, 0]}]]},
  {"name": "a second ball", "edit": [{"op": "add", "path": "/nodes/Another",
                                      "value": {"mesh": "PaintBall", "translation": [-1, 1, 1]}}]},
  {"name": "away", "edit": [{"op": "remove", "path": "/nodes/LeftSphere"}]},
  {"name": "bent", "edit": [{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior",
                             "value": 1.2}]}]})";

class LayersCli : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void relook(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    const ProgramResult result = run_program(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  void make_frame() {
    relook({"render", kScene, "--integrator", "whitted", "-o", at("f.exr"), "--resolution", "72x40", "--samples", "3",
            "--aovs", "--quiet"});
  }
  /// False, and said, when a program that others use to read frames is not installed.
  [[nodiscard]] static bool has(const std::string& program) {
    if (run_program({"sh", "-c", "command -v " + program}).exit_code == 0) return true;
    std::printf("skipped: no %s here; install openexr and openimageio-tools\n", program.c_str());
    return false;
  }
  ScratchFolder folder_{"layers_cli"};
};

TEST_F(LayersCli, a_replay_writes_the_files_of_full_renders) {
  std::ofstream(at("j.json")) << kJournal;
  relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "72x40", "--samples", "2",
          "--quiet"});
  relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--aovs", "--quiet", "--verify"});
  std::map<std::string, std::string> last_frames;  // by step
  const Json report = parse_json(text_of(read_file(at("run/report.json"))), "report.json");
  for (const Json& entry : report["steps"])
    last_frames[std::to_string(entry["step"].get<int>())] = entry["frame"].get<std::string>();
  for (const std::string step : {"0", "1", "2", "3", "4", "5"}) {
    relook({"render", kScene, "--integrator", "whitted", "-o", at(step + ".exr"), "--resolution", "72x40", "--samples",
            "2", "--aovs", "--quiet", "--journal", at("j.json"), "--step", step});
    // Frame 0 of a replay belongs to its journal, as step 0 of a render with a journal does.
    EXPECT_EQ(frame_bytes(at(step + ".exr")), frame_bytes(at("run/" + last_frames.at(step)))) << step;
  }
  const LayerFile dragged = read_layers(at("run/frames/0002_01.exr"));
  for (std::size_t i = 0; i < dragged.channel("G").size(); ++i)  // of where the ball is now: half rounds to 2^-11
    EXPECT_LE(std::fabs(dragged.channel("lights_rest.G")[i]), dragged.channel("G")[i] / 1024) << i;
  const LayerFile green = read_layers(at("run/frames/0001.exr"));
  EXPECT_GT(std::ranges::count(green.channel("changed.A"), 1.0F), 20);
  EXPECT_GT(std::ranges::count(dragged.channel("changed.A"), 1.0F), 0);
  EXPECT_NE(read_layers(at("run/frames/0003.exr")).attributes.at("cryptomatte/3ae39a5/manifest").find("Another"),
            std::string::npos);
}

TEST_F(LayersCli, without_the_flag_there_are_no_layers) {
  make_frame();
  relook({"render", kScene, "--integrator", "whitted", "-o", at("plain.exr"), "--resolution", "72x40", "--samples", "3",
          "--quiet"});
  const LayerFile plain = read_layers(at("plain.exr")), layered = read_layers(at("f.exr"));
  EXPECT_EQ(plain.channels.size(), 4U);
  EXPECT_EQ(plain.attributes.size(), 4U);  // OpenEXR's type; scene, step and class
  for (const auto& [name, values] : plain.channels) EXPECT_EQ(values, layered.channel(name)) << name;
  EXPECT_EQ(run_program({RELOOK_PROGRAM, "compare", at("plain.exr"), at("f.exr"), "--quiet"}).exit_code, 10);
}

TEST_F(LayersCli, exrheader_lists_the_layers) {
  if (!has("exrheader")) GTEST_SKIP() << "no exrheader here; install openexr";
  make_frame();
  const ProgramResult result = run_program({"exrheader", at("f.exr")});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* part :
       {"depth.Z, 32-bit", "N.X, 32-bit", "light_Lamp.R, 32-bit", "CryptoObject00.A, 32-bit", "R, 16-bit",
        "cryptomatte/3ae39a5/name (type string): \"CryptoObject\"", "relook:lights (type string): \"light_Lamp "})
    EXPECT_NE(result.output.find(part), std::string::npos) << part << "\n" << result.output;
}

TEST_F(LayersCli, oiiotool_adds_the_layers_up_to_the_frame) {
  if (!has("oiiotool") || !has("idiff")) GTEST_SKIP() << "no oiiotool and idiff here; install openimageio-tools";
  make_frame();
  const LayerFile file = read_layers(at("f.exr"));
  for (const std::string sum : {"relook:lights", "relook:paths"}) {
    std::vector<std::string> command{"oiiotool"};
    for (const std::string& layer : file.layers_of_sum(sum)) {
      const bool is_first = command.size() == 1;
      for (const std::string& word : {at("f.exr"), std::string("--ch"), layer + ".R," + layer + ".G," + layer + ".B"})
        command.push_back(word);
      if (!is_first) command.push_back("--add");
    }
    for (const std::string& word : {std::string("-d"), std::string("float"), std::string("-o"), at("sum.exr")})
      command.push_back(word);
    ASSERT_EQ(run_program(command).exit_code, 0);
    ASSERT_EQ(run_program({"oiiotool", at("f.exr"), "--ch", "R,G,B", "-d", "float", "-o", at("rgb.exr")}).exit_code, 0);
    const ProgramResult difference = run_program({"idiff", "-fail", "0", "-warn", "0", at("sum.exr"), at("rgb.exr")});
    EXPECT_EQ(difference.exit_code, 0) << sum << difference.output;
  }
}

}  // namespace
}  // namespace relook
