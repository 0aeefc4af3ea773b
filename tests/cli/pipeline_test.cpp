// What render farms and scripts use: parts of a journal, progress for render managers, logs, traces.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "base/files.h"
#include "run_program.h"

namespace relook {
namespace {

const char* const kJournalOfAllKinds = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "twin", "edit": [{"op": "copy", "from": "/nodes/CentralSphere", "path": "/nodes/Twin"},
                            {"op": "replace", "path": "/nodes/Twin/translation", "value": [1.5, 1, 0.5]}]},
  {"name": "slide", "select": ["/nodes/Twin"], "drag": [
    [{"op": "replace", "path": "/nodes/Twin/translation", "value": [1.2, 1, 0.5]}],
    [{"op": "replace", "path": "/nodes/Twin/translation", "value": [1.0, 1, 0.7]}]]},
  {"name": "glass", "wedge": {"path": "/materials/Glass/extensions/KHR_materials_ior/ior", "values": [1.2, 1.7]}},
  {"name": "gone", "edit": [{"op": "remove", "path": "/nodes/Twin"}]}]})";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class Pipeline : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "j.json") << kJournalOfAllKinds;
    ASSERT_EQ(
        relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "72x40", "--quiet"})
            .exit_code,
        0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Json json(const std::string& name) const {
    const Bytes bytes = read_file(folder_ / name);
    return parse_json(text_of(bytes), name);
  }
  [[nodiscard]] ProgramResult replay(const std::string& run, std::vector<std::string> flags) const {
    flags.insert(flags.begin(), {"replay", at("c"), at("j.json"), "-o", at(run)});
    return relook(flags);
  }
  ScratchFolder folder_{"pipeline"};
};

TEST_F(Pipeline, parts_of_a_journal_have_the_frames_of_the_whole) {
  ASSERT_EQ(replay("whole", {"--quiet"}).exit_code, 0);
  const Json whole = json("whole/report.json")["frames"];
  ASSERT_EQ(whole.size(), 8U);
  Json together = Json::object();
  for (const std::string steps : {"0-1", "2", "3-4", "5-"}) {
    const ProgramResult result = replay("part" + steps, {"--quiet", "--steps", steps, "--verify"});
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const Json report = json("part" + steps + "/report.json");
    for (const auto& [name, hash] : report["frames"].items()) {
      EXPECT_EQ(hash, whole[name]) << name << " of " << steps;
      EXPECT_FALSE(together.contains(name)) << name;
      together[name] = hash;
    }
    EXPECT_FALSE(report["options"]["steps"].is_null());
  }
  EXPECT_EQ(together, whole);
  EXPECT_EQ(json("part3-4/report.json")["options"]["steps"], "3-4");
  EXPECT_EQ(json("whole/report.json")["options"]["steps"], nullptr);
}

TEST_F(Pipeline, ranges_of_steps_that_make_no_sense_are_usage_errors) {
  for (const std::string steps : {"", "x", "3-2", "-1", "1-x", "6", "1-6", "6-", "1.5", "99999999999"})
    EXPECT_EQ(replay("bad", {"--steps", steps}).exit_code, 1) << steps;
  EXPECT_FALSE(std::filesystem::exists(at("bad")));
}

TEST_F(Pipeline, openjd_progress_rises_from_0_to_100_over_the_whole_run) {
  const ProgramResult result = replay("run", {"--progress", "openjd", "--verify"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  double last = -1;
  std::size_t states = 0;
  const std::string progress = "openjd_progress: ", status = "openjd_status: ";
  for (const std::string& line : lines_of(result.output)) {
    if (line.starts_with(status)) ++states;
    if (!line.starts_with(progress)) continue;
    const double percent = std::stod(line.substr(progress.size()));
    EXPECT_GT(percent, last);
    last = percent;
  }
  EXPECT_EQ(last, 100);
  EXPECT_EQ(states, 8U) << "one a frame\n" << result.output;
  EXPECT_NE(result.output.find("openjd_status: step 3_02 slide\n"), std::string::npos) << result.output;
  const ProgramResult failed = relook({"replay", at("none"), at("j.json"), "-o", at("r"), "--progress", "openjd"});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_NE(failed.output.find("openjd_fail: " + at("none")), std::string::npos) << failed.output;
}

TEST_F(Pipeline, json_progress_names_every_part_and_its_share_of_the_whole) {
  const ProgramResult result = replay("json", {"--progress", "json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  std::vector<int> percents;
  for (const std::string& line : lines_of(result.output)) {
    if (!line.starts_with("{")) continue;
    const Json entry = parse_json(line, "stderr");
    if (entry.contains("part")) percents.push_back(entry["percent"].get<int>());
  }
  EXPECT_EQ(percents.size(), 8U) << "one a frame\n" << result.output;
  EXPECT_TRUE(std::ranges::is_sorted(percents));
  EXPECT_EQ(percents.front(), 0);
}

TEST_F(Pipeline, files_that_cannot_be_written_are_found_out_before_the_work) {
  const ProgramResult logged = replay("unlogged", {"--access-log", at("none/log")});
  EXPECT_EQ(logged.exit_code, 6) << logged.output;
  EXPECT_FALSE(std::filesystem::exists(at("unlogged")));
}

TEST_F(Pipeline, logs_are_one_json_object_a_line) {
  const ProgramResult rendered =
      relook({"render", kScene, "--integrator", "whitted", "-o", at("x.exr"), "--resolution", "72x40", "--log-json"});
  ASSERT_EQ(rendered.exit_code, 0);
  std::size_t logged = 0;
  for (const std::string& line : lines_of(rendered.output))
    if (line.starts_with("{")) {
      const Json entry = parse_json(line, "stderr");
      EXPECT_EQ(entry["level"], "info");
      EXPECT_TRUE(entry.contains("time") && entry.contains("percent") && entry.contains("stage")) << line;
      ++logged;
    }
  EXPECT_GT(logged, 1U);
  const ProgramResult failed =
      relook({"render", at("none.gltf"), "--integrator", "whitted", "-o", at("x.exr"), "--log-json"});
  EXPECT_EQ(failed.exit_code, 2);
  const Json error = parse_json(failed.output, "stderr");
  EXPECT_EQ(error["level"], "error");
  EXPECT_EQ(error["exit_code"], 2);
  EXPECT_NE(error["message"].get<std::string>().find("none.gltf"), std::string::npos);
}

/// Spans of a trace by name; each lies within another or beside it.
std::map<std::string, Json> spans_of(const Json& trace) {
  std::map<std::string, Json> spans;
  for (const Json& event : trace.at("traceEvents")) {
    if (event.at("ph") != "X") continue;
    EXPECT_GE(event.at("ts").get<double>(), 0);
    EXPECT_GE(event.at("dur").get<double>(), 0);
    EXPECT_TRUE(event.contains("pid") && event.contains("tid"));
    spans[event.at("name").get<std::string>()] = event;
  }
  return spans;
}

TEST_F(Pipeline, traces_have_the_stages_of_each_verb) {
  ASSERT_EQ(replay("run", {"--quiet", "--trace", at("replay.json")}).exit_code, 0);
  const auto replayed = spans_of(json("replay.json"));
  for (const char* name : {"read cache", "check journals", "0 base", "1 green", "3_01 slide", "classify"})
    EXPECT_TRUE(replayed.contains(name)) << name;
  const Json& step = replayed.at("2 twin");
  EXPECT_EQ(step["args"]["class"], "geometric");
  EXPECT_LT(step["ts"], replayed.at("5 gone")["ts"]);
  ASSERT_EQ(relook({"render", kScene, "--integrator", "whitted", "-o", at("x.exr"), "--resolution", "72x40", "--quiet",
                    "--trace", at("render.json")})
                .exit_code,
            0);
  const auto rendered = spans_of(json("render.json"));
  EXPECT_TRUE(rendered.contains("load scene") && rendered.contains("render") && rendered.contains("write frame"));
  EXPECT_LE(rendered.at("load scene")["ts"].get<double>() + rendered.at("load scene")["dur"].get<double>(),
            rendered.at("render")["ts"].get<double>());
  EXPECT_EQ(relook({"check", at("c"), "--quiet", "--trace", at("no/such/folder.json")}).exit_code, 6);
}

}  // namespace
}  // namespace relook
