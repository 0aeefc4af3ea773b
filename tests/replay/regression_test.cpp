// Faults that the program once had; each test is named after what broke.
#include <gtest/gtest.h>

#include <fstream>

#include "replay/replay.h"
#include "run_program.h"
#include "scene/texture/procedural.h"
#include "test_scenes.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

Replayer replayer_of(SceneState state) {
  Image image = preprocessed(state.scene(), {});
  return Replayer(std::move(state), std::move(image));
}

void expect_exact(Replayer& replayer, const Edit& edit) {
  replayer.step(edit, "journal", ".");
  const SceneState fresh = compiled_again(replayer.state());
  EXPECT_TRUE(different_pixels(replayer.image().frame, rendered(fresh.scene(), {})).empty());
}

/// A box that fills the view below an environment of denormal numbers: no image, so that Embree's commit is the first
/// work that TBB sees in `render`, while `replay` reads a cache first.
void write_denormal_scene(const fs::path& path) {
  std::ofstream(path)
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2], "extras": {"relook": {
    "environment": {"color": [1e-20, 1e-20, 1e-20], "intensity": 1e-20}}}}],
    "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
    "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]},
              {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 3, 3]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})";
}

TEST(Regression, DenormalColorsAreTheSameInEveryProcess) {
  const ScratchFolder folder("denormal");
  const fs::path scene = folder / "scene.gltf", journal = folder / "j.json", cache = folder / "c", run = folder / "run";
  write_denormal_scene(scene);
  std::ofstream(journal) << R"({"relook": "journal/1", "steps": [{"name": "brighter", "edit": [
    {"op": "replace", "path": "/scene/extras/relook/environment/intensity", "value": 1.1e-20}]}]})";
  const std::string size = "48x48";
  const auto succeeds = [](const std::vector<std::string>& words) {
    std::vector<std::string> command{RELOOK_PROGRAM};
    command.insert(command.end(), words.begin(), words.end());
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 0) << result.output;
  };
  succeeds({"preprocess", scene, "--integrator", "whitted", "-o", cache, "--resolution", size});
  succeeds({"replay", cache, journal, "-o", run, "--float", "--verify"});
  succeeds({"render", scene, "--integrator", "whitted", "-o", folder / "full.exr", "--resolution", size, "--float",
            "--journal", journal});
  succeeds({"compare", run / "frames" / "0001.exr", folder / "full.exr"});
}

TEST(Regression, HiddenNodeAddedBeforeALightMoves) {
  Replayer replayer = replayer_of(spheres_scene(40, 30));
  expect_exact(
      replayer,
      parsed_edit(R"([{"op": "add", "path": "/nodes/Shown", "value": {"mesh": "Ball", "translation": [0, 2, 0]}}])"));
  Json nodes = Json::array();
  for (int i = 0; i < 40; ++i)
    nodes.push_back({{"op", "add"},
                     {"path", "/nodes/Hidden" + std::to_string(i)},
                     {"value", {{"mesh", "Ball"}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}}}});
  expect_exact(replayer, edit_of(nodes));
  expect_exact(replayer, replace_edit("/nodes/Lamp/translation", {1, 4, 2}));
}

TEST(Regression, ManyOctavesLeaveFarTexturesTheirPattern) {
  Procedural noise;
  noise.octaves = 16;
  noise.scale = 100;
  const Rgba a = evaluate(noise, Point(10.3F, 0.2F, 0.1F)), b = evaluate(noise, Point(10.305F, 0.2F, 0.1F));
  EXPECT_NE(a.r, b.r);
}

TEST(Regression, FortyLightsHaveTheirOwnPrograms) {
  SceneBuilder scene;
  const int grey = scene.material("Grey", Json::object());
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(4, 4), grey)}});
  scene.node("Block",
             {{"mesh", scene.mesh("Block", box_mesh(Point(0.4F, 0.4F, 0.4F)), grey)}, {"translation", {0, 0.5, 0}}});
  for (int i = 0; i < 40; ++i)
    scene.light("Lamp" + std::to_string(i), {{"type", "point"}, {"intensity", 2}},
                {{"translation", {3 * std::cos(i * 0.157), 1.5, 3 * std::sin(i * 0.157)}}});
  scene.look_at(Point(0, 3, 5), Point(0, 0, 0), 50, 40, 30);
  Replayer replayer = replayer_of(scene.state());
  expect_exact(replayer, replace_edit("/lights/Lamp7/color", {1, 0, 0}));
  expect_exact(replayer, replace_edit("/nodes/Block/translation", {0.5, 0.5, 0.3}));
  expect_exact(replayer, replace_edit("/nodes/Lamp33/translation", {0, 2, 0}));
}

}  // namespace
}  // namespace relook
