// A run that ended early is taken up again: finished frames stay the files they were, and the rest is what it would
// have been. A run of anything else starts anew.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSource = RELOOK_SOURCE_DIR;

/// Colours, an added node and its removal, lights, a drag and a wedge: what may and what may not be applied together.
constexpr const char* kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "red", "edit": [{"op": "replace", "path": "/materials/Mirror/pbrMetallicRoughness/baseColorFactor",
                            "value": [0.9, 0.3, 0.2, 1]}]},
  {"name": "up", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.3, 0]}]},
  {"name": "second", "edit": [{"op": "copy", "from": "/nodes/CentralSphere", "path": "/nodes/Twin"},
                              {"op": "replace", "path": "/nodes/Twin/translation", "value": [1.5, 1, 0.5]}]},
  {"name": "drag", "select": ["/nodes/Twin"], "drag": [
     [{"op": "replace", "path": "/nodes/Twin/translation", "value": [1.2, 1, 0.5]}],
     [{"op": "replace", "path": "/nodes/Twin/translation", "value": [1.0, 1, 0.7]}]]},
  {"name": "gone", "edit": [{"op": "remove", "path": "/nodes/Twin"}]},
  {"name": "wedge", "wedge": {"path": "/nodes/CentralSphere/translation",
                              "values": [[0, 1.1, 0], [0, 1.2, 0], [0.2, 1.2, 0]]}},
  {"name": "last", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1, 0]}]}]})";

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    std::string journal = kJournal;
    const ProgramResult look = relook({"inspect", scene(), "--look"});
    const Json materials = parse_json(look.output, "look").at("materials");
    const std::string first = materials.begin().key();
    journal.replace(journal.find("Mirror"), 6, first);
    std::ofstream(at("j.json")) << journal;
    ASSERT_EQ(
        relook({"preprocess", scene(), "-o", at("c"), "--resolution", "64x36", "--samples", "4", "--quiet"}).exit_code,
        0);
    const ProgramResult whole = replay("whole");
    ASSERT_EQ(whole.exit_code, 0) << whole.output;
    whole_ = files("whole");
  }
  static std::string scene() { return (kSource / "scenes/spheres/spheres.gltf").string(); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::vector<std::string> command(const std::string& run) const {
    return {"replay", at("c"), at("j.json"), "-o", at(run), "--progress", "none"};
  }
  [[nodiscard]] ProgramResult replay(const std::string& run, const std::vector<std::string>& further = {}) const {
    std::vector<std::string> arguments = command(run);
    arguments.insert(arguments.end(), further.begin(), further.end());
    return relook(arguments);
  }
  /// A run that is killed at its n-th call that changes files.
  void kill_at(const std::string& run, int call) const {
    std::filesystem::remove_all(at(run));
    std::vector<std::string> words{"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM,
                                   "RELOOK_FAULT=" + std::to_string(call) + ":kill", RELOOK_PROGRAM};
    for (const std::string& word : command(run)) words.push_back(word);
    ASSERT_EQ(run_program(words).exit_code, 128 + SIGKILL);
  }
  [[nodiscard]] std::map<std::string, Bytes> files(const std::string& run) const {
    std::map<std::string, Bytes> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(at(run)))
      if (entry.is_regular_file() && entry.path().stem() != "report")
        files[entry.path().lexically_relative(at(run)).string()] = frame_bytes(entry.path());
    return files;
  }
  [[nodiscard]] Json report(const std::string& run) const {
    return parse_json(text_of(read_file(at(run + "/report.json"))), "report.json");
  }

  ScratchFolder folder_{"resume"};
  std::map<std::string, Bytes> whole_;
};

TEST_F(Resume, goes_on_after_any_step) {
  std::set<std::size_t> kept;
  for (int call = 14; call < 150; call += 12) {
    SCOPED_TRACE(call);
    kill_at("run", call);
    const ProgramResult resumed = replay("run", {});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
    EXPECT_TRUE(files("run") == whole_);
    const Json now = report("run"), then = report("whole");
    EXPECT_EQ(now["frames"], then["frames"]);
    ASSERT_EQ(now["steps"].size(), then["steps"].size());
    for (std::size_t i = 0; i < now["steps"].size(); ++i)
      for (const char* key : {"step", "name", "class", "frame", "frame_hash", "pixels_changed", "drag_frame", "edits"})
        EXPECT_EQ(now["steps"][i][key], then["steps"][i][key]) << i << " " << key;
    kept.insert(now["resumed"]["frames"].get<std::size_t>());
  }
  EXPECT_GE(kept.size(), 5U);
}

TEST_F(Resume, finished_frames_are_not_written_again) {
  kill_at("run", 100);
  const auto time = std::filesystem::last_write_time(at("run/frames/0001.exr"));
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(at("run/frames/0001.exr")), time);
  EXPECT_GT(report("run")["resumed"]["frames"], 0);
}

TEST_F(Resume, verified_steps_are_exact_after_it) {
  std::vector<std::string> words{"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM, "RELOOK_FAULT=100:kill",
                                 RELOOK_PROGRAM};
  for (const std::string& word : command("run")) words.push_back(word);
  words.push_back("--verify");
  ASSERT_EQ(run_program(words).exit_code, 128 + SIGKILL);
  const ProgramResult resumed = replay("run", {"--verify"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_GT(report("run")["resumed"]["frames"], 0);
  for (const Json& step : report("run")["steps"]) EXPECT_EQ(step["verify"]["pixels_different"], 0);
}

TEST_F(Resume, a_changed_frame_is_done_again) {
  kill_at("run", 100);
  std::ofstream(at("run/frames/0002.exr"), std::ios::app) << "x";
  ASSERT_EQ(replay("run").exit_code, 0);
  EXPECT_TRUE(files("run") == whole_);
  const Json steps = report("run")["steps"];
  EXPECT_EQ(steps[1]["resumed"], true);
  EXPECT_EQ(steps[2]["resumed"], false);
  EXPECT_EQ(steps[3]["resumed"], true) << "each frame for itself";
}

TEST_F(Resume, a_frame_with_another_time_but_the_same_bytes_is_kept) {
  ASSERT_EQ(replay("run").exit_code, 0);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(at("run/frames")))
    std::filesystem::last_write_time(entry.path(), std::filesystem::file_time_type::clock::now());
  EXPECT_NE(replay("run").output.find("complete"), std::string::npos);
}

TEST_F(Resume, fresh_and_further_wishes_do_frames_again) {
  for (const char* flag : {"--fresh", "--overlays", "--verify"}) {
    kill_at("run", 100);
    ASSERT_EQ(replay("run", {flag}).exit_code, 0);
    EXPECT_EQ(report("run")["resumed"]["frames"], 0) << flag;
  }
}

TEST_F(Resume, frames_of_another_kind_are_refused) {
  kill_at("run", 100);
  const ProgramResult refused = replay("run", {"--float"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("half, not float"), std::string::npos) << refused.output;
  ASSERT_EQ(replay("run", {"--float", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 0);
}

TEST_F(Resume, steps_in_use_are_refused) {
  std::filesystem::create_directory(at("run"));
  const int other = open(at("run/progress.jsonl").c_str(), O_RDWR | O_CREAT, 0666);
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_start = 3;  // the byte of a step
  lock.l_len = 1;
  ASSERT_EQ(fcntl(other, F_OFD_SETLK, &lock), 0);
  const ProgramResult refused = replay("run");
  EXPECT_EQ(refused.exit_code, 75);
  EXPECT_EQ(refused.output, "relook: " + at("run") + ": another replay is at one of the steps 0 to 7 of this run\n");
  EXPECT_EQ(replay("run", {"--steps", "4-5"}).exit_code, 0) << "others are free";
  close(other);
  EXPECT_EQ(replay("run").exit_code, 0);
  EXPECT_EQ(report("run")["resumed"]["frames"], 3);
}

}  // namespace
}  // namespace relook
