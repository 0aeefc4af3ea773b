// Signals that ask the program to end, schedulers' notices included: whatever it is doing, it ends soon, says so in its
// exit code, leaves no temporary files, and the same command goes on from there.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "base/files.h"
#include "base/hash.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::size_t kFramesAtWork = 2;  // that a replay may still finish after a signal

/// The exit code.
int end_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  return WEXITSTATUS(status);
}

Json move(double x) {
  return Json::array({{{"op", "replace"}, {"path", "/nodes/CentralSphere/translation"}, {"value", {x, 1, 0}}}});
}

/// Two steps, a drag and a wedge of many frames each.
std::string journal_text() {
  Json drag = Json::array(), values = Json::array();
  for (int i = 0; i < 150; ++i) {
    drag.push_back(move(0.002 * i));
    values.push_back(1.1 + 0.004 * i);
  }
  const Json steps{{{"edit", move(0.1)}},
                   {{"edit", move(0.2)}},
                   {{"select", {"/nodes/CentralSphere"}}, {"drag", drag}},
                   {{"wedge", {{"path", "/materials/Glass/extensions/KHR_materials_ior/ior"}, {"values", values}}}}};
  return Json{{"relook", "journal/1"}, {"steps", steps}}.dump();
}

class Interruption : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(at("j.json")) << journal_text(); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::vector<std::string> replay(const std::string& run) const {
    return {"replay", at("c"), at("j.json"), "-o", at(run), "--quiet", "--report", "json"};
  }
  void wait_for(const std::string& file) const {
    for (int i = 0; i < 3000 && !fs::exists(at(file)); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_TRUE(fs::exists(at(file))) << file;
  }
  [[nodiscard]] std::size_t frame_count(const std::string& run) const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(at(run + "/frames")))
      count += entry.path().filename().string().starts_with(".") ? 0 : 1;
    return count;
  }
  /// Sends a signal to the replay of "run" and waits for it: its exit code. It does no more than what it is at.
  [[nodiscard]] int end_by(int signal, pid_t child) const {
    kill(child, signal);
    const std::size_t at_signal = frame_count("run");
    const int code = end_of(child);
    EXPECT_LE(frame_count("run"), at_signal + kFramesAtWork);
    return code;
  }
  [[nodiscard]] std::map<std::string, std::string> frames(const std::string& run) const {
    std::map<std::string, std::string> frames;
    for (const char* part : {"frames", "previews"})
      for (const auto& entry : fs::directory_iterator(at(run + "/" + part)))
        frames[entry.path().lexically_relative(at(run)).string()] = hash128(read_file(entry.path()));
    return frames;
  }
  [[nodiscard]] Json report(const std::string& run) const {
    return parse_json(text_of(read_file(at(run + "/report.json"))), "report.json");
  }
  ScratchFolder folder_{"interruption"};
};

TEST_F(Interruption, a_run_is_left_and_taken_up_by_any_signal_within_steps_drags_and_wedges) {
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "96x54", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(relook(replay("whole")).exit_code, 0);
  const auto whole = frames("whole");
  const std::vector<std::pair<int, std::string>> signals{
      {SIGTERM, "frames/0001.exr"},     {SIGINT, "frames/0003_010.exr"},  {SIGHUP, "frames/0003_050.exr"},
      {SIGUSR1, "frames/0003_100.exr"}, {SIGUSR2, "frames/0004_020.exr"}, {SIGXCPU, "frames/0004_070.exr"}};
  for (const auto& [signal, after] : signals) {
    SCOPED_TRACE(strsignal(signal));
    fs::remove_all(at("run"));
    const pid_t child = start_relook(replay("run"));
    wait_for("run/" + after);
    EXPECT_EQ(end_by(signal, child), 128 + signal);
    const auto left = frames("run");
    for (const auto& [name, hash] : left) {
      ASSERT_TRUE(whole.contains(name)) << name << " remains";
      EXPECT_EQ(hash, whole.at(name)) << name;
    }
    EXPECT_EQ(report("run")["interrupted"], true);
    EXPECT_EQ(report("run")["frames"].size() * 2, left.size());
    ASSERT_EQ(relook(replay("run")).exit_code, 0);
    EXPECT_EQ(report("run")["interrupted"], false);
    EXPECT_EQ(report("run")["resumed"]["frames"], left.size() / 2);
    EXPECT_EQ(report("run")["frames"], report("whole")["frames"]);
    EXPECT_TRUE(frames("run") == whole);
  }
}

/// Has a signal been sent to a process that it has not been given yet? False if it has ended.
bool has_pending_signal(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:\tZ"))
      return false;
    else if (line.starts_with("ShdPnd:"))
      return line.find_first_not_of("0", line.find('\t') + 1) != std::string::npos;
  return false;
}

TEST_F(Interruption, further_signals_change_nothing) {
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "96x54", "--quiet"})
                .exit_code,
            0);
  const pid_t child = start_relook(replay("run"));
  wait_for("run/frames/0002.exr");
  for (const int signal : {SIGUSR1, SIGTERM, SIGINT, SIGTERM, SIGUSR2, SIGHUP, SIGXCPU}) {
    kill(child, signal);
    while (has_pending_signal(child)) std::this_thread::sleep_for(1ms);  // of several the least would be the first
  }
  EXPECT_EQ(end_of(child), 128 + SIGUSR1);
  EXPECT_EQ(report("run")["interrupted"], true);
}

TEST_F(Interruption, long_work_of_every_verb_ends_and_leaves_no_files) {
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "640x360",
                    "--samples", "64", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(
      relook({"render", kScene, "--integrator", "whitted", "-o", at("a.exr"), "--resolution", "2048x1152", "--quiet"})
          .exit_code,
      0);
  ASSERT_EQ(relook({"render", kScene, "--integrator", "whitted", "-o", at("b.exr"), "--resolution", "2048x1152",
                    "--lights", "auto", "--quiet"})
                .exit_code,
            0);
  std::ofstream(at("slow.json"))
      << Json{{"relook", "journal/1"}, {"steps", {{{"edit", move(0.5)}}, {{"edit", move(0.1)}}}}}.dump();
  const std::vector<std::vector<std::string>> commands{
      {"render", kScene, "--integrator", "whitted", "-o", at("x.exr"), "--resolution", "1920x1080", "--samples", "256"},
      {"render", kScene, "--integrator", "whitted", "-o", at("x.exr"), "--resolution", "1920x1080", "--samples", "16",
       "--aovs"},
      {"preprocess", kScene, "--integrator", "whitted", "-o", at("x"), "--resolution", "1920x1080", "--samples", "64"},
      {"replay", at("c"), at("slow.json"), "-o", at("run"), "--aovs", "--verify"},
      {"compare", at("a.exr"), at("b.exr"), "-o", at("compared")},
      {"plan", at("c"), at("slow.json"), "--json=" + at("plan.json")}};
  std::map<std::string, bool> before;
  for (const auto& entry : fs::directory_iterator(at(""))) before[entry.path().string()] = true;
  for (std::vector<std::string> command : commands) {
    SCOPED_TRACE(command[0]);
    command.push_back("--quiet");
    const pid_t child = start_relook(command);
    std::this_thread::sleep_for(1200ms);
    kill(child, SIGTERM);
    const int code = end_of(child);
    EXPECT_TRUE(code == 128 + SIGTERM || (code == 10 && command[0] == "compare") || (code == 0 && command[0] == "plan"))
        << code;
    for (const auto& entry : fs::directory_iterator(at(""))) {
      const std::string name = entry.path().filename().string();
      const bool is_expected =
          before.contains(entry.path().string()) || name == "run" || name == "compared" || name == "plan.json";
      EXPECT_TRUE(is_expected) << name << " remains";
    }
  }
  if (!fs::exists(at("run"))) return;
  for (const auto& entry : fs::recursive_directory_iterator(at("run"))) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

TEST_F(Interruption, a_reader_that_has_stopped_reading_does_not_keep_a_run_from_ending) {
  ASSERT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "32x18", "--quiet"})
                .exit_code,
            0);
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  ASSERT_GE(fcntl(ends[1], F_SETPIPE_SZ, 4096), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    execl(RELOOK_PROGRAM, RELOOK_PROGRAM, "replay", at("c").c_str(), at("j.json").c_str(), "-o", at("run").c_str(),
          nullptr);
    _exit(127);
  }
  wait_for("run/frames/0001.exr");
  std::this_thread::sleep_for(1500ms);  // by now nothing more goes into the pipe
  EXPECT_FALSE(fs::exists(at("run/frames/0003_150.exr"))) << "the run waits for its reader";
  EXPECT_EQ(end_by(SIGTERM, child), 128 + SIGTERM);
  EXPECT_EQ(report("run")["interrupted"], true);
  close(ends[0]);
  close(ends[1]);
}

TEST_F(Interruption, a_limit_on_the_size_of_files_is_a_line_and_not_death) {
  for (const std::string command : {"preprocess", "render"}) {
    const std::string output = at(command == "render" ? "x.exr" : "x");
    const ProgramResult result = run_program({"sh", "-c", "ulimit -f 8; exec \"$0\" \"$@\"", RELOOK_PROGRAM, command,
                                              kScene, "-o", output, "--resolution", "320x180", "--quiet"});
    EXPECT_EQ(result.exit_code, 4) << result.output;
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
    EXPECT_FALSE(fs::exists(output));
  }
}

}  // namespace
}  // namespace relook
