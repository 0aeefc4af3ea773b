// A cache of a small scene with a journal of colours, a drag and a wedge, and replays of it as a user calls them: for
// tests of what a run's folder holds before and after.
#pragma once
#include <gtest/gtest.h>

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

class RunFolderTest : public testing::Test {
 protected:
  static Json color_step(const std::string& name, double red) {
    return {{"name", name},
            {"edit",
             {{{"op", "replace"},
               {"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor"},
               {"value", {red, 0.4, 0.1, 1}}}}}};
  }
  static Json move(double x) {
    return Json::array({{{"op", "replace"}, {"path", "/nodes/CentralSphere/translation"}, {"value", {x, 1, 0}}}});
  }
  /// Colours, a drag, a wedge.
  static std::vector<Json> steps_of_journal() {
    return {color_step("one", 0.1),
            {{"name", "slide"}, {"select", {"/nodes/CentralSphere"}}, {"drag", {move(0.1), move(0.2), move(0.3)}}},
            color_step("three", 0.7),
            {{"name", "wedge"},
             {"wedge", {{"path", "/materials/Glass/extensions/KHR_materials_ior/ior"}, {"values", {1.2, 1.4, 1.6}}}}},
            color_step("five", 0.9)};
  }
  /// All files below a folder by their hashes.
  static std::map<std::string, std::string> hashes_below(const std::filesystem::path& folder) {
    std::map<std::string, std::string> hashes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        hashes[entry.path().lexically_relative(folder).string()] = hash128(read_file(entry.path()));
    return hashes;
  }
  /// From another working folder.
  static ProgramResult run_program_in(const std::string& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"sh", "-c", "cd \"$0\" && exec \"$@\"", folder, RELOOK_PROGRAM});
    return run_program(arguments);
  }
  void SetUp() override {
    write_journal("j.json", steps_of_journal());
    ASSERT_EQ(
        relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "72x40", "--quiet"})
            .exit_code,
        0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void write_journal(const std::string& name, const std::vector<Json>& steps) const {
    std::ofstream(at(name)) << Json{{"relook", "journal/1"}, {"steps", steps}}.dump();
  }
  void write_text(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(at(name)).parent_path());
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
    EXPECT_FALSE(std::filesystem::exists(at(run + "/progress.jsonl"))) << "gone once the report has all";
  }
  ScratchFolder folder_{"run_folder"};
};

}  // namespace relook
