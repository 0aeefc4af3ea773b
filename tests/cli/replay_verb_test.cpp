// The verb replay: the files of a run, and frames that are the same bytes whatever structures, budgets and threads.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli_fixture.h"
#include "compare/compare.h"
#include "synthetic_run.h"

namespace relook {
namespace {

TEST_F(Cli, a_cache_with_fewer_ray_trees_gives_the_same_frames) {
  write_text(at("j.json"), kJournal);
  // Several groups of tiles: 131,072 samples each.
  const auto replayed = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all{"preprocess",   kScene,    "--integrator", "whitted", "-o",      at("c"),
                                 "--resolution", "200x120", "--samples",    "16",      "--quiet", "--overwrite"};
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
  expect_error(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("d"), "--resolution", "200x120",
                       "--disk", "9K", "--quiet"}),
               4, "--disk: this cache needs at least");
  EXPECT_FALSE(std::filesystem::exists(at("d")));
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
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("counted"), "--resolution", "72x40",
                    "--quiet", "--shadow-bits", "2"})
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

/// Every pixel of one tile differs.
Frame with_another_tile(const Frame& frame, std::size_t tile) {
  Frame other = frame;
  const TileRect rect = tile_rect(tile, frame.width, frame.height);
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y)
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x) other.pixels[std::size_t{y} * frame.width + x].r = 1;
  return other;
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
    ASSERT_EQ(relook({"render", kScene, "--integrator", "whitted", "-o", at("full.exr"), "--journal", at("j.json"),
                      "--step", step, "--float", "--resolution", "72x40", "--quiet"})
                  .exit_code,
              0);
    EXPECT_TRUE(read_file(at("full.exr")) == read_file(at("run/frames/" + std::string(frame) + ".exr")))
        << "step " << step;
    const ProgramResult compared = relook({"compare", at("run/frames/" + std::string(frame) + ".exr"), at("full.exr")});
    EXPECT_EQ(compared.exit_code, 0) << compared.output;
  }
}

}  // namespace
}  // namespace relook
