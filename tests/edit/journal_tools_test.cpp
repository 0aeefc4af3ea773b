// `relook journal`: variants, animations and wedges become journals that replay exactly. Other people's scenes lie
// beside the project, in ../shared/assets; without that folder their tests skip and say so.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "gltf_writer.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSource = RELOOK_SOURCE_DIR;
const std::filesystem::path kAssets = kSource / ".." / "shared" / "assets";
const std::string kSpheres = (kSource / "scenes/spheres/spheres.gltf").string();

Json read_json(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  return parse_json(text_of(bytes), path.string());
}

class JournalTools : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  ProgramResult journal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {RELOOK_PROGRAM, "journal"});
    arguments.insert(arguments.end(), {"-o", at("made.json")});
    return run_program(arguments);
  }
  void expect_refusal(const std::vector<std::string>& arguments, int exit_code, const std::string& part) const {
    const ProgramResult result = journal(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
    EXPECT_FALSE(std::filesystem::exists(at("made.json")));
  }
  [[nodiscard]] Json made() const { return read_json(at("made.json")); }
  /// Replays what was made with --verify: frames beside frame 0.
  [[nodiscard]] Json replayed(const std::string& scene, const std::vector<std::string>& view) const {
    const Json report = verified_report({scene, at("made.json"), "96x54", view}, folder_);
    if (!report.contains("steps")) return Json::array();
    for (const Json& step : report["steps"]) EXPECT_EQ(step["verify"]["pixels_different"], 0) << step["name"];
    return report["steps"];
  }
  ScratchFolder folder_{"journal_tools"};
};

bool any_pixel_changed(const Json& steps) {
  for (const Json& step : steps)
    if (step["step"] > 0 && step["pixels_changed"] > 0) return true;
  return false;
}

TEST_F(JournalTools, a_wedge_has_values_names_and_ranges) {
  const std::string path = "/materials/Paint/pbrMetallicRoughness/baseColorFactor";
  const ProgramResult result = journal({"wedge", kSpheres, path, "[1,0,0,1]", "[0,0,1,1]", "[0,0,0,1]..[0,1,0,1]:3"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("2 steps, 5 frames"), std::string::npos) << result.output;
  EXPECT_EQ(made()["steps"][0]["wedge"]["values"], Json::parse("[[1,0,0,1],[0,0,1,1]]"));
  EXPECT_EQ(made()["steps"][1]["wedge"]["range"], Json::parse(R"({"from": [0,0,0,1], "to": [0,1,0,1], "count": 3})"));
  EXPECT_TRUE(any_pixel_changed(replayed(kSpheres, {})));
}

TEST_F(JournalTools, a_wedge_has_negative_numbers) {
  ASSERT_EQ(journal({"wedge", kSpheres, "/nodes/CentralSphere/translation/0", "-1..-0.5:2", "-0.25"}).exit_code, 0);
  EXPECT_EQ(made()["steps"][0]["wedge"]["range"], Json::parse(R"({"from": -1, "to": -0.5, "count": 2})"));
  EXPECT_EQ(made()["steps"][1]["wedge"]["values"], Json::parse("[-0.25]"));
}

TEST_F(JournalTools, what_is_wrong_is_said_and_nothing_is_written) {
  const std::string path = "/materials/Paint/pbrMetallicRoughness/roughnessFactor";
  expect_refusal({"wedge", kSpheres, path}, 1, "VALUES");
  expect_refusal({"wedge", kSpheres, path, "[1,"}, 1, "\"[1,\" is neither JSON, a name nor a range");
  expect_refusal({"wedge", kSpheres, path, "0.5", "2"}, 2, "2 is above 1");
  expect_refusal({"wedge", kSpheres, "/materials/Pant/doubleSided", "true"}, 2, "did you mean \"Paint\"?");
  expect_refusal({"variants", kSpheres}, 2, "the scene has no variants");
  expect_refusal({"animation", kSpheres}, 2, "the scene has no animations");
  expect_refusal({"varants", kSpheres}, 1, "no kind of journal \"varants\"; did you mean \"variants\"?");
  expect_refusal({"wedge", at("missing.gltf"), path, "1"}, 2, "missing.gltf");
}

/// A square, a light and a camera, apart; node 3 carries nothing.
SceneFile scene_with_light() {
  SceneFile file = square();
  file.gltf["nodes"] = {
      {{"name", "Square"}, {"mesh", 0}},
      {{"name", "Eye"}, {"camera", 0}, {"translation", {0.5, 0.5, 3}}},
      {{"name", "Lamp"}, {"translation", {0.5, 0.5, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  file.gltf["scenes"] = {{{"nodes", {0, 1, 2}}}};
  file.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"name", "Bulb"}, {"type", "point"}, {"intensity", 20}}};
  file.gltf["textures"] = Json::array();
  file.gltf["materials"] = {{{"name", "Paint"}}};
  return file;
}

/// Adds a channel with its sampler to the first animation; `target` as in the file.
void animate(SceneFile& file, const Json& target, const Json& sampler) {
  Json& animation = file.gltf["animations"][0];
  animation["channels"].push_back({{"sampler", animation["samplers"].size()}, {"target", target}});
  animation["samplers"].push_back(sampler);
}

Json pointer_target(const std::string& pointer) {
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

TEST_F(JournalTools, an_animation_of_nodes_is_a_drag) {
  SceneFile file = scene_with_light();
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1);
  animate(file, {{"node", 0}, {"path", "translation"}},
          {{"input", times}, {"output", file.floats({0, 0, 0, 1, 0, 0.5}, "VEC3", 3)}});
  animate(file, {{"node", 0}, {"path", "rotation"}},
          {{"input", times}, {"output", file.floats({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4)}, {"interpolation", "STEP"}});
  animate(file, {{"node", 1}, {"path", "translation"}},
          {{"input", times}, {"output", file.floats({0, 0, 3, 0, 0, 4}, "VEC3", 3)}});
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  const ProgramResult result = journal({"animation", at("scene.glb"), "--fps", "4"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("/nodes/1/translation is left out: node \"Eye\" holds the camera"), std::string::npos)
      << result.output;
  const Json step = made()["steps"][0];
  EXPECT_EQ(step["select"], Json::parse(R"(["/nodes/Square"])"));
  ASSERT_EQ(step["drag"].size(), 5);
  EXPECT_EQ(step["drag"][0], Json::array());  // as in the file
  EXPECT_EQ(step["drag"][1],
            Json::parse(R"([{"op": "replace", "path": "/nodes/Square/translation", "value": [0.25, 0, 0.125]}])"));
  EXPECT_EQ(step["drag"][4][1]["value"], Json::parse("[0, 0, 1, 0]"));
  EXPECT_TRUE(any_pixel_changed(replayed(at("scene.glb"), {})));
}

TEST_F(JournalTools, an_animation_of_morph_weights_is_a_drag) {
  SceneFile file = scene_with_light();
  file.primitive()["targets"] = {
      {{"POSITION", file.floats({0, 0, 0, 0.5F, 0, 0, 0, 0.5F, 0, -0.5F, -0.5F, 0}, "VEC3", 3)}},
      {{"POSITION", file.floats({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3", 3)}}};
  file.gltf["meshes"][0]["weights"] = {0.25, 0};
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1);
  animate(file, {{"node", 0}, {"path", "weights"}},
          {{"input", times}, {"output", file.floats({0.25, 0, 1, 0.5}, "SCALAR", 1)}});
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  const ProgramResult result = journal({"animation", at("scene.glb"), "--fps", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json step = made()["steps"][0];
  ASSERT_EQ(step["drag"].size(), 3);
  EXPECT_EQ(step["drag"][1],
            Json::parse(R"([{"op": "replace", "path": "/nodes/Square/weights", "value": [0.625, 0.25]}])"));
  EXPECT_TRUE(any_pixel_changed(replayed(at("scene.glb"), {})));
}

TEST_F(JournalTools, an_animation_that_moves_nothing_makes_no_journal) {
  SceneFile file = scene_with_light();
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1);
  file.gltf["nodes"].push_back({{"name", "Empty"}});
  const std::size_t empty = file.gltf["nodes"].size() - 1;
  file.gltf["scenes"][0]["nodes"].push_back(empty);
  animate(file, {{"node", empty}, {"path", "translation"}},
          {{"input", times}, {"output", file.floats({0, 0, 0, 1, 0, 0}, "VEC3", 3)}});
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  expect_refusal({"animation", at("scene.glb"), "--fps", "2"}, 2, "the animation moves nothing that the scene shows");
  file.gltf["animations"][0]["samplers"][0]["output"] = file.floats({0, 0, 0, 0, 0, 0}, "VEC3", 3);
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  expect_refusal({"animation", at("scene.glb")}, 2, "animation \"animation_0\" changes nothing of the scene");
}

TEST_F(JournalTools, an_animation_of_other_properties_is_an_edit_a_frame) {
  SceneFile file = scene_with_light();
  const std::size_t times = file.floats({1, 2}, "SCALAR", 1);
  animate(file, pointer_target("/materials/0/pbrMetallicRoughness/baseColorFactor"),
          {{"input", times}, {"output", file.floats({0, 0, 0, 1, 1, 0.5, 0, 1}, "VEC4", 4)}});
  animate(file, pointer_target("/extensions/KHR_lights_punctual/lights/0/intensity"),
          {{"input", times},
           {"output", file.floats({0, 20, -400, 0, 40, 0}, "SCALAR", 1)},
           {"interpolation", "CUBICSPLINE"}});
  animate(file, pointer_target("/nodes/2/extensions/KHR_node_visibility/visible"),
          {{"input", times},
           {"output", file.add_accessor(file.add_view<std::uint8_t>({1, 0}), 5121, "SCALAR", 2)},
           {"interpolation", "STEP"}});
  animate(file, pointer_target("/cameras/0/perspective/yfov"),
          {{"input", times}, {"output", file.floats({1, 0.5}, "SCALAR", 1)}});
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  const ProgramResult result = journal({"animation", at("scene.glb"), "--fps", "2", "--from", "1.5", "--to", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("/cameras/0/perspective/yfov is left out"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("leaves its range"), std::string::npos) << result.output;  // 30 - 400 / 8 < 0
  const Json steps = made()["steps"];
  ASSERT_EQ(steps.size(), 2);
  EXPECT_EQ(steps[0]["name"], "animation_0 at 1.5 s");
  EXPECT_EQ(steps[0]["edit"][0]["value"], Json::parse("[0.5, 0.25, 0, 1]"));
  EXPECT_EQ(steps[0]["edit"][1]["path"], "/lights/Bulb/intensity");
  EXPECT_EQ(steps[0]["edit"][1]["value"], 0);
  EXPECT_EQ(steps[1]["edit"][2]["path"], "/nodes/Lamp/extensions/KHR_node_visibility/visible");
  EXPECT_EQ(steps[1]["edit"][2]["value"], false);
  EXPECT_TRUE(any_pixel_changed(replayed(at("scene.glb"), {})));
}

TEST_F(JournalTools, what_no_journal_can_say_of_an_animation_is_refused) {
  SceneFile file = scene_with_light();
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1);
  animate(file, {{"node", 1}, {"path", "translation"}},
          {{"input", times}, {"output", file.floats({0, 0, 3, 0, 0, 4}, "VEC3", 3)}});
  std::ofstream(at("scene.glb"), std::ios::binary) << file.glb();
  expect_refusal({"animation", at("scene.glb")}, 2, "no journal can express animation \"animation_0\"");
  expect_refusal({"animation", at("scene.glb"), "--camera", "auto", "--from", "2"}, 1, "--from 2.0 is after the end");
  expect_refusal({"animation", at("scene.glb"), "--animation", "anmation_0"}, 2, "did you mean \"animation_0\"?");
  expect_refusal({"animation", at("scene.glb"), "--camera", "auto", "--fps", "10000", "--to", "2"}, 2,
                 "more than 10000.0 frames");
}

class JournalToolsAssets : public JournalTools {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kAssets)) GTEST_SKIP() << "no ../shared/assets beside the project: NOT tested";
  }
};

TEST_F(JournalToolsAssets, variants_of_a_lamp_replay_exactly) {
  const std::string scene = (kAssets / "stained-glass-lamp-1k/StainedGlassLamp.gltf").string();
  ASSERT_EQ(journal({"variants", scene}).exit_code, 0);
  const Json steps = made()["steps"];
  ASSERT_EQ(steps.size(), 2);
  EXPECT_EQ(steps[1]["name"], "Lamp off");
  EXPECT_EQ(steps[1]["edit"].size(), 5);
  const Json frames = replayed(scene, {"--camera", "auto", "--lights", "auto"});
  ASSERT_EQ(frames.size(), 3);
  EXPECT_EQ(frames[1]["pixels_changed"], 0);  // "Lamp on" is how the file has it
  EXPECT_GT(frames[2]["pixels_changed"], 0);
}

TEST_F(JournalToolsAssets, the_cover_of_a_dish_turns_exactly) {
  const std::string scene = (kAssets / "iridescent-dish-with-olives/IridescentDishWithOlives.gltf").string();
  ASSERT_EQ(journal({"animation", scene, "--fps", "1"}).exit_code, 0);
  EXPECT_EQ(made()["steps"][0]["drag"].size(), 7);
  EXPECT_TRUE(any_pixel_changed(replayed(scene, {"--lights", "auto"})));
}

TEST_F(JournalToolsAssets, an_animated_box_moves_exactly) {
  const std::string scene = (kAssets / "khronos-small/BoxAnimated/glTF-Binary/BoxAnimated.glb").string();
  ASSERT_EQ(journal({"animation", scene, "--fps", "4"}).exit_code, 0);
  const Json frames = replayed(scene, {"--camera", "auto", "--lights", "auto"});
  EXPECT_GT(frames.size(), 10);
  EXPECT_TRUE(any_pixel_changed(frames));
}

}  // namespace
}  // namespace relook
