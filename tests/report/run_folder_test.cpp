// What is the user's stays the user's: a replay writes into a new folder, an empty one, or one that holds a part of the
// same run. Anything else is refused in one line; --overwrite replaces what is another run's and nothing else.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "run_folder.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

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

TEST_F(RunFolderTest, other_frames_are_refused_by_what_differs) {
  ASSERT_EQ(replay("run").exit_code, 0);
  expect_refused("run", {"half", "float"}, [&] { return replay("run", {"--float"}); });
  expect_refused("run", {"layers"}, [&] { return replay("run", {"--aovs"}); });
  fs::rename(at("c"), at("old"));
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "80x40", "--quiet"})
                .exit_code,
            0);
  expect_refused("run", {"72x40", "80x40"}, [&] { return replay("run"); });
  ASSERT_EQ(replay("run", {"--overwrite"}).exit_code, 0);
  ASSERT_EQ(replay("whole").exit_code, 0);
  expect_same_run("run", "whole");
  fs::remove_all(at("c"));
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "80x40", "--lights",
                    "auto", "--quiet"})
                .exit_code,
            0);
  expect_refused("run", {"another scene"}, [&] { return replay("run"); });
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
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "64x36", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(replay("run", {"--steps", "0-1", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(report("run")["frames"].size(), 2U);
  EXPECT_EQ(pictures("run").size(), 4U);
  ASSERT_EQ(replay("run").exit_code, 0);
  ASSERT_EQ(replay("whole").exit_code, 0);
  expect_same_run("run", "whole");
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
