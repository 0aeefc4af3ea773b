// The program on a small scene, called as scripts call it, in a folder of its own: for tests of verbs and their files.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {

class Cli : public testing::Test {
 protected:
  /// A colour and a drag.
  static constexpr const char* kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "slide", "select": ["/nodes/CentralSphere"], "drag": [
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.1, 1, 0]}],
    [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.2, 1, 0]}]]}]})";

  static void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }
  static Json read_json(const std::filesystem::path& path) {
    const Bytes bytes = read_file(path);
    return parse_json(text_of(bytes), path.string());
  }
  /// Exactly one line, which starts with "relook: " and contains `part`.
  static void expect_error(const ProgramResult& result, int exit_code, const std::string& part) {
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    EXPECT_TRUE(result.output.starts_with("relook: ")) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  ProgramResult preprocess(const std::string& output) const {
    return relook(
        {"preprocess", kScene, "--integrator", "whitted", "-o", at(output), "--resolution", "72x40", "--quiet"});
  }
  ScratchFolder folder_{"cli"};
};

}  // namespace relook
