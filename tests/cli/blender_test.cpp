// scenes/from_blender.py, run by Blender on the scene that blender_scene.py makes: what stands in the look patch, in
// numbers that follow from that scene. Skipped where there is no Blender.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kSource(RELOOK_SOURCE_DIR);
const std::string kScript = (kSource / "scenes/from_blender.py").string();
constexpr double kDigits = 2e-5;  // relative: what six digits, and the matrices of floats behind them, are good for

ProgramResult run_blender(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"blender", "-b", "-t", "1"});
  return run_program(arguments);
}

Json json_of(const fs::path& file) {
  const Bytes bytes = read_file(file);
  return parse_json(text_of(bytes), file.string());
}

/// Why Blender cannot export here; "" if it can.
std::string what_is_lacking() {
  if (run_program({"blender", "--version"}).exit_code != 0) return "Blender is not installed";
  const bool has_numpy = run_blender({"--python-exit-code", "3", "--python-expr", "import numpy"}).exit_code == 0;
  return has_numpy ? "" : "Blender's Python has no numpy, which its glTF exporter needs";
}

/// The JSON chunk of a .glb.
Json json_of_glb(const fs::path& file) {
  const Bytes bytes = read_file(file);
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(bytes.at(i)); };
  const std::size_t length = byte(12) | byte(13) << 8 | byte(14) << 16 | byte(15) << 24;
  return parse_json(text_of(bytes).substr(20, length), file.string());
}

/// A scene made and exported once for all tests.
struct Export {
  ScratchFolder folder{"blender"};
  ProgramResult made, exported;
  Json patch, gltf;

  Export() {
    const std::string scene = (kSource / "tests/cli/blender_scene.py").string();
    made = run_blender({"--factory-startup", "--python", scene, "--", (folder / "").string()});
    exported = with({"shot.glb"});
    if (!fs::exists(folder / "shot.look.json")) return;
    patch = json_of(folder / "shot.look.json");
    gltf = json_of_glb(folder / "shot.glb");
  }
  /// Exports to a file of the folder. `arguments`: its name, and flags.
  [[nodiscard]] ProgramResult with(std::vector<std::string> arguments) const {
    arguments[0] = (folder / arguments[0]).string();
    arguments.insert(arguments.begin(), {(folder / "scene.blend").string(), "--python", kScript, "--"});
    return run_blender(arguments);
  }
};

/// The value that a patch gives a place; null if there is none. Each place has one operation, an `add`.
Json value_at(const Json& patch, const std::string& path) {
  Json value;
  for (const Json& edit : patch) {
    if (edit.at("path") != path) continue;
    EXPECT_TRUE(value.is_null()) << path;
    EXPECT_EQ(edit.at("op"), "add");
    value = edit.at("value");
  }
  return value;
}

void expect_near(const Json& actual, double expected) {
  ASSERT_TRUE(actual.is_number()) << actual;
  EXPECT_NEAR(actual.get<double>(), expected, kDigits * std::abs(expected));
}

class Blender : public testing::Test {
 protected:
  void SetUp() override {
    static const std::string lack = what_is_lacking();  // a start of Blender takes a second
    if (!lack.empty()) GTEST_SKIP() << lack;
    static std::optional<Export> shared;
    if (!shared) shared.emplace();
    export_ = &*shared;
    ASSERT_TRUE(export_->gltf.is_object()) << export_->made.output << export_->exported.output;
  }
  [[nodiscard]] Json at(const std::string& path) const { return value_at(export_->patch, path); }
  /// An area light and the node that has it: nits, size; rectangles have an aspect, disks 0.
  void expect_area(const std::string& node, const std::string& light, double nits, double size, double aspect) const {
    SCOPED_TRACE(node);
    EXPECT_EQ(at("/nodes/" + node + "/extensions/EXT_lights_area"), Json({{"light", light}}));
    std::string token = light;
    if (light == "Oval/~") token = "Oval~1~0";
    const Json value = at("/lights/" + token);
    ASSERT_TRUE(value.is_object());
    EXPECT_EQ(value["type"], aspect > 0 ? "rect" : "disk");
    expect_near(value["intensity"], nits);
    expect_near(value["size"], size);
    if (aspect > 0) expect_near(value["rect"]["aspect"], aspect);
  }
  /// A line of the script's output.
  [[nodiscard]] bool says(const std::string& line) const {
    return export_->exported.output.find("from_blender.py: " + line + "\n") != std::string::npos;
  }
  const Export* export_ = nullptr;
};

// Cycles: W / (4 area). EXT_lights_area: size is the height, times the largest component of the node's scale.
TEST_F(Blender, area_lamps_become_lights_of_ext_lights_area) {
  constexpr double kPi = std::numbers::pi;
  expect_area("Square", "Square", 100.0 / (4 * 4), 2, 1);
  expect_area("Panel", "Panel", 60.0 / (4 * 3 * 1), 0.5, 3);  // 3 m x 1 m at scales 1.5 and 2
  expect_area("Disc", "Disc", 50 / (4 * kPi / 4), 1, 0);
  expect_area("Oval~1~0", "Oval/~", 50 / (4 * kPi / 4), 1, 0);  // 2 m x 0.5 m, as large as a disk of 1 m
  expect_area("Oval too", "Oval/~", 50 / (4 * kPi / 4), 1, 0);
  expect_area("Small", "Small", 8 / (4 * 0.25), 0.5, 1);
  expect_area("Small_2", "Small_2", 8.0 / 4, 0.5, 1);  // instanced at twice the scale
  EXPECT_EQ(at("/lights/Panel")["color"], Json({1.0, 0.5, 0.25}));
  EXPECT_TRUE(at("/lights/Hidden").is_null());
  EXPECT_EQ(at("/nodes/Panel/extras"), Json({{"relook", {{"visible", true}}}}));
  EXPECT_TRUE(at("/nodes/Square/extras").is_null());
}

TEST_F(Blender, what_gets_lost_is_warned_of_once) {
  EXPECT_TRUE(says(R"(warning: light "Oval/~": an ellipse becomes a disk of the same area)"));
  EXPECT_TRUE(says(R"(warning: light "Narrow": its spread is not exported)"));
  const std::string& output = export_->exported.output;
  std::size_t warnings = 0;
  for (std::size_t i = output.find("warning: "); i != std::string::npos; i = output.find("warning: ", i + 1)) ++warnings;
  EXPECT_EQ(warnings, 2U) << output;
}

TEST_F(Blender, other_lamps_get_their_size_and_what_cycles_makes_of_their_nodes) {
  EXPECT_EQ(at("/lights/Bulb/extras"), Json({{"relook", {{"radius", 0.25}}}}));
  EXPECT_EQ(at("/nodes/Bulb/extras"), Json({{"relook", {{"visible", true}}}}));
  EXPECT_TRUE(at("/lights/Beam/extras").is_null());  // radius 0
  EXPECT_EQ(at("/lights/Sun/extras"), Json({{"relook", {{"angle", 0.01}}}}));
  EXPECT_EQ(at("/lights/Warm/extras"), Json({{"relook", {{"radius", 0.5}, {"temperature", 3000.0}}}}));
  expect_near(at("/lights/Warm/intensity"), 7);  // 4 pi W / (4 pi), times the strength 7 that the exporter drops
  for (const Json& light : export_->gltf["extensions"]["KHR_lights_punctual"]["lights"]) {
    if (light["name"] == "Bulb") expect_near(light["intensity"], 10);
    if (light["name"] == "Beam") expect_near(light["intensity"], 20);
    if (light["name"] == "Sun") expect_near(light["intensity"], 3);
  }
  for (const char* name : {"Bulb", "Beam", "Sun"})
    EXPECT_TRUE(at("/lights/" + std::string(name) + "/intensity").is_null()) << name;
}

// Blender's Mapping turns directions by 0.5 before the lookup, so the image by -0.5; its middle is at +X, relook's at -Z.
TEST_F(Blender, the_world_is_an_image_and_a_background) {
  const Json environment = at("/scene/extras/relook/environment");
  EXPECT_EQ(environment["color"], Json({0.5, 1.0, 1.0}));
  expect_near(environment["intensity"], 2);
  expect_near(environment["rotation"], -0.5 - std::numbers::pi / 2);
  EXPECT_EQ(environment["image"], "world");
  EXPECT_EQ(environment["background"]["color"], Json({0.0, 0.0, 1.0}));
  EXPECT_FALSE(environment["background"].contains("image"));
  EXPECT_EQ(at("/images/world"), Json({{"uri", "shot_world.hdr"}}));
  EXPECT_EQ(read_file(export_->folder / "shot_world.hdr"), read_file(export_->folder / "sky/evening.hdr"));
}

/// A vector turned by a quaternion x, y, z, w.
std::array<double, 3> turned(const Json& q, std::array<double, 3> v) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const std::array u{q[0].get<double>(), q[1].get<double>(), q[2].get<double>()};
  const std::array once = cross(u, v), twice = cross(u, once);
  for (std::size_t i = 0; i < 3; ++i) v[i] += 2 * (q[3].get<double>() * once[i] + twice[i]);
  return v;
}

// An area lamp's node has Blender's axes: the patch gives no place. Blender: Rz(0.7) Ry(0.5) Rx(0.3), z up.
TEST_F(Blender, nodes_of_area_lamps_shine_along_their_minus_z) {
  const auto node = std::ranges::find_if(export_->gltf["nodes"], [](const Json& n) { return n["name"] == "Panel"; });
  const double sx = std::sin(0.3), cx = std::cos(0.3), sy = std::sin(0.5), cy = std::cos(0.5), sz = std::sin(0.7),
               cz = std::cos(0.7);
  const std::array right{cz * cy, sz * cy, -sy};
  const std::array back{cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx};
  const std::array x = turned((*node)["rotation"], {1, 0, 0}), z = turned((*node)["rotation"], {0, 0, 1});
  const auto near = [](const std::array<double, 3>& gltf, const std::array<double, 3>& blender) {
    return std::abs(gltf[0] - blender[0]) + std::abs(gltf[1] - blender[2]) + std::abs(gltf[2] + blender[1]) < 1e-5;
  };
  EXPECT_TRUE(near(x, right));
  EXPECT_TRUE(near(z, back));
  const Json scale = (*node)["scale"];
  expect_near(scale[0], 1.5);
  expect_near(scale[1], 2);
}

TEST_F(Blender, relook_takes_the_files_and_the_flags_that_are_printed) {
  const std::string glb = (export_->folder / "shot.glb").string(), look = (export_->folder / "shot.look.json").string();
  const std::string frame = (export_->folder / "shot.exr").string();
  EXPECT_TRUE(says("relook render " + glb + " -o " + frame + " --look " + look +
                   " --camera 'Shot 1' --resolution 320x240 --lens 0.01:8"));
  const ProgramResult result = run_program({RELOOK_PROGRAM, "render", glb, "-o", frame, "--look", look, "--camera",
                                            "Shot 1", "--resolution", "16x12", "--samples", "1", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(Blender, lumens_multiply_all_light_by_683) {
  const ProgramResult result = export_->with({"lumens.glb", "--units", "lumens"});
  ASSERT_TRUE(fs::exists(export_->folder / "lumens.look.json")) << result.output;
  const Json patch = json_of(export_->folder / "lumens.look.json");
  expect_near(value_at(patch, "/lights/Square")["intensity"], 683 * 6.25);
  expect_near(value_at(patch, "/lights/Warm/intensity"), 683 * 7);
  expect_near(value_at(patch, "/scene/extras/relook/environment")["intensity"], 683 * 2);
  expect_near(value_at(patch, "/scene/extras/relook/environment")["background"]["intensity"], 683);
  expect_near(value_at(patch, "/materials/Glow/extensions/KHR_materials_emissive_strength/emissiveStrength"), 683 * 5);
  for (const Json& light : json_of_glb(export_->folder / "lumens.glb")["extensions"]["KHR_lights_punctual"]["lights"])
    if (light["name"] == "Bulb") expect_near(light["intensity"], 6830);
}

TEST_F(Blender, wrong_words_are_one_line_and_exit_code_1) {
  const std::string usage =
      "usage: blender -b SCENE.blend --python scenes/from_blender.py -- OUT.glb [--units watts|lumens]";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"x.glb", "--units", "suns"}, usage},
      {{"x.glb", "y.glb"}, usage},
      {{"x.obj"}, (export_->folder / "x.obj").string() + ": must end in .glb or .gltf"},
      {{"none/x.glb"}, (export_->folder / "none").string() + ": there is no such folder"}};
  for (const auto& [arguments, line] : cases) {
    const ProgramResult result = export_->with(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.output.find("from_blender.py: " + line + "\n"), std::string::npos) << result.output;
  }
}

bool has_python() { return run_program({"python3", "--version"}).exit_code == 0; }

TEST(FromBlender, runs_nowhere_but_inside_blender) {
  if (!has_python()) GTEST_SKIP() << "Python is not installed";
  const ProgramResult result = run_program({"python3", kScript, "x.glb"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output, "from_blender.py: runs inside Blender: blender -b SCENE.blend --python from_blender.py -- "
                           "OUT.glb\n");
}

TEST(FromBlender, links_of_lamps_become_nodes_that_they_exclude) {
  if (!has_python()) GTEST_SKIP() << "Python is not installed";
  const ProgramResult result = run_program(
      {"python3", (kSource / "tests/cli/blender_linking.py").string(), (kSource / "scenes").string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("[]\n['node B']\n['node A', 'node C']\n['node B', 'node C']\n['node A']\n"),
            std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("reaches \"node A\", as it reaches objects below it\n"), std::string::npos);
  EXPECT_TRUE(result.output.find("['node C']\n") != std::string::npos) << result.output;
}

}  // namespace
}  // namespace relook
