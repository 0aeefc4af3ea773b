// What is the user's stays the user's: a replay writes into a new folder, an empty one, or one that holds a part of the
// same run. Parts add up, whatever the order, also at the same time; anything else is refused in one line.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/files.h"
#include "base/hash.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const std::string kScene = (fs::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();

Json color_step(const std::string& name, double red) {
  return {{"name", name},
          {"edit",
           {{{"op", "replace"},
             {"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor"},
             {"value", {red, 0.4, 0.1, 1}}}}}};
}
Json move(double x) {
  return Json::array({{{"op", "replace"}, {"path", "/nodes/CentralSphere/translation"}, {"value", {x, 1, 0}}}});
}

/// Colours, a drag, a wedge.
std::vector<Json> steps_of_journal() {
  return {color_step("one", 0.1),
          {{"name", "slide"}, {"select", {"/nodes/CentralSphere"}}, {"drag", {move(0.1), move(0.2), move(0.3)}}},
          color_step("three", 0.7),
          {{"name", "wedge"},
           {"wedge", {{"path", "/materials/Glass/extensions/KHR_materials_ior/ior"}, {"values", {1.2, 1.4, 1.6}}}}},
          color_step("five", 0.9)};
}

/// All files below a folder by their hashes.
std::map<std::string, std::string> hashes_below(const fs::path& folder) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      hashes[entry.path().lexically_relative(folder).string()] = hash128(read_file(entry.path()));
  return hashes;
}

/// From another working folder.
ProgramResult run_program_in(const std::string& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"sh", "-c", "cd \"$0\" && exec \"$@\"", folder, RELOOK_PROGRAM});
  return run_program(arguments);
}

class RunFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    write_journal("j.json", steps_of_journal());
    ASSERT_EQ(relook({"preprocess", kScene, "-o", at("c"), "--resolution", "72x40", "--quiet"}).exit_code, 0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  static ProgramResult relook(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    return run_program(arguments);
  }
  void write_journal(const std::string& name, const std::vector<Json>& steps) const {
    std::ofstream(at(name)) << Json{{"relook", "journal/1"}, {"steps", steps}}.dump();
  }
  void write_text(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(at(name)).parent_path());
    std::ofstream(at(name)) << text;
  }
  [[nodiscard]] ProgramResult replay(const std::string& run, const std::vector<std::string>& further = {},
                                     const std::string& journal = "j.json") const {
    std::vector<std::string> arguments{"replay", at("c"), at(journal), "-o", at(run), "--progress", "none"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return relook(arguments);
  }
  [[nodiscard]] Json report(const std::string& run) const {
    return parse_json(text_of(read_file(at(run + "/report.json"))), "report.json");
  }
  /// Frames and previews.
  [[nodiscard]] std::map<std::string, std::string> pictures(const std::string& run) const {
    std::map<std::string, std::string> all = hashes_below(at(run));
    std::erase_if(all, [](const auto& file) {
      return !file.first.starts_with("frames/") && !file.first.starts_with("previews/");
    });
    return all;
  }
  /// One line, exit code 1, that has all `parts`; and the files below `folder` are as they were.
  template <class Work>
  void expect_refused(const std::string& folder, const std::vector<std::string>& parts, const Work& work) const {
    const auto before = hashes_below(at(folder));
    const ProgramResult result = work();
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
    for (const std::string& part : parts)
      EXPECT_NE(result.output.find(part), std::string::npos) << part << " in " << result.output;
    EXPECT_EQ(hashes_below(at(folder)), before);
  }
  void expect_same_run(const std::string& run, const std::string& whole) const {
    EXPECT_EQ(pictures(run), pictures(whole));
    const Json now = report(run), then = report(whole);
    EXPECT_EQ(now["frames"], then["frames"]);
    ASSERT_EQ(now["steps"].size(), then["steps"].size());
    for (std::size_t i = 0; i < now["steps"].size(); ++i)
      for (const char* key :
           {"step", "name", "class", "frame", "frame_hash", "pixels_changed", "drag_frame", "wedge_frame", "edits"})
        EXPECT_EQ(now["steps"][i][key], then["steps"][i][key]) << i << " " << key;
    EXPECT_EQ(now["interrupted"], false);
    EXPECT_FALSE(fs::exists(at(run + "/progress.jsonl"))) << "gone once the report has all";
  }
  ScratchFolder folder_{"run_folder"};
};

TEST_F(RunFolderTest, folders_with_names_of_ours_are_the_users) {
  for (const std::string name : {"frames/plate.exr", "frames/0001.exr", "previews/painting.png", "previews/0000.png",
                                 "pixels/script.js", "overlays/comp.nk", "report.json", "report.html", "progress.jsonl",
                                 "frames", "notes.txt", "MANIFEST.json", ".hidden"}) {
    SCOPED_TRACE(name);
    const std::string run = "mine_" + std::to_string(hash64(bytes_of(name)));
    write_text(run + "/" + name, "mine");
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{}, {"--fresh"}, {"--overwrite"}, {"--steps", "3-4"}})
      expect_refused(run, {run}, [&] { return replay(run, flags); });
  }
}

TEST_F(RunFolderTest, files_of_the_system_are_neither_refused_nor_removed) {
  write_text("run/.DS_Store", "finder");
  write_text("run/frames/Thumbs.db", "explorer");
  fs::remove_all(at("run/frames"));
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_TRUE(fs::exists(at("run/.DS_Store")));
}

TEST_F(RunFolderTest, foreign_files_beside_a_run_stay) {
  ASSERT_EQ(replay("whole").exit_code, 0);
  ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
  write_text("run/notes.txt", "which one?");
  write_text("run/frames/comp.nk", "script");
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_TRUE(fs::exists(at("run/notes.txt")) && fs::exists(at("run/frames/comp.nk")));
  expect_refused("run", {"comp.nk", "not relook's"}, [&] { return replay("run", {"--float", "--overwrite"}); });
  fs::remove(at("run/frames/comp.nk"));
  expect_refused("run", {"notes.txt", "not relook's"}, [&] { return replay("run", {"--float", "--overwrite"}); });
}

TEST_F(RunFolderTest, a_foreign_file_where_a_frame_is_to_go_is_refused) {
  for (const std::string name : {"frames/0004_02.exr", "previews/0005.png"}) {
    SCOPED_TRACE(name);
    fs::remove_all(at("run"));
    ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
    write_text("run/" + name, "painted by hand");
    for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--fresh"}, {"--overwrite"}})
      expect_refused("run", {name}, [&] { return replay("run", flags); });
  }
}

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

TEST_F(RunFolderTest, another_journal_is_refused_by_name_and_overwrite_keeps_what_is_the_same) {
  ASSERT_EQ(replay("run").exit_code, 0);
  std::vector<Json> steps = steps_of_journal();
  std::swap(steps[2], steps[4]);  // three and five change places
  write_journal("other.json", steps);
  expect_refused("run", {"another journal", "step 3", "three"}, [&] { return replay("run", {}, "other.json"); });
  steps.pop_back();
  write_journal("shorter.json", steps);
  expect_refused("run", {"another journal"}, [&] { return replay("run", {}, "shorter.json"); });
  for (const std::string journal : {"other.json", "shorter.json", "j.json"}) {
    const ProgramResult result = replay("run", {"--overwrite"}, journal);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    fs::remove_all(at("whole"));
    ASSERT_EQ(replay("whole", {}, journal).exit_code, 0);
    EXPECT_EQ(report("run")["steps"][1]["resumed"], true) << "the first step is in all of them";
    expect_same_run("run", "whole");
  }
}

TEST_F(RunFolderTest, a_step_with_another_name_is_the_same_step) {
  ASSERT_EQ(replay("run").exit_code, 0);
  std::vector<Json> steps = steps_of_journal();
  steps[0]["name"] = "uno";
  steps.push_back(color_step("six", 0.3));
  write_journal("renamed.json", steps);
  ASSERT_EQ(replay("run", {}, "renamed.json").exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 10);
  EXPECT_EQ(report("run")["steps"][1]["name"], "uno");
}

TEST_F(RunFolderTest, other_frames_are_refused_by_what_differs) {
  ASSERT_EQ(replay("run").exit_code, 0);
  expect_refused("run", {"half", "float"}, [&] { return replay("run", {"--float"}); });
  expect_refused("run", {"layers"}, [&] { return replay("run", {"--aovs"}); });
  fs::rename(at("c"), at("old"));
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("c"), "--resolution", "80x40", "--quiet"}).exit_code, 0);
  expect_refused("run", {"72x40", "80x40"}, [&] { return replay("run"); });
  ASSERT_EQ(replay("run", {"--overwrite"}).exit_code, 0);
  ASSERT_EQ(replay("whole").exit_code, 0);
  expect_same_run("run", "whole");
  fs::remove_all(at("c"));
  ASSERT_EQ(
      relook({"preprocess", kScene, "-o", at("c"), "--resolution", "80x40", "--lights", "auto", "--quiet"}).exit_code,
      0);
  expect_refused("run", {"another scene"}, [&] { return replay("run"); });
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

TEST_F(RunFolderTest, a_painting_where_an_overlay_is_to_go_is_refused) {
  ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
  write_text("run/overlays/0003_groups.png", "painting");
  expect_refused("run", {"0003_groups.png"}, [&] { return replay("run", {"--overlays"}); });
}

TEST_F(RunFolderTest, a_command_at_other_steps_of_another_journal_is_seen_before_it_has_a_frame) {
  ASSERT_EQ(replay("run", {"--steps", "0-1"}).exit_code, 0);
  std::vector<Json> steps = steps_of_journal();
  steps[2] = color_step("another", 0.6);
  write_journal("other.json", steps);
  // As a command leaves it that has been killed as it began.
  const ProgramResult killed =
      run_program({"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM, "RELOOK_FAULT=4:kill", RELOOK_PROGRAM,
                   "replay", at("c"), at("other.json"), "-o", at("run"), "--steps", "4-5"});
  ASSERT_EQ(killed.exit_code, 128 + 9) << killed.output;
  ASSERT_TRUE(fs::exists(at("run/progress.jsonl")));
  ASSERT_GT(fs::file_size(at("run/progress.jsonl")), 0U);
  expect_refused("run", {"another journal", "4 to 5"}, [&] { return replay("run"); });
  EXPECT_EQ(replay("run", {"--steps", "4-5"}, "other.json").exit_code, 0) << "its own goes on";
}

TEST_F(RunFolderTest, nothing_of_a_replaced_run_comes_back) {
  ASSERT_EQ(replay("run", {"--report", "none"}).exit_code, 0);
  fs::remove_all(at("c"));
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("c"), "--resolution", "64x36", "--quiet"}).exit_code, 0);
  ASSERT_EQ(replay("run", {"--steps", "0-1", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(report("run")["frames"].size(), 2U);
  EXPECT_EQ(pictures("run").size(), 4U);
  ASSERT_EQ(replay("run").exit_code, 0);
  ASSERT_EQ(replay("whole").exit_code, 0);
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

TEST_F(RunFolderTest, a_part_that_replaces_replaces_all_that_is_another_and_nothing_else) {
  ASSERT_EQ(replay("run").exit_code, 0);
  std::vector<Json> steps = steps_of_journal();
  steps[1] = color_step("another", 0.6);
  write_journal("other.json", steps);
  fs::copy_file(at("run/frames/0001.exr"), at("run/frames/9_mine.exr"));
  ASSERT_EQ(replay("run", {"--steps", "2-2", "--overwrite"}, "other.json").exit_code, 0);
  EXPECT_EQ(report("run")["frames"].size(), 3U);
  EXPECT_TRUE(fs::exists(at("run/frames/9_mine.exr"))) << "no name of a run's frame";
  EXPECT_FALSE(fs::exists(at("run/frames/0003.exr")) || fs::exists(at("run/frames/0002_01.exr")));
  EXPECT_EQ(report("run")["interrupted"], false);
}

TEST_F(RunFolderTest, a_link_in_place_of_a_part_stays) {
  ASSERT_EQ(replay("run").exit_code, 0);
  fs::rename(at("run/frames"), at("elsewhere"));
  write_text("elsewhere/.DS_Store", "finder");
  fs::copy(at("elsewhere/0005.exr"), at("elsewhere/0009.exr"));  // of a run that has more steps
  fs::create_directory_symlink(at("elsewhere"), at("run/frames"));
  ASSERT_EQ(replay("run", {"--float", "--overwrite"}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(at("run/frames")));
  EXPECT_TRUE(fs::exists(at("elsewhere/0009.exr"))) << "nothing beyond the link is removed";
  EXPECT_TRUE(fs::exists(at("elsewhere/0005.exr")) && fs::exists(at("elsewhere/.DS_Store")));
}

TEST_F(RunFolderTest, a_report_that_was_laid_out_anew_is_refused_and_replaced_on_demand) {
  ASSERT_EQ(replay("run", {"--steps", "0-2"}).exit_code, 0);
  ASSERT_EQ(replay("run", {"--steps", "3", "--report", "none"}).exit_code, 0);
  const std::string text = report("run").dump(1);
  std::ofstream(at("run/report.json")) << text;
  expect_refused("run", {"report.json"}, [&] { return replay("run"); });
  ASSERT_EQ(replay("run", {"--overwrite"}).exit_code, 0);
  ASSERT_EQ(replay("whole").exit_code, 0);
  expect_same_run("run", "whole");
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
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("c"), "--resolution", "16x9", "--quiet"}).exit_code, 0);
  ASSERT_EQ(replay("run", {"--quiet"}, "long.json").exit_code, 0);
  const Json entries = report("run")["steps"];
  ASSERT_EQ(entries.size(), 1501U);
  EXPECT_LE(entries.back()["peak_rss"].get<double>(), 1.05 * entries[100]["peak_rss"].get<double>());
  EXPECT_LT(fs::file_size(at("run/report.html")), 5'000'000U);
}

TEST_F(RunFolderTest, a_run_is_found_again_wherever_it_is) {
  fs::create_directory(at("work"));
  for (const char* name : {"c", "j.json"}) fs::rename(at(name), at(std::string("work/") + name));
  ASSERT_EQ(relook({"replay", at("work/c"), at("work/j.json"), "-o", at("work/run"), "--quiet"}).exit_code, 0);
  const auto blame = [&](const std::string& run, std::vector<std::string> further = {}) {
    further.insert(further.begin(), {"blame", at(run), "30,20", "--quiet"});
    return run_program_in("/", further);
  };
  EXPECT_EQ(blame("work/run").exit_code, 0);
  fs::rename(at("work"), at("moved"));
  EXPECT_EQ(blame("moved/run").exit_code, 0) << "all of it together";
  fs::rename(at("moved/run"), at("alone"));
  const ProgramResult lost = blame("alone");
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.output.find("say --cache"), std::string::npos) << lost.output;
  EXPECT_EQ(blame("alone", {"--cache", at("moved/c"), "--journal", at("moved/j.json")}).exit_code, 0);
}

TEST_F(RunFolderTest, paths_that_are_not_utf8_cost_no_report) {
  const std::string run = "r\xFFun", cache = "c\xFE";
  fs::rename(at("c"), at(cache));
  ASSERT_EQ(relook({"replay", at(cache), at("j.json"), "-o", at(run), "--json", "--progress", "none"}).exit_code, 0);
  EXPECT_EQ(report(run)["frames"].size(), 10U);
  EXPECT_EQ(relook({"blame", at(run), "3,3", "--quiet"}).exit_code, 0);
}

TEST_F(RunFolderTest, a_run_below_a_cache_is_refused) {
  for (const std::string name : {"c/run", "c/trees/run", "c/../c/run"})
    expect_refused("c", {"lies inside the cache"}, [&] { return replay(name); });
  expect_refused("c", {"an input is never replaced"}, [&] { return replay("c"); });
  fs::create_directory_symlink(at("c"), at("link"));
  expect_refused("c", {"cache"}, [&] { return replay("link/run"); });
}

}  // namespace
}  // namespace relook
