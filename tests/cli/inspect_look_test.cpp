// `relook inspect --paths` and `--cameras`, and `relook render --camera all`.
#include <gtest/gtest.h>

#include <map>

#include "cli_fixture.h"
#include "frame/frame_file.h"
#include "gltf_writer.h"

namespace relook {
namespace {

/// By pointer.
std::map<std::string, Json> paths_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"inspect"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.emplace_back("--json");
  std::map<std::string, Json> paths;
  const Json listed = parse_json(relook(command).output, "")["paths"];
  for (const Json& path : listed) paths[path["pointer"]] = path;
  return paths;
}

TEST_F(Cli, inspect_lists_paths_with_value_range_class_and_unit) {
  const auto paths = paths_of({kScene, "--paths"});
  const Json roughness = paths.at("/materials/Paint/pbrMetallicRoughness/roughnessFactor");
  EXPECT_EQ(roughness["minimum"], 0);
  EXPECT_EQ(roughness["maximum"], 1);
  EXPECT_EQ(roughness["class"], "color, optical across a bucket");
  const Json translation = paths.at("/nodes/Cube/translation");
  EXPECT_EQ(translation["class"], "geometric");
  EXPECT_EQ(translation["unit"], "m");
  EXPECT_EQ(paths.at("/nodes/Cube/extensions/KHR_node_visibility/visible")["value"], true);
  bool has_light = false;
  for (const auto& [pointer, path] : paths) {
    if (!pointer.starts_with("/lights/")) continue;
    if (!pointer.ends_with("/intensity")) continue;
    has_light = true;
    EXPECT_EQ(path["unit"], "cd");
    EXPECT_EQ(path["class"], "color");
  }
  EXPECT_TRUE(has_light);
  EXPECT_TRUE(paths_of({kScene, "--paths", "--integrator", "whitted"}).contains("/materials/Paint/alphaCutoff"));
}

TEST_F(Cli, inspect_filters_paths_by_a_part_or_a_pattern) {
  for (const auto& [pointer, path] : paths_of({kScene, "--paths", "ROUGHNESSfactor"}))
    EXPECT_NE(pointer.find("oughnessFactor"), std::string::npos);
  const auto glass = paths_of({kScene, "--paths", "/materials/*/ior"});
  ASSERT_FALSE(glass.empty());
  for (const auto& [pointer, path] : glass) EXPECT_TRUE(pointer.ends_with("/ior"));
  EXPECT_EQ(glass.begin()->second["class"], "optical") << "or it shows nothing";
  expect_error(relook({"inspect", kScene, "--paths", "nothing of the kind"}), 2, "no path matches");
  write_text(at("j.json"), kJournal);
  expect_error(relook({"inspect", at("j.json"), "--paths"}), 1, "neither a scene nor a cache");
  const ProgramResult line = relook({"inspect", kScene, "--paths", "Paint/alphaCutoff"});
  EXPECT_EQ(line.output, "/materials/Paint/alphaCutoff = 0.5   (0 or more; color)\n");
}

TEST_F(Cli, paths_of_a_cache_are_those_of_its_scene) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  EXPECT_EQ(paths_of({at("c"), "--paths", "Paint"}), paths_of({kScene, "--paths", "Paint", "--integrator", "whitted"}));
  expect_error(relook({"inspect", at("c"), "--paths", "--camera", "auto"}), 1, "is a cache");
  expect_error(relook({"render", at("c"), "-o", at("x.exr")}), 1, "is a cache");
}

/// A lit square seen by two cameras, of which one has no aspect.
SceneFile two_cameras() {
  SceneFile file = square();
  file.gltf["cameras"] = {
      {{"name", "Front"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.7853981633974483}, {"znear", 0.1}}}},
      {{"name", "Plan"},
       {"type", "orthographic"},
       {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}}};
  file.gltf["nodes"] = {{{"name", "Square"}, {"mesh", 0}},
                        {{"name", "A"}, {"camera", 0}, {"translation", {0, 0, 3}}},
                        {{"name", "B"}, {"camera", 1}, {"translation", {0.5, 0, 4}}}};
  file.gltf["scenes"] = {{{"nodes", {0, 1, 2}}}};
  return file;
}

TEST_F(Cli, inspect_lists_cameras) {
  write_text(at("two.glb"), two_cameras().glb());
  const std::string printed = relook({"inspect", at("two.glb"), "--cameras", "--json"}).output;
  const Json cameras = parse_json(printed.substr(printed.find('{')), "")["cameras"];  // after warnings
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0]["name"], "Front");
  EXPECT_EQ(cameras[0]["eye"], Json({0.0, 0.0, 3.0}));
  EXPECT_EQ(cameras[0]["direction"], Json({0.0, 0.0, -1.0}));
  EXPECT_NEAR(cameras[0]["vertical_degrees"].get<double>(), 45, 1e-6);
  EXPECT_TRUE(cameras[0]["aspect"].is_null());
  EXPECT_EQ(cameras[1]["orthographic"]["width"], 4.0);
  const ProgramResult lines = relook({"inspect", at("two.glb"), "--cameras"});
  EXPECT_NE(lines.output.find("camera Front: eye 0, 0, 3, looks along 0, 0, -1, 45 degrees high"), std::string::npos)
      << lines.output;
  expect_error(relook({"inspect", at("two.glb"), "--cameras", "--paths", "x"}), 1, "--paths");
}

TEST_F(Cli, a_sheet_of_all_cameras) {
  write_text(at("two.glb"), two_cameras().glb());
  const auto sheet = [&](const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"render", at("two.glb"), "-o", at(name), "--camera", "all", "--lights", "auto",
                               "--resolution", "64x36", "--samples", "1", "--json", "--progress", "none"});
    return relook(more);
  };
  const ProgramResult made = sheet("sheet.exr", {"--float"});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_TRUE(std::filesystem::exists(at("sheet.exr")));
  EXPECT_EQ(sheet("sheet.png").exit_code, 0);
  EXPECT_EQ(sheet("again.exr", {"--aovs"}).exit_code, 1);
  ASSERT_EQ(relook({"render", at("two.glb"), "-o", at("one.exr"), "--camera", "Front", "--lights", "auto",
                    "--resolution", "64x36", "--samples", "1", "--float", "--quiet"})
                .exit_code,
            0);
  // The picture of a camera is the frame that it gives alone, bit for bit, somewhere in the sheet.
  const Frame one = decode_exr(at("one.exr")), all = decode_exr(at("sheet.exr"));
  const auto stands_at = [&](std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t row = 0; row < one.height; ++row)
      for (std::uint32_t column = 0; column < one.width; ++column) {
        const Rgba& a = one.pixels[row * one.width + column];
        const Rgba& b = all.pixels[(y + row) * all.width + x + column];
        if (a.r != b.r || a.g != b.g || a.b != b.b) return false;
      }
    return true;
  };
  bool is_there = false;
  for (std::uint32_t y = 0; y + one.height <= all.height && !is_there; ++y)
    for (std::uint32_t x = 0; x + one.width <= all.width && !is_there; ++x) is_there = stands_at(x, y);
  EXPECT_TRUE(is_there);
}

}  // namespace
}  // namespace relook
