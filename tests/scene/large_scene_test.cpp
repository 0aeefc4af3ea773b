// Scenes and journals of sizes that no artist makes by hand but exporters and scripts do: each is read and rendered,
// and takes memory in proportion. Times are not asserted; what grows with the square of a size does not end here.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

/// A quad, a lamp and nothing else.
Json small_scene() {
  return parse_json(R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 500}]}},
    "buffers": [{"byteLength": 44, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA="}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "meshes": [{"name": "Triangle", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "materials": [{"name": "M"}],
    "nodes": [{"name": "Triangle", "mesh": 0},
              {"name": "Lamp", "translation": [0, 0, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "scenes": [{"nodes": [0, 1]}], "scene": 0})",
                    "scene");
}

void add_node(Json& scene, Json node) {
  scene["scenes"][0]["nodes"].push_back(scene["nodes"].size());
  scene["nodes"].push_back(std::move(node));
}

class LargeScene : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const Json& json) const {
    std::ofstream(at(name)) << json.dump();
    return at(name);
  }
  /// `bytes_each`: of memory, at most, for each of `count`.
  void expect_rendered(const Json& scene, std::size_t count, double bytes_each) const {
    const MeasuredResult result =
        measure_relook({"render", write("scene.gltf", scene), "-o", at("x.exr"), "--overwrite", "--quiet", "--camera",
                        "0.3,0.3,4:0.3,0.3,0:40", "--resolution", "16x9"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_LT(result.peak_mib, 64 + static_cast<double>(count) * bytes_each / (1 << 20));
  }
  ScratchFolder folder_{"large_scene"};
};

TEST_F(LargeScene, nodes_by_the_hundred_thousand) {
  constexpr std::size_t kCount = 100'000;
  Json scene = small_scene();
  for (std::size_t i = 0; i < kCount; ++i) add_node(scene, {{"name", "n" + std::to_string(i)}});
  expect_rendered(scene, kCount, 4000);
}

TEST_F(LargeScene, nodes_of_one_name) {
  constexpr std::size_t kCount = 20'000;
  Json scene = small_scene();
  for (std::size_t i = 0; i < kCount; ++i) add_node(scene, {{"name", "same"}});
  expect_rendered(scene, kCount, 6000);
}

TEST_F(LargeScene, nodes_deep_below_one_another) {
  constexpr std::size_t kCount = 1000;
  Json scene = small_scene();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (i > 0) scene["nodes"].back()["children"] = {scene["nodes"].size()};
    i == 0 ? add_node(scene, {{"name", "top"}}) : scene["nodes"].push_back({{"name", "below"}});
  }
  expect_rendered(scene, kCount, 10000);
}

TEST_F(LargeScene, materials_meshes_and_textures) {
  constexpr std::size_t kCount = 20'000;
  Json scene = small_scene();
  for (std::size_t i = 0; i < kCount; ++i) {
    scene["materials"].push_back({{"name", "m" + std::to_string(i)}});
    Json mesh = scene["meshes"][0];
    mesh["primitives"][0]["material"] = i + 1;
    scene["meshes"].push_back(std::move(mesh));
    add_node(scene, {{"mesh", i + 1}, {"translation", {0.01 * static_cast<double>(i), 0, -0.001}}});
    scene["textures"].push_back(Json::object());
  }
  expect_rendered(scene, kCount, 30000);
}

/// Behind glass, too, and edited: names of lights and registers are enough for it.
TEST_F(LargeScene, lights_by_the_thousand) {
  constexpr std::size_t kCount = 2000;
  Json scene = small_scene(), edits = Json::array(), removals = Json::array();
  Json& lights = scene["extensions"]["KHR_lights_punctual"]["lights"];
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::string number = std::to_string(i);
    lights.push_back({{"name", "L" + number}, {"type", "point"}, {"intensity", 0.5}});
    add_node(scene, {{"name", "N" + number},
                     {"translation", {0.01 * static_cast<double>(i % 100), 0.1 * static_cast<double>(i / 100), 2}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", i + 1}}}}}});
    edits.push_back({{"op", "replace"}, {"path", "/lights/L" + number + "/intensity"}, {"value", 0.7}});
    if (i % 2 == 0) removals.push_back({{"op", "remove"}, {"path", "/nodes/N" + number}});
  }
  scene["extensionsUsed"].push_back("KHR_materials_transmission");
  scene["materials"].push_back(
      {{"name", "Glass"}, {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}});
  scene["meshes"].push_back(scene["meshes"][0]);
  scene["meshes"][1]["primitives"][0]["material"] = 1;
  for (int pane = 0; pane < 6; ++pane) add_node(scene, {{"mesh", 1}, {"translation", {0, 0, 0.2 + 0.2 * pane}}});
  const Json journal{{"relook", "journal/1"},
                     {"steps", {{{"name", "all"}, {"edit", edits}}, {{"name", "half"}, {"edit", removals}}}}};
  const MeasuredResult made = measure_relook({"preprocess", write("scene.gltf", scene), "-o", at("c"), "--quiet",
                                              "--camera", "0.3,0.3,4:0.3,0.3,0:40", "--resolution", "16x9"});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_LT(made.peak_mib, 512);
  const MeasuredResult replayed = measure_relook(
      {"replay", at("c"), write("j.json", journal), "-o", at("run"), "--quiet", "--verify", "--report", "json"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output;
  EXPECT_LT(replayed.peak_mib, 768);
}

TEST_F(LargeScene, a_wedge_of_a_million_frames_and_a_journal_of_many_steps) {
  ASSERT_EQ(measure_relook({"preprocess", write("scene.gltf", small_scene()), "-o", at("c"), "--quiet", "--camera",
                            "0.3,0.3,4:0.3,0.3,0:40", "--resolution", "16x9"})
                .exit_code,
            0);
  const std::string lamp = "/lights/light_0/intensity";
  const Json wedge{{"path", lamp}, {"range", {{"from", 1}, {"to", 2}, {"count", 999'999}}}};
  const MeasuredResult first =
      measure_relook({"replay", at("c"), write("w.json", {{"relook", "journal/1"}, {"steps", {{{"wedge", wedge}}}}}),
                      "-o", at("w"), "--quiet", "--steps", "0-0", "--report", "json"});
  EXPECT_EQ(first.exit_code, 0) << first.output;
  EXPECT_LT(first.peak_mib, 128);
  std::array<double, 2> peaks{};
  for (const std::size_t i : {0U, 1U}) {
    const std::size_t count = i == 0 ? 50 : 500;
    Json steps = Json::array();
    for (std::size_t k = 0; k < count; ++k)
      steps.push_back({{"edit", {{{"op", "replace"}, {"path", lamp}, {"value", 100 + k}}}}});
    const MeasuredResult run =
        measure_relook({"replay", at("c"), write("j.json", {{"relook", "journal/1"}, {"steps", steps}}), "-o", at("r"),
                        "--quiet", "--overwrite", "--fresh", "--report", "json", "--memory", "200M"});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    peaks[i] = run.peak_mib;
  }
  EXPECT_LT(peaks[1], peaks[0] + 6) << "of " << peaks[0] << " MiB";
}

}  // namespace
}  // namespace relook
