// `relook journal turntable | aim | rig`, and journals made from caches: what they write replays exactly, and the
// numbers are those that the angles say.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cli_fixture.h"
#include "gltf_writer.h"

namespace relook {
namespace {

constexpr double kHalf = std::numbers::sqrt2 / 2;

class JournalMoves : public Cli {
 protected:
  ProgramResult journal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "journal");
    arguments.insert(arguments.end(), {"-o", at("made.json")});
    return relook(arguments);
  }
  [[nodiscard]] Json made() const { return read_json(at("made.json"))["steps"]; }
  void expect_refusal(const std::vector<std::string>& arguments, int exit_code, const std::string& part) const {
    const ProgramResult result = journal(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
    EXPECT_FALSE(std::filesystem::exists(at("made.json")));
  }
  /// Replays what was made, each frame compared with a full render. Returns the frames but the first.
  [[nodiscard]] Json replayed(const std::string& scene, const std::vector<std::string>& view) const {
    const Json report = verified_report({scene, at("made.json"), "64x36", view}, folder_);
    if (!report.contains("steps")) return Json::array();
    for (const Json& step : report["steps"]) EXPECT_EQ(step["verify"]["pixels_different"], 0) << step["name"];
    return report["steps"];
  }
  static void expect_near(const Json& numbers, const std::vector<double>& expected) {
    ASSERT_EQ(numbers.size(), expected.size()) << numbers;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(numbers[i].get<double>(), expected[i], 1e-6) << numbers;
  }
  /// A square from 0 to 1 in x and y below a node that is moved, turned and scaled evenly; a spot; a camera at z = 5.
  [[nodiscard]] std::string scene() const {
    SceneFile file = square();
    file.gltf["textures"] = Json::array();
    file.gltf["materials"] = {{{"name", "Paint"}}};
    file.gltf["nodes"] = {
        {{"name", "Square"}, {"mesh", 0}, {"translation", {1, 0, 0}}},
        {{"name", "Eye"}, {"camera", 0}, {"translation", {0, 0, 5}}},
        {{"name", "Lamp"}, {"translation", {0, 3, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
        {{"name", "Arm"},
         {"children", {0}},
         {"translation", {0, 1, 0}},
         {"rotation", {0, 0.7071067811865476, 0, 0.7071067811865476}},
         {"scale", {2, 2, 2}}}};
    file.gltf["scenes"] = {{{"nodes", {1, 2, 3}}}};
    file.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"name", "Bulb"}, {"type", "spot"}, {"intensity", 20}, {"spot", Json::object()}}};
    write_text(at("scene.glb"), file.glb());
    return at("scene.glb");
  }
};

TEST_F(JournalMoves, a_turntable_turns_a_node_about_its_own_middle) {
  ASSERT_EQ(journal({"turntable", scene(), "Square", "--frames", "4"}).exit_code, 0);
  const Json step = made()[0];
  EXPECT_EQ(step["select"], Json::parse(R"(["/nodes/Square"])"));
  ASSERT_EQ(step["drag"].size(), 4U);
  // A quarter turn about y: as the node's parent is turned about y, too, its own rotation is the same.
  EXPECT_EQ(step["drag"][0][0]["path"], "/nodes/Square/rotation");
  expect_near(step["drag"][0][0]["value"], {0, kHalf, 0, kHalf});
  // Its middle, (1.5, 0.5, 0) in the arm's space, stays: the corner that was at its left is now in front of it.
  EXPECT_EQ(step["drag"][0][1]["path"], "/nodes/Square/translation");
  expect_near(step["drag"][0][1]["value"], {1.5, 0, 0.5});
  // The last frame is the first one, to the bit.
  EXPECT_EQ(step["drag"][3][0]["value"], Json::parse("[0, 0, 0, 1]"));
  EXPECT_EQ(step["drag"][3][1]["value"], Json::parse("[1, 0, 0]"));
  EXPECT_EQ(replayed(scene(), {"--samples", "1"}).size(), 6U);  // the base, four frames, the drag as a whole
}

TEST_F(JournalMoves, a_turntable_of_all_turns_what_shows_something_and_no_camera_or_light) {
  ASSERT_EQ(journal({"turntable", scene(), "all", "--frames", "2", "--degrees", "90", "--about", "origin"}).exit_code,
            0);
  const Json step = made()[0];
  EXPECT_EQ(step["select"], Json::parse(R"(["/nodes/Arm"])"));
  EXPECT_EQ(step["drag"][1].size(), 1U) << "it stands on the axis";
  expect_near(step["drag"][1][0]["value"], {0, 1, 0, 0});
}

TEST_F(JournalMoves, a_turntable_of_the_environment_turns_it_alone) {
  ASSERT_EQ(journal({"turntable", kScene, "--environment", "--frames", "8"}).exit_code, 0);
  ASSERT_EQ(made().size(), 1U);
  const Json wedge = made()[0]["wedge"];
  EXPECT_EQ(wedge["path"], "/scene/extras/relook/environment/rotation");
  EXPECT_NEAR(wedge["range"]["from"].get<double>(), std::numbers::pi / 4, 1e-9);
  EXPECT_NEAR(wedge["range"]["to"].get<double>(), 2 * std::numbers::pi, 1e-9);
  ASSERT_EQ(journal({"turntable", kScene, "all", "--environment", "--frames", "3"}).exit_code, 0);
  EXPECT_EQ(made().size(), 2U);
}

TEST_F(JournalMoves, a_light_is_aimed_at_a_node_or_a_point) {
  ASSERT_EQ(journal({"aim", scene(), "Bulb", "0,0,0"}).exit_code, 0);
  ASSERT_EQ(made()[0]["edit"].size(), 1U);
  EXPECT_EQ(made()[0]["edit"][0]["path"], "/nodes/Lamp/rotation");
  expect_near(made()[0]["edit"][0]["value"], {-kHalf, 0, 0, kHalf});  // -z to -y
  ASSERT_EQ(journal({"aim", scene(), "Lamp", "-1,3,0"}).exit_code, 0);
  expect_near(made()[0]["edit"][0]["value"], {0, kHalf, 0, kHalf});  // -z to -x
  ASSERT_EQ(
      journal({"aim", scene(), "Lamp", "Square", "--azimuth", "90", "--elevation", "0", "--distance", "4"}).exit_code,
      0);
  // The square's middle is (0, 2, -3) in the world; the camera's right hand is nearly +x there.
  expect_near(made()[0]["edit"][0]["value"], {0, kHalf, 0, kHalf});
  expect_near(made()[0]["edit"][1]["value"], {4, 2, -3});
  ASSERT_EQ(
      journal({"aim", scene(), "Lamp", "Square", "--orbit", "4", "--elevation", "30", "--distance", "3"}).exit_code, 0);
  EXPECT_EQ(made()[0]["drag"].size(), 4U);
  EXPECT_EQ(replayed(scene(), {"--samples", "1"}).size(), 6U);  // the base, four frames, the drag as a whole
}

TEST_F(JournalMoves, what_cannot_be_turned_or_aimed_is_refused_in_one_line) {
  expect_refusal({"turntable", scene(), "Sqare"}, 2, "did you mean \"Square\"?");
  expect_refusal({"turntable", scene(), "Eye"}, 2, "camera");
  expect_refusal({"turntable", scene(), "Square", "--axis", "w"}, 1, "--axis");
  expect_refusal({"turntable", scene(), "Square", "--frames", "0"}, 1, "--frames");
  expect_refusal({"aim", scene(), "Bulp", "0,0,0"}, 2, "Bulp");
  expect_refusal({"aim", scene(), "Lamp", "0,0"}, 2, "no node \"0,0\"");
  expect_refusal({"aim", scene(), "Lamp", "Lamp"}, 2, "give --distance");
  expect_refusal({"rig", scene(), "--style", "sofboxes"}, 1, "--style");
  expect_refusal({"rig", scene(), "--target", "Lamp"}, 2, "shows nothing to light");
}

TEST_F(JournalMoves, a_rig_is_lit_all_at_once_and_each_light_alone) {
  ASSERT_EQ(journal({"rig", kScene, "--target", "CentralSphere", "--replace"}).exit_code, 0);
  const Json steps = made();
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0]["name"], "rig");
  EXPECT_EQ(steps[1]["name"], "Key only");
  EXPECT_EQ(steps[1]["from"], "rig");
  std::size_t added = 0;
  for (const Json& operation : steps[0]["edit"]) added += operation["op"] == "add" ? 1 : 0;
  EXPECT_EQ(added, 6U);
  for (const Json& operation : steps[1]["edit"]) EXPECT_NE(operation["path"], "/lights/Key/intensity");
  const Json frames = replayed(kScene, {"--integrator", "path", "--samples", "4"});
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_GT(frames[i]["pixels_changed"], 0) << frames[i]["name"];
}

TEST_F(JournalMoves, every_style_of_rig_checks_also_with_lamps) {
  for (const char* style : {"three-point", "softboxes", "rim", "product"}) {
    ASSERT_EQ(journal({"rig", kScene, "--style", style}).exit_code, 0) << style;
    ASSERT_EQ(journal({"rig", kScene, "--style", style, "--lamps"}).exit_code, 0) << style;
    EXPECT_EQ(made()[0]["edit"][0]["value"]["type"], "spot");
  }
  EXPECT_EQ(replayed(kScene, {"--integrator", "whitted"}).size(), 6U);
}

TEST_F(JournalMoves, a_cache_is_as_good_as_its_scene) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  const std::vector<std::vector<std::string>> kinds{
      {"wedge", "SCENE", "/materials/Paint/pbrMetallicRoughness/roughnessFactor", "0.1..0.9:3"},
      {"turntable", "SCENE", "Cube", "--frames", "3"},
      {"aim", "SCENE", "Lamp", "Cube", "--distance", "2"},
      {"rig", "SCENE"}};
  for (std::vector<std::string> kind : kinds) {
    kind[1] = kScene;
    ASSERT_EQ(journal(kind).exit_code, 0) << kind[0];
    const Json of_scene = made();
    kind[1] = at("c");
    ASSERT_EQ(journal(kind).exit_code, 0) << kind[0];
    EXPECT_EQ(made(), of_scene) << kind[0];
  }
  ASSERT_EQ(journal({"diff", at("c"), kScene}).exit_code, 0);
  EXPECT_TRUE(made()[0]["edit"].empty()) << "nothing differs";
  std::filesystem::remove(at("made.json"));
  expect_refusal({"animation", at("c")}, 2, "a cache holds no animations");
  expect_refusal({"variants", at("c")}, 2, "no variants");
  expect_refusal({"rig", at("c"), "--camera", "auto"}, 1, "is a cache, whose look and view are fixed");
}

}  // namespace
}  // namespace relook
