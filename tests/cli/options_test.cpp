// Options of the command line: those without effect are refused in one line that names verb and option; those that all
// verbs have in common are taken by all.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

struct Row {
  std::vector<std::string> command;  // its first word is the verb; C, J and R: a cache, a journal and a run folder
  std::string option;
  std::string reason;
};

class Options : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::vector<std::string> filled(std::vector<std::string> words) const {
    for (std::string& word : words) {
      if (word == "SCENE") word = kScene;
      if (word == "C" || word == "J" || word == "R") word = at(word);
    }
    return words;
  }
  void expect_refused(const Row& row) const {
    std::string line;
    for (const std::string& word : row.command) line += " " + word;
    const ProgramResult result = relook(filled(row.command));
    EXPECT_EQ(result.exit_code, 1) << line << ": " << result.output;
    EXPECT_TRUE(result.output.starts_with("relook: " + row.command[0])) << line << ": " << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << line << ": " << result.output;
    for (const std::string& part : {row.option, row.reason})
      EXPECT_NE(result.output.find(part), std::string::npos) << line << ": " << result.output;
  }
  ScratchFolder folder_{"options"};
};

TEST_F(Options, of_other_verbs_are_refused) {
  const std::vector<Row> rows{
      {{"render", "SCENE", "-o", "R", "--tunnels", "2"}, "--tunnels", "an option of preprocess, replay"},
      {{"render", "SCENE", "-o", "R", "--memory", "2G"}, "--memory", "an option of preprocess, replay"},
      {{"render", "SCENE", "-o", "R", "--shadow-bits=2"}, "--shadow-bits", "replay"},
      {{"render", "SCENE", "-o", "R", "--verify"}, "--verify", "replay"},
      {{"render", "SCENE", "-o", "R", "--sample", "2"}, "--sample", "did you mean \"--samples\"?"},
      {{"render", "SCENE", "-o", "R", "--nothing-like-it"}, "--nothing-like-it", "relook render --help"},
      {{"preprocess", "SCENE", "-o", "C", "--policy", "lru"}, "--policy", "an option of replay"},
      {{"preprocess", "SCENE", "-o", "C", "--journal", "J"}, "--journal", "render"},
      {{"replay", "C", "J", "-o", "R", "--camera", "auto"}, "--camera", "render"},
      {{"replay", "C", "J", "-o", "R", "--samples", "4"}, "--samples", "replay takes no"},
      {{"compare", "C", "R", "--tunnels", "2"}, "--tunnels", "replay"},
      {{"inspect", "SCENE", "--tunnels", "2"}, "--tunnels", "replay"},
      {{"inspect", "SCENE", "--memory", "2G"}, "--memory", "replay"},
      {{"check", "C", "--memory", "2G"}, "--memory", "replay"},
      {{"check", "C", "--scene", "SCENE"}, "--scene", "replay"},
      {{"tune", "J", "--policy", "lru"}, "--policy", "replay"},
      {{"plan", "C", "J", "--memory", "2G"}, "--memory", "replay"},
      {{"plan", "C", "J", "--tunnels", "2"}, "--tunnels", "replay"},
      {{"blame", "R", "1,1", "--samples", "4"}, "--samples", "render"},
      {{"journal", "variants", "SCENE", "-o", "J", "--samples", "4"}, "--samples", "render"},
  };
  for (const Row& row : rows) expect_refused(row);
}

TEST_F(Options, without_effect_beside_others_are_refused) {
  const std::string png = at("x.png");
  const std::vector<Row> rows{
      {{"render", "SCENE", "-o", png, "--float"}, "--float", "PNG"},
      {{"render", "SCENE", "-o", png, "--aovs"}, "--aovs", "PNG"},
      {{"replay", "C", "J", "-o", "R", "--report", "none", "--baseline"}, "--baseline", "--report none"},
      {{"compare", "C", "R", "--exposure", "2"}, "--exposure", "--html"},
      {{"compare", "C", "R", "--exact", "--peak", "2"}, "--peak", "--exact"},
      {{"compare", "C", "R", "--exact", "--failflip", "0.1"}, "--failflip", "--exact"},
      {{"compare", "C", "R", "--exact", "--warnflip", "0.1"}, "--warnflip", "--exact"},
  };
  for (const Row& row : rows) expect_refused(row);
}

/// What preprocess is told of structures is the cache's, and a replay's where that is not told otherwise.
TEST_F(Options, of_structures_that_a_replay_does_not_name_are_those_of_the_cache) {
  ASSERT_EQ(relook({"preprocess",
                    kScene,
                    "-o",
                    at("C"),
                    "--integrator",
                    "whitted",
                    "--resolution",
                    "16x9",
                    "--quiet",
                    "--groups",
                    "7",
                    "--atoms",
                    "2",
                    "--color-trees",
                    "25",
                    "--tunnels",
                    "3",
                    "--tunnel-levels",
                    "1",
                    "--most-tunnels",
                    "500"})
                .exit_code,
            0);
  std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": []})";
  const auto options_of = [&](std::vector<std::string> options) {
    std::vector<std::string> words{"replay", at("C"), at("j.json"), "-o", at("R"), "--fresh", "--overwrite", "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(relook(words).exit_code, 0);
    return parse_json(text_of(read_file(folder_ / "R/report.json")), "report.json")["options"];
  };
  Json options = options_of({});
  EXPECT_EQ(options["groups"], 7);
  EXPECT_EQ(options["atoms"], 2);
  EXPECT_EQ(options["color_trees"], 25);
  EXPECT_EQ(options["tunnels"], 3);
  EXPECT_EQ(options["tunnel_levels"], 1);
  EXPECT_EQ(options["most_tunnels"], 500);
  options = options_of({"--groups", "2", "--atoms", "0", "--color-trees", "50", "--tunnels", "1"});
  EXPECT_EQ(options["groups"], 2);
  EXPECT_EQ(options["atoms"], 0);
  EXPECT_EQ(options["color_trees"], 50);
  EXPECT_EQ(options["tunnels"], 1);
}

TEST_F(Options, memory_of_a_preprocess_is_a_limit_that_is_said) {
  const std::vector<std::string> command{"preprocess", kScene,      "-o", at("C"),  "--resolution",
                                         "640x360",    "--samples", "1",  "--quiet"};
  std::vector<std::string> tight = command, ample = command;
  tight.insert(tight.end(), {"--memory", "8M"});
  ample.insert(ample.end(), {"--memory", "4G"});
  const ProgramResult refused = relook(tight);
  EXPECT_EQ(refused.exit_code, 4) << refused.output;
  EXPECT_TRUE(refused.output.starts_with("relook: --memory: ")) << refused.output;
  EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  EXPECT_FALSE(std::filesystem::exists(at("C")));
  EXPECT_EQ(relook(ample).exit_code, 0);
}

TEST_F(Options, of_a_view_are_refused_where_the_view_is_fixed) {
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("C"), "--resolution", "16x9", "--quiet"}).exit_code, 0);
  std::ofstream(at("J")) << R"({"relook": "journal/1", "steps": []})";
  std::filesystem::rename(at("J"), at("J.json"));
  const std::string journal = at("J.json");
  ASSERT_EQ(relook({"replay", at("C"), journal, "-o", at("R"), "--quiet"}).exit_code, 0);
  const std::vector<Row> rows{
      {{"inspect", "C", "--camera", "auto"}, "--camera", "is a cache"},
      {{"inspect", "C", "--lights", "auto"}, "--lights", "is a cache"},
      {{"inspect", "C", "--look", "--samples", "4"}, "--samples", "is a cache"},
      {{"inspect", "R", "--resolution", "16x9"}, "--resolution", "is a run"},
      {{"inspect", journal, "--lights", "auto"}, "--lights", "given with --scene"},
      {{"inspect", journal, "--scene", "C", "--max-depth", "3"}, "--max-depth", "is a cache"},
      {{"inspect", journal, "--scene", "C", "--look", journal}, "--look", "is a cache"},
  };
  for (const Row& row : rows) expect_refused(row);
  EXPECT_EQ(
      relook({"inspect", kScene, "--camera", "auto", "--samples", "4", "--resolution", "16x9", "--json"}).exit_code, 0)
      << "one VIEW for render, preprocess and inspect";
  EXPECT_EQ(relook({"inspect", journal, "--scene", kScene, "--camera", "auto"}).exit_code, 0);
}

TEST_F(Options, in_common_are_taken_by_every_verb) {
  const std::vector<std::vector<std::string>> commands{
      {"render", "nothing.gltf", "-o", at("x.exr")},
      {"preprocess", "nothing.gltf", "-o", "C"},
      {"replay", "C", "J", "-o", "R"},
      {"compare", "C", "R"},
      {"inspect", "nothing.gltf"},
      {"check", "C"},
      {"tune", "J"},
      {"plan", "C", "J"},
      {"blame", "R", "1,1"},
      {"journal", "variants", "nothing.gltf", "-o", "J"},
      {"completions", "bash"},
  };
  for (std::vector<std::string> command : commands) {
    command = filled(command);
    for (const std::string option : {"--threads", "1", "--quiet", "--progress", "none", "--json", "--log-json",
                                     "--overwrite", "--import-memory", "1G"})
      command.push_back(option);
    command.insert(command.end(), {"--trace", at("trace.json")});
    const ProgramResult result = relook(command);
    EXPECT_EQ(result.output.find(" takes no "), std::string::npos) << result.output;
    EXPECT_NE(result.exit_code, 1) << command[0] << ": " << result.output;
  }
}

}  // namespace
}  // namespace relook
