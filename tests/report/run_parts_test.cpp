// Parts of a run add up, whatever the order, also at the same time, and what is there is not done twice: no frame, no
// step that was appended, nothing after a command was ended.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "run_folder.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

TEST_F(RunFolderTest, parts_add_up_in_any_order) {
  ASSERT_EQ(replay("whole").exit_code, 0);
  for (const std::vector<std::string>& parts :
       {std::vector<std::string>{"0-2", "3-5"}, {"4-5", "0-1", "2-3"}, {"4", "0-5"}}) {
    fs::remove_all(at("run"));
    std::size_t frames = 0;
    for (const std::string& part : parts) {
      const ProgramResult result = replay("run", {"--steps", part, "--verify"});
      ASSERT_EQ(result.exit_code, 0) << result.output;
      EXPECT_GT(report("run")["frames"].size(), frames) << part;
      frames = report("run")["frames"].size();
    }
    expect_same_run("run", "whole");
  }
}

TEST_F(RunFolderTest, parts_at_the_same_time_add_up) {
  ASSERT_EQ(replay("whole").exit_code, 0);
  std::vector<pid_t> children;
  for (const char* part : {"0-1", "2", "3", "4", "5"}) {
    const pid_t child = fork();
    if (child == 0) _exit(replay("run", {"--steps", part, "--quiet", "--threads", "1"}).exit_code);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
  expect_same_run("run", "whole");
}

TEST_F(RunFolderTest, the_same_command_again_says_that_all_is_there) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const auto before = hashes_below(at("run"));
  const ProgramResult again = replay("run");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.output.find("complete"), std::string::npos) << again.output;
  EXPECT_EQ(std::ranges::count(again.output, '\n'), 1) << again.output;
  EXPECT_EQ(hashes_below(at("run")), before);
  EXPECT_EQ(replay("run", {"--steps", "2-3"}).exit_code, 0);
  EXPECT_EQ(hashes_below(at("run")), before) << "a part of it is there, too";
}

TEST_F(RunFolderTest, an_appended_step_costs_one_step) {
  std::vector<Json> steps = steps_of_journal();
  ASSERT_EQ(replay("run").exit_code, 0);
  steps.push_back(color_step("six", 0.2));
  write_journal("longer.json", steps);
  const ProgramResult result = replay("run", {}, "longer.json");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json now = report("run");
  EXPECT_EQ(now["resumed"]["frames"], 10);
  EXPECT_EQ(now["frames"].size(), 11U);
  EXPECT_EQ(now["steps"].back()["resumed"], false);
  EXPECT_NE(result.output.find("4_03 \"wedge\": kept"), std::string::npos) << result.output;
  ASSERT_EQ(replay("whole", {}, "longer.json").exit_code, 0);
  expect_same_run("run", "whole");
}

TEST_F(RunFolderTest, a_step_with_another_name_is_made_again_for_its_header) {
  ASSERT_EQ(replay("run").exit_code, 0);
  std::vector<Json> steps = steps_of_journal();
  steps[0]["name"] = "uno";
  steps.push_back(color_step("six", 0.3));
  write_journal("renamed.json", steps);
  ASSERT_EQ(replay("run", {}, "renamed.json").exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 9);
  EXPECT_EQ(report("run")["steps"][1]["name"], "uno");
}

TEST_F(RunFolderTest, structures_and_memory_make_no_other_run) {
  ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
  const ProgramResult result =
      replay("run", {"--tunnels", "0", "--groups", "0", "--threads", "1", "--memory", "2G", "--color-trees", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(report("run")["resumed"]["frames"], 5);
  ASSERT_EQ(replay("whole").exit_code, 0);
  expect_same_run("run", "whole");
}

TEST_F(RunFolderTest, frames_that_were_not_verified_are_done_again_with_verify) {
  ASSERT_EQ(replay("run").exit_code, 0);
  ASSERT_EQ(replay("run", {"--verify"}).exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 0);
  for (const Json& step : report("run")["steps"]) {
    EXPECT_EQ(step["verify"]["pixels_different"], 0);
  }
  EXPECT_NE(replay("run", {"--verify"}).output.find("complete"), std::string::npos);
  EXPECT_NE(replay("run", {"--verify=50"}).output.find("complete"), std::string::npos);
}

TEST_F(RunFolderTest, two_commands_at_the_same_steps_meet_the_lock) {
  write_journal("long.json", std::vector<Json>(3000, color_step("same", 0.5)));  // long enough for a busy machine
  const pid_t child = fork();
  if (child == 0) _exit(replay("run", {"--quiet"}, "long.json").exit_code);
  for (int i = 0; i < 500 && !fs::exists(at("run/frames/0002.exr")); ++i) usleep(10'000);
  const ProgramResult second = replay("run", {"--steps", "5-8"}, "long.json");
  EXPECT_EQ(second.exit_code, 75) << second.output;
  EXPECT_NE(second.output.find("another replay is at one of the steps 5 to 8 of this run"), std::string::npos)
      << second.output;
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(RunFolderTest, report_says_what_is_written_beside_frames) {
  ASSERT_EQ(replay("none", {"--report", "none"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(at("none/report.json")) || fs::exists(at("none/report.html")));
  EXPECT_NE(replay("none", {"--report", "none"}).output.find("complete"), std::string::npos);
  ASSERT_EQ(replay("none", {"--report", "json"}).exit_code, 0);
  EXPECT_EQ(report("none")["resumed"]["frames"], 10);
  EXPECT_FALSE(fs::exists(at("none/report.html")));
  ASSERT_EQ(replay("none").exit_code, 0);
  EXPECT_TRUE(fs::exists(at("none/report.html")));
  EXPECT_EQ(replay("odd", {"--report", "pdf"}).exit_code, 1);
}

TEST_F(RunFolderTest, numbered_frames_sort_as_a_glob_does_and_the_last_is_not_written_twice) {
  Json values = Json::array();
  for (int i = 0; i < 101; ++i) values.push_back(0.1 + 0.005 * i);
  write_journal(
      "w.json",
      {{{"wedge", {{"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor/0"}, {"values", values}}}}});
  ASSERT_EQ(replay("run", {}, "w.json").exit_code, 0);
  std::vector<std::string> names;
  for (const auto& [name, unused] : pictures("run"))
    if (name.starts_with("frames/")) names.push_back(name);
  EXPECT_EQ(names.size(), 102U);
  EXPECT_EQ(names[1], "frames/0001_001.exr");
  EXPECT_EQ(names.back(), "frames/0001_101.exr");
  const Json whole_step = report("run")["steps"].back();
  EXPECT_TRUE(whole_step["wedge_frame"].is_null());
  EXPECT_EQ(whole_step["frame"], "frames/0001_101.exr");
  EXPECT_EQ(whole_step["frame_hash"], report("run")["frames"]["frames/0001_101.exr"]);
}

TEST_F(RunFolderTest, a_hundredth_value_renames_the_frames_of_its_wedge) {
  const auto wedge = [&](const std::string& name, int count) {
    Json values = Json::array();
    for (int i = 0; i < count; ++i) values.push_back(0.1 + 0.005 * i);
    write_journal(
        name, {{{"wedge", {{"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor/0"}, {"values", values}}}}});
  };
  wedge("few.json", 98);
  wedge("more.json", 99);
  wedge("many.json", 100);
  ASSERT_EQ(replay("run", {}, "few.json").exit_code, 0);
  ASSERT_EQ(replay("run", {}, "more.json").exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 99) << "a further value costs one frame";
  ASSERT_EQ(replay("run", {}, "many.json").exit_code, 0);
  ASSERT_EQ(replay("whole", {}, "many.json").exit_code, 0);
  expect_same_run("run", "whole");
}

TEST_F(RunFolderTest, a_frame_that_is_gone_is_in_no_report) {
  ASSERT_EQ(replay("run").exit_code, 0);
  fs::remove(at("run/frames/0003.exr"));
  ASSERT_EQ(replay("run", {"--steps", "0-1", "--fresh"}).exit_code, 0);
  EXPECT_FALSE(report("run")["frames"].contains("frames/0003.exr"));
  EXPECT_EQ(report("run")["interrupted"], true) << "it was asked for";
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 9);
}

TEST_F(RunFolderTest, entries_that_make_no_sense_count_as_none) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const std::string whole(text_of(read_file(at("run/report.json"))));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"name\":\"three\"", "\"name\":5"},
           {"\"frame\":\"frames/0003.exr\"", "\"frame\":\"../../../x.exr\""},
           {"\"preview\":\"previews/0003.png\"", "\"preview\":\"../x.png\""},
           {"\"step\":3", "\"step\":1e300"},
           {"\"command\":\"", "\"commend\":\""},
           {"\"files\":{\"frames/0003.exr\"", "\"files\":{\"frames/\\u0000.exr\""}}) {
    std::string text = whole;
    const std::size_t line = text.find("\"frame\":\"frames/0003.exr\"");
    const std::size_t begin = text.rfind('\n', line);
    const std::size_t at_place = text.find(from, begin);
    ASSERT_NE(at_place, std::string::npos) << from;
    std::ofstream(at("run/report.json")) << text.replace(at_place, from.size(), to);
    const ProgramResult result = replay("run");
    EXPECT_EQ(result.exit_code, 0) << from << " " << result.output;
    EXPECT_EQ(report("run")["frames"].size(), 10U) << from;
    EXPECT_EQ(report("run")["frames"], parse_json(whole, "report.json")["frames"]);
  }
}

TEST_F(RunFolderTest, a_fresh_run_that_was_ended_goes_on) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const ProgramResult killed =
      run_program({"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM, "RELOOK_FAULT=60:kill", RELOOK_PROGRAM,
                   "replay", at("c"), at("j.json"), "-o", at("run"), "--fresh"});
  ASSERT_EQ(killed.exit_code, 128 + 9) << killed.output;
  ASSERT_EQ(replay("run", {"--fresh"}).exit_code, 0);
  EXPECT_GT(report("run")["resumed"]["frames"], 0);
  EXPECT_LT(report("run")["resumed"]["frames"], 10);
  ASSERT_EQ(replay("run", {"--fresh"}).exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 0) << "done: the next one begins anew";
}

TEST_F(RunFolderTest, a_page_older_than_the_report_is_made_anew) {
  ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
  ASSERT_EQ(replay("run", {"--steps", "3-5", "--report", "json"}).exit_code, 0);
  const std::string before(text_of(read_file(at("run/report.html"))));
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_NE(text_of(read_file(at("run/report.html"))), before);
}

TEST_F(RunFolderTest, a_wedge_as_a_whole_has_the_files_of_its_last_frame) {
  ASSERT_EQ(replay("run", {"--overlays", "--verify"}).exit_code, 0);
  fs::remove(at("run/frames/0004_02.exr"));
  ASSERT_EQ(replay("run", {"--overlays", "--verify"}).exit_code, 0);
  for (const Json& entry : report("run")["steps"])
    for (const auto& [name, stamp] : entry["files"].items())
      EXPECT_NE(name.find(fs::path(entry["frame"].get<std::string>()).stem().string()), std::string::npos)
          << entry["frame"] << " " << name;
}

TEST_F(RunFolderTest, notes_cut_in_their_first_line_are_still_ours) {
  ASSERT_EQ(replay("run", {"--report", "none"}).exit_code, 0);
  const std::string notes(text_of(read_file(at("run/progress.jsonl"))));
  for (const std::size_t bytes : std::vector<std::size_t>{0, 1, 20, 33, 40, 200}) {
    fs::remove_all(at("cut"));
    write_text("cut/progress.jsonl", notes.substr(0, bytes));
    EXPECT_EQ(replay("cut", {"--steps", "0-1"}).exit_code, 0) << bytes;
  }
}

TEST_F(RunFolderTest, memory_does_not_grow_with_steps) {
  std::vector<Json> steps;
  for (int i = 0; i < 1500; ++i) {
    const double t = i * 37 % 100 * 0.01;
    if (i % 2 == 0)
      steps.push_back(color_step("step " + std::to_string(i), t));
    else
      steps.push_back({{"name", "move " + std::to_string(i)}, {"edit", move(0.3 * t)}});
  }
  write_journal("long.json", steps);
  fs::remove_all(at("c"));
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("c"), "--integrator", "whitted", "--resolution", "16x9", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(replay("run", {"--quiet"}, "long.json").exit_code, 0);
  const Json entries = report("run")["steps"];
  ASSERT_EQ(entries.size(), 1501U);
  EXPECT_LE(entries.back()["peak_rss"].get<double>(), 1.05 * entries[100]["peak_rss"].get<double>());
  EXPECT_LT(fs::file_size(at("run/report.html")), 5'000'000U);
}

}  // namespace
}  // namespace relook
