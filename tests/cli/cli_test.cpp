// The program as scripts see it: exit codes, one-line messages, files, JSON on stdout.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/json.h"
#include "compare/compare.h"
#include "run_program.h"

namespace relook {
namespace {

const std::string kScene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();

ProgramResult relook(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), RELOOK_PROGRAM);
  return run_program(arguments);
}

void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

Json read_json(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  return parse_json(text_of(bytes), path.string());
}

/// Exactly one line, which starts with "relook: " and contains `part`.
void expect_error(const ProgramResult& result, int exit_code, const std::string& part) {
  EXPECT_EQ(result.exit_code, exit_code) << result.output;
  EXPECT_TRUE(result.output.starts_with("relook: ")) << result.output;
  EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

const char* const kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "slide", "select": ["/nodes/CentralSphere"], "drag": [
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.1, 1, 0]}],
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.2, 1, 0]}]]}]})";

class Cli : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  ProgramResult preprocess(const std::string& output) const {
    return relook({"preprocess", kScene, "-o", at(output), "--resolution", "72x40", "--quiet"});
  }
  ScratchFolder folder_{"cli"};
};

std::uint64_t folder_bytes(const std::filesystem::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

TEST_F(Cli, a_cache_with_fewer_ray_trees_gives_the_same_frames) {
  write_text(at("j.json"), kJournal);
  // Several groups of tiles: 131,072 samples each.
  const auto replayed = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"preprocess", kScene,      "-o", at("c"),   "--resolution",
                                 "200x120",    "--samples", "16", "--quiet", "--overwrite"};
    all.insert(all.end(), options.begin(), options.end());
    EXPECT_EQ(relook(all).exit_code, 0);
    EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet", "--fresh"}).exit_code, 0);
    return read_json(at("run") + "/report.json");
  };
  const Json whole = replayed({});
  const std::uint64_t most = folder_bytes(at("c"));
  EXPECT_EQ(whole["steps"][2]["rebuilt"]["ray_trees"], 0);
  const Json none = replayed({"--ray-trees", "0"});
  const std::uint64_t least = folder_bytes(at("c"));
  EXPECT_LT(least, most);
  EXPECT_EQ(none["frames"], whole["frames"]);
  EXPECT_GT(none["steps"][1]["rebuilt"]["ray_trees"], 0);
  const std::uint64_t half = (least + most) / 2;
  const Json some = replayed({"--disk", std::to_string((half >> 10) + 8) + "K"});
  EXPECT_LE(folder_bytes(at("c")), half + (8 << 10));
  EXPECT_GT(folder_bytes(at("c")), least);
  EXPECT_EQ(some["frames"], whole["frames"]);
  expect_error(relook({"preprocess", kScene, "-o", at("d"), "--resolution", "200x120", "--disk", "9K", "--quiet"}), 4,
               "--disk: this cache needs at least");
  EXPECT_FALSE(std::filesystem::exists(at("d")));
}

TEST_F(Cli, usage_errors_are_one_line_and_exit_1) {
  expect_error(relook({}), 1, "a verb is required");
  expect_error(relook({"pln"}), 1, "no verb \"pln\"");
  expect_error(relook({"rendr", kScene}), 1, "did you mean \"render\"?");
  expect_error(relook({"render"}), 1, "SCENE");
  expect_error(relook({"render", kScene}), 1, "--output");
  expect_error(relook({"replay", at("c"), "-o", at("r")}), 1, "JOURNAL");
  const auto render_with = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"render", kScene, "-o", at("x.exr")});
    return relook(flags);
  };
  expect_error(render_with({"--resolution", "12"}), 1, "--resolution: \"12\"");
  expect_error(render_with({"--resolution", "0x5"}), 1, "--resolution: \"0x5\"");
  expect_error(render_with({"--resolution", "16385x5"}), 1, "--resolution");
  expect_error(render_with({"--samples", "0"}), 1, "--samples");
  expect_error(render_with({"--samples", "257"}), 1, "--samples");
  expect_error(render_with({"--max-depth", "17"}), 1, "--max-depth");
  expect_error(render_with({"--threads", "1025"}), 1, "--threads");
  expect_error(render_with({"--threads", "-1"}), 1, "--threads");
  expect_error(render_with({"--lights", "manual"}), 1, "--lights");
  expect_error(render_with({"--progress", "fancy"}), 1, "--progress");
  expect_error(render_with({"--bogus"}), 1, "--bogus");
  expect_error(render_with({"--step", "2"}), 1, "--journal");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--memory", "2X"}), 1, "--memory: \"2X\"");
  expect_error(relook({"preprocess", kScene, "-o", at("c"), "--ray-trees", "101"}), 1, "--ray-trees");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--verify=0"}), 1, "--verify");
  EXPECT_FALSE(std::filesystem::exists(at("x.exr")));
}

TEST_F(Cli, help_and_version_go_to_stdout_and_exit_0) {
  EXPECT_EQ(relook({"--help"}).exit_code, 0);
  EXPECT_EQ(relook({"replay", "--help"}).exit_code, 0);
  EXPECT_TRUE(relook({"--version"}).output.starts_with("relook 0.1.0\narithmetic "));
}

TEST_F(Cli, bad_inputs_exit_2) {
  expect_error(relook({"render", at("none.gltf"), "-o", at("x.exr")}), 2, "none.gltf: ");
  expect_error(relook({"render", kScene, "-o", at("x.exr"), "--camera", "Nope"}), 2, "no camera \"Nope\"");
  write_text(at("bad.json"), R"({"relook": "journal/1", "steps": [{"name": "x", "edit": [], "drags": []}]})");
  ASSERT_EQ(preprocess("c").exit_code, 0);
  expect_error(relook({"replay", at("c"), at("bad.json"), "-o", at("run")}), 2, "/steps/0");
  EXPECT_FALSE(std::filesystem::exists(at("run"))) << "a rejected journal writes nothing";
  expect_error(relook({"compare", at("c"), kScene}), 2, "not a run");
  expect_error(relook({"inspect", at("nothing.glb")}), 2, "no such file");
}

TEST_F(Cli, a_scene_without_camera_or_light_names_the_flag) {
  const std::string geometry = R"("nodes":[{"name":"N"}],"scenes":[{"nodes":[0]}])";
  write_text(at("bare.gltf"), R"({"asset":{"version":"2.0"},)" + geometry + "}");
  expect_error(relook({"render", at("bare.gltf"), "-o", at("x.exr")}), 2, "--camera auto");
  expect_error(relook({"render", at("bare.gltf"), "-o", at("x.exr"), "--camera", "0,0,5:0,0,0:40"}), 2,
               "--lights auto");
}

TEST_F(Cli, replay_writes_frames_previews_and_a_report) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  const ProgramResult result =
      relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--verify", "--json", "--progress", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json summary = parse_json(result.output, "stdout");
  EXPECT_EQ(summary["pixels_different"], 0);
  for (const char* name : {"0000", "0001", "0002_01", "0002_02"}) {
    EXPECT_TRUE(std::filesystem::exists(at("run/frames/" + std::string(name) + ".exr"))) << name;
    EXPECT_TRUE(std::filesystem::exists(at("run/previews/" + std::string(name) + ".png"))) << name;
  }
  const Json report = read_json(at("run/report.json"));
  ASSERT_EQ(report["steps"].size(), 5U);
  EXPECT_EQ(report["steps"][1]["class"], "color");
  EXPECT_EQ(report["steps"][1]["ray_updates"], 0);
  EXPECT_EQ(report["steps"][3]["drag_frame"], 2);
  EXPECT_FALSE(std::filesystem::exists(at("run/frames/0002.exr"))) << "the last frame of a drag is not written twice";
  EXPECT_EQ(report["steps"][4]["class"], "geometric");
  EXPECT_EQ(report["steps"][4]["frame"], "frames/0002_02.exr");
  EXPECT_EQ(report["steps"][4]["verify"]["pixels_compared"], 72 * 40);
  EXPECT_GT(report["full_render_seconds"], 0);
  EXPECT_EQ(report["interrupted"], false);
}

TEST_F(Cli, a_wedge_gives_a_frame_for_each_value_and_keeps_the_last) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("w.json"), R"({"relook": "journal/1", "steps": [
    {"wedge": {"path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor/0",
               "range": {"from": 0.1, "to": 0.9, "count": 3}}},
    {"wedge": {"path": "/materials/Glass/extensions/KHR_materials_ior/ior", "values": [1.2, 1.7]}}]})");
  ASSERT_EQ(relook({"replay", at("c"), at("w.json"), "-o", at("run"), "--verify", "--quiet"}).exit_code, 0);
  const Json steps = read_json(at("run/report.json"))["steps"];
  ASSERT_EQ(steps.size(), 8U);
  for (const char* name : {"0000", "0001_01", "0001_03", "0002_01", "0002_02"})
    EXPECT_TRUE(std::filesystem::exists(at("run/frames/" + std::string(name) + ".exr"))) << name;
  EXPECT_EQ(steps[2]["wedge_frame"], 2);
  EXPECT_EQ(steps[2]["class"], "color");
  EXPECT_GT(steps[2]["pixels_changed"], 0);
  EXPECT_TRUE(steps[4]["wedge_frame"].is_null());
  EXPECT_EQ(steps[4]["pixels_changed"], 0);
  EXPECT_EQ(steps[7]["class"], "optical");
  write_text(at("bad.json"), R"({"relook": "journal/1", "steps": [
    {"wedge": {"path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor/0", "values": [0.1, "red"]}}]})");
  expect_error(relook({"replay", at("c"), at("bad.json"), "-o", at("bad")}), 2, "/steps/0/wedge/values/1");
}

TEST_F(Cli, frames_are_the_same_bytes_in_every_run_and_for_any_thread_count) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("one"), "--quiet", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("two"), "--quiet", "--threads", "2"}).exit_code, 0);
  EXPECT_EQ(read_json(at("one/report.json"))["frames"], read_json(at("two/report.json"))["frames"]);
  EXPECT_EQ(relook({"compare", at("one"), at("two"), "--quiet"}).exit_code, 0);
}

TEST_F(Cli, several_journals_get_a_folder_each_and_start_from_the_cache) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("first.json"), kJournal);
  write_text(at("second.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("first.json"), at("second.json"), "-o", at("runs"), "--quiet"}).exit_code, 0);
  const Json first = read_json(at("runs/first/report.json")), second = read_json(at("runs/second/report.json"));
  EXPECT_EQ(first["frames"], second["frames"]);
  expect_error(relook({"replay", at("c"), at("first.json"), at("first.json"), "-o", at("twice")}), 1, "\"first\"");
}

TEST_F(Cli, compare_finds_differences_and_exits_10) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  const ProgramResult result = relook(
      {"compare", at("run/frames/0000.exr"), at("run/frames/0001.exr"), "-o", at("difference"), "--progress", "none"});
  EXPECT_EQ(result.exit_code, 10);
  EXPECT_GT(read_json(at("difference/compare.json"))["total"]["pixels_different"], 0);
  std::filesystem::copy(at("run"), at("copy"), std::filesystem::copy_options::recursive);
  std::filesystem::remove(at("copy/frames/0002_02.exr"));
  EXPECT_EQ(relook({"compare", at("run"), at("copy"), "--quiet"}).exit_code, 10);
}

TEST_F(Cli, inspect_knows_scene_cache_journal_and_run) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(parse_json(relook({"inspect", kScene, "--json"}).output, "")["lights"], 1);
  EXPECT_EQ(parse_json(relook({"inspect", at("c"), "--json"}).output, "")["relook"], "cache/5");
  EXPECT_EQ(parse_json(relook({"inspect", at("run"), "--json"}).output, "")["relook"], "report/1");
  const Json steps = parse_json(relook({"inspect", at("j.json"), "--scene", kScene, "--json"}).output, "")["steps"];
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0]["class"], "color");
  EXPECT_EQ(steps[2]["class"], "geometric");
  EXPECT_FALSE(steps[0]["reasons"].empty());
  EXPECT_TRUE(parse_json(relook({"inspect", kScene, "--look"}).output, "").contains("materials"));
  EXPECT_TRUE(parse_json(relook({"inspect", at("c"), "--look"}).output, "").contains("materials"));
}

TEST_F(Cli, structure_options_are_recorded_and_change_no_frame) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("plain"), "--quiet"}).exit_code, 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("tight"), "--quiet", "--memory", "1.5G", "--ray-trees",
                    "10%", "--tunnels", "0", "--groups", "0", "--shadow-bits", "0", "--atoms", "1"})
                .exit_code,
            0);
  const Json plain = read_json(at("plain/report.json")), tight = read_json(at("tight/report.json"));
  EXPECT_EQ(plain["frames"], tight["frames"]);
  EXPECT_EQ(tight["options"]["memory"], 1610612736);
  EXPECT_EQ(tight["options"]["ray_trees"], 10);
  EXPECT_EQ(tight["options"]["groups"], 0);
}

TEST_F(Cli, colour_trees_of_chosen_parameters_change_no_frame) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  const auto replay = [&](const std::string& run, const std::vector<std::string>& params) {
    std::vector<std::string> words{"replay", at("c"), at("j.json"), "-o", at(run), "--quiet"};
    words.insert(words.end(), params.begin(), params.end());
    return relook(words);
  };
  ASSERT_EQ(replay("plain", {}).exit_code, 0);
  ASSERT_EQ(replay("chosen", {"--params", "/materials/Paint", "/lights"}).exit_code, 0);
  const Json plain = read_json(at("plain/report.json")), chosen = read_json(at("chosen/report.json"));
  EXPECT_EQ(plain["frames"], chosen["frames"]);
  EXPECT_EQ(chosen["options"]["params"], (Json{"/materials/Paint", "/lights"}));
  EXPECT_EQ(chosen["steps"][1]["regions"]["groups"]["visited"], 0) << "there before the first edit";
  for (const char* pointer : {"/materials/Pant", "/nodes/Pane", "lights"}) {
    expect_error(replay("wrong", {"--params", pointer}), 2, std::string("--params: ") + pointer);
    EXPECT_FALSE(std::filesystem::exists(at("wrong")));
  }
}

TEST_F(Cli, shadow_bits_are_fixed_by_preprocess) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  ASSERT_EQ(
      relook({"preprocess", kScene, "-o", at("counted"), "--resolution", "72x40", "--quiet", "--shadow-bits", "2"})
          .exit_code,
      0);
  write_text(at("j.json"), kJournal);
  const auto replay = [&](const std::string& cache, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"replay", at(cache), at("j.json"), "-o", at("run-" + cache), "--quiet"});
    return relook(flags);
  };
  EXPECT_EQ(replay("c", {}).exit_code, 0);
  EXPECT_EQ(replay("counted", {"--shadow-bits", "2", "--verify"}).exit_code, 0);
  EXPECT_EQ(replay("counted", {}).exit_code, 0);
  const Json plain = read_json(at("run-c/report.json")), counted = read_json(at("run-counted/report.json"));
  EXPECT_EQ(plain["frames"], counted["frames"]);
  EXPECT_EQ(counted["options"]["shadow_bits"], 2);
  expect_error(replay("counted", {"--shadow-bits", "0"}), 3,
               "the cache holds shadow counters of 2 bits; preprocess again with --shadow-bits");
  expect_error(replay("c", {"--shadow-bits", "1"}), 3, "the cache holds shadow counters of 0 bits");
  expect_error(replay("c", {"--shadow-bits", "5"}), 1, "--shadow-bits");
  EXPECT_EQ(relook({"check", at("counted"), "--quiet"}).exit_code, 0);
}

TEST_F(Cli, a_cache_that_does_not_fit_is_refused_with_its_own_code_and_sentence) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  const auto replay = [&](std::vector<std::string> flags = {}) {
    flags.insert(flags.begin(), {"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"});
    return relook(flags);
  };
  EXPECT_EQ(replay({"--scene", kScene}).exit_code, 0);
  expect_error(replay({"--scene", kScene, "--lights", "auto"}), 3, "another scene");
  expect_error(relook({"replay", at("none"), at("j.json"), "-o", at("run")}), 2, "there is no cache here");
  const std::filesystem::path look = at("c/look.json");
  const auto size = std::filesystem::file_size(look);
  std::filesystem::resize_file(look, size - 1);
  expect_error(replay(), 5, "cut short");
  expect_error(relook({"check", at("c"), "--quiet"}), 5, "cut short");
  std::filesystem::resize_file(look, size);
  expect_error(replay(), 5, "damaged");
}

TEST_F(Cli, overlays_are_written_on_request) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("plain"), "--quiet"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(at("plain/overlays")));
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("r"), "--overlays", "--quiet"}).exit_code, 0);
  for (const char* name :
       {"0000_groups", "0001_dependent", "0001_touched", "0001_groups", "0002_01_touched", "0002_02_touched"})
    EXPECT_TRUE(std::filesystem::exists(at("r/overlays/") + name + ".png")) << name;
}

TEST_F(Cli, preprocess_writes_to_a_bare_name_in_the_working_folder) {
  const ProgramResult result =
      run_program({"sh", "-c", "cd \"$0\" && exec \"$1\" preprocess \"$2\" -o bare --quiet --resolution 8x8", at(""),
                   RELOOK_PROGRAM, kScene});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(relook({"check", at("bare"), "--quiet"}).exit_code, 0);
}

TEST_F(Cli, preprocess_finds_out_that_it_cannot_write_before_it_renders) {
  write_text(at("file"), "x");
  expect_error(relook({"preprocess", kScene, "-o", at("file/c"), "--resolution", "8x8", "--progress", "plain"}), 6,
               at("file"));
}

TEST_F(Cli, inspect_shows_and_counts_the_lights_of_lights_auto) {
  const auto inspect = [](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"inspect", kScene});
    return parse_json(relook(flags).output, "stdout");
  };
  const Json look = inspect({"--look", "--lights", "auto"});
  for (const char* light : {"key", "fill", "rim"}) EXPECT_TRUE(look["lights"].contains(light)) << light;
  EXPECT_EQ(inspect({"--lights", "auto", "--json"})["lights"], 4);
  EXPECT_EQ(inspect({"--json"})["lights"], 1);
  ASSERT_EQ(preprocess("c").exit_code, 0);
  expect_error(relook({"inspect", at("c"), "--look", "--lights", "auto"}), 1, "--lights");
}

TEST_F(Cli, replay_does_not_ignore_look_or_lights_without_scene) {
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--look", at("patch.json")}), 1, "--scene");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--lights", "auto"}), 1, "--scene");
}

/// Every pixel of one tile differs.
Frame with_another_tile(const Frame& frame, std::size_t tile) {
  Frame other = frame;
  const TileRect rect = tile_rect(tile, frame.width, frame.height);
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y)
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x) other.pixels[std::size_t{y} * frame.width + x].r = 1;
  return other;
}

TEST_F(Cli, budgets_change_no_frame_and_one_below_the_floor_is_refused) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(folder_ / "j.json", kJournal);
  const auto replay = [&](const std::string& run, std::vector<std::string> options) {
    options.insert(options.begin(), {"replay", at("c"), at("j.json"), "-o", at(run), "--quiet"});
    return relook(options);
  };
  ASSERT_EQ(replay("free", {"--access-log", at("log")}).exit_code, 0);
  const Json expected = read_json(folder_ / "free/report.json").at("frames");
  EXPECT_TRUE(text_of(read_file(folder_ / "log")).starts_with("relook-access/1\n1 "));
  const std::vector<std::vector<std::string>> budgets{{"--ray-trees", "0"},
                                                      {"--ray-trees", "10", "--color-trees", "1", "--tunnels", "2"},
                                                      {"--memory", "2G", "--policy", "gdsf"},
                                                      {"--memory", "2G", "--disk", "0"}};
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    const std::string run = "run" + std::to_string(i);
    ASSERT_EQ(replay(run, budgets[i]).exit_code, 0) << i;
    EXPECT_EQ(read_json(folder_ / run / "report.json").at("frames"), expected) << i;
  }
  expect_error(replay("small", {"--memory", "1M"}), 4, "--memory: this replay needs at least");
  expect_error(replay("odd", {"--policy", "best"}), 1, "--policy");
}

TEST(Verify, a_share_of_the_tiles_reaches_each_tile_in_some_step) {
  Frame frame;
  frame.width = frame.height = 256;
  frame.pixels.assign(256 * 256, Rgba(0, 0, 0, 1));
  for (std::size_t tile = 0; tile < tile_count(256, 256); ++tile) {
    int found = 0;
    for (std::size_t round = 0; round < 4; ++round) {
      const FrameDifference difference = compare_frames(frame, with_another_tile(frame, tile), 25, round);
      EXPECT_EQ(difference.pixels_compared, 4U * 64 * 64);
      found += difference.pixels_different > 0 ? 1 : 0;
    }
    EXPECT_EQ(found, 1) << "tile " << tile;
  }
}

TEST_F(Cli, verify_of_half_the_tiles_takes_the_other_half_in_the_next_step) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--verify=50", "--quiet"}).exit_code, 0);
  const Json steps = read_json(at("run/report.json"))["steps"];
  ASSERT_EQ(steps.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(steps[i]["verify"]["pixels_compared"], (i % 2 == 0 ? 64 : 72 - 64) * 40) << i;
  EXPECT_EQ(steps[4]["verify"], steps[3]["verify"]) << "the drag as a whole has the frame of its last entry";
}

TEST_F(Cli, a_rendered_step_is_byte_for_byte_the_replayed_frame_with_its_header) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--float", "--quiet"}).exit_code, 0);
  for (const auto& [step, frame] : {std::pair{"0", "0000"}, {"1", "0001"}, {"2", "0002_02"}}) {
    ASSERT_EQ(relook({"render", kScene, "-o", at("full.exr"), "--journal", at("j.json"), "--step", step, "--float",
                      "--resolution", "72x40", "--quiet"})
                  .exit_code,
              0);
    EXPECT_TRUE(read_file(at("full.exr")) == read_file(at("run/frames/" + std::string(frame) + ".exr")))
        << "step " << step;
    const ProgramResult compared = relook({"compare", at("run/frames/" + std::string(frame) + ".exr"), at("full.exr")});
    EXPECT_EQ(compared.exit_code, 0) << compared.output;
  }
}

TEST_F(Cli, one_of_several_cameras_is_chosen_with_a_warning) {
  const std::filesystem::path scene = at("two/spheres.gltf");
  std::filesystem::copy(std::filesystem::path(kScene).parent_path(), at("two"),
                        std::filesystem::copy_options::recursive);
  Json gltf = read_json(scene);
  gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
  gltf["nodes"].push_back({{"name", "Second"}, {"camera", 0}, {"translation", {0, 1, 9}}});
  write_text(scene, gltf.dump());
  const auto render = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"render", scene.string(), "-o", at("x.exr"), "--resolution", "8x8"});
    const ProgramResult result = relook(flags);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  };
  const std::string warned = render({"--json", "--progress", "none"});
  ASSERT_NE(warned.find('{'), std::string::npos) << warned;
  const std::string name = parse_json(warned.substr(warned.find('{')), "stdout")["camera"];
  EXPECT_TRUE(warned.starts_with("relook: warning: ")) << warned;
  const std::string line = warned.substr(0, warned.find('\n'));
  EXPECT_NE(line.find("\"" + name + "\""), std::string::npos) << line;
  EXPECT_NE(line.find("--camera"), std::string::npos) << line;
  EXPECT_EQ(render({"--quiet"}), "");
  EXPECT_EQ(render({"--camera", "Second", "--progress", "none"}).find("warning"), std::string::npos);
}

TEST_F(Cli, folders_of_the_user_are_not_overwritten) {
  std::filesystem::create_directory(at("mine"));
  write_text(at("mine/thesis.txt"), "x");
  expect_error(preprocess("mine"), 1, "holds thesis.txt, which relook did not write");
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  expect_error(relook({"replay", at("c"), at("j.json"), "-o", at("mine")}), 1, "thesis.txt");
  EXPECT_TRUE(std::filesystem::exists(at("mine/thesis.txt")));
}

}  // namespace
}  // namespace relook
