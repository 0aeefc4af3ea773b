#include "run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "base/files.h"

namespace relook {
namespace {

std::string text_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// In the child: never returns.
[[noreturn]] void become(const std::vector<std::string>& command, int output) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const int nothing = open("/dev/null", O_RDONLY);
  if (dup2(nothing, STDIN_FILENO) < 0 || dup2(output, STDOUT_FILENO) < 0 || dup2(output, STDERR_FILENO) < 0) _exit(126);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

/// Python starts the program, since what this process holds would count as the child's.
constexpr const char* kMeasure = R"(
import os, subprocess, sys, time
start = time.monotonic()
child = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
output = child.stdout.read().decode()
_, status, usage = os.wait4(child.pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_maxrss, time.monotonic() - start)
print(output, end="")
)";

}  // namespace

ScratchFolder::ScratchFolder(const std::string& name)
    : path_(std::filesystem::path(testing::TempDir()) / ("relook_" + name + "_" + std::to_string(getpid()))) {
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ProgramResult run_program(const std::vector<std::string>& command) {
  std::string name = (std::filesystem::path(testing::TempDir()) / "relook_output_XXXXXX").string();
  const int output = mkstemp(name.data());
  ProgramResult result;
  if (output < 0) return result;
  const pid_t child = fork();
  if (child == 0) become(command, output);
  close(output);
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child) {
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  result.output = text_file(name);
  std::filesystem::remove(name);
  return result;
}

ProgramResult relook(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), RELOOK_PROGRAM);
  return run_program(arguments);
}

MeasuredResult measure_relook(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"python3", "-c", kMeasure, RELOOK_PROGRAM});
  const ProgramResult result = run_program(arguments);
  std::istringstream output(result.output);
  MeasuredResult measured;
  double kibibytes = 0;
  std::string rest_of_line;
  if (result.exit_code != 0 || !(output >> measured.exit_code >> kibibytes >> measured.seconds)) {
    ADD_FAILURE() << result.output;
    return measured;
  }
  measured.peak_mib = kibibytes / 1024;
  std::getline(output, rest_of_line);
  measured.output = {std::istreambuf_iterator<char>(output), std::istreambuf_iterator<char>()};
  return measured;
}

pid_t start_relook(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), RELOOK_PROGRAM);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv(words[0], words.data());
    _exit(127);
  }
  return child;
}

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::vector<std::byte> frame_bytes(const std::filesystem::path& file) {
  constexpr std::size_t kLastChunk = 12;
  std::vector<std::byte> bytes = read_file(file);
  if (file.extension() == ".png" && bytes.size() > kLastChunk)
    bytes.erase(bytes.begin(), bytes.end() - static_cast<std::ptrdiff_t>(kLastChunk));
  return bytes;
}

Json verified_report(const ReplayCase& replay, const ScratchFolder& folder) {
  const std::string cache = (folder / "cache").string(), run = (folder / "run").string();
  std::vector<std::string> preprocess{RELOOK_PROGRAM, "preprocess",   replay.scene.string(), "-o",
                                      cache,          "--resolution", replay.resolution,     "--quiet"};
  preprocess.insert(preprocess.end(), replay.view.begin(), replay.view.end());
  if (std::ranges::find(replay.view, "--integrator") == replay.view.end())
    preprocess.insert(preprocess.end(), {"--integrator", "whitted"});
  const ProgramResult made = run_program(preprocess);
  EXPECT_EQ(made.exit_code, 0) << made.output;
  if (made.exit_code != 0) return Json::object();
  const ProgramResult replayed =
      run_program({RELOOK_PROGRAM, "replay", cache, replay.journal.string(), "-o", run, "--verify", "--quiet"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output;
  const std::string report = text_file(std::filesystem::path(run) / "report.json");
  return report.empty() ? Json::object() : parse_json(report, "report.json");
}

void expect_exact_steps(const Json& report, bool plain_names) {
  ASSERT_TRUE(report.contains("steps"));
  std::set<std::string> classes;
  for (const Json& step : report["steps"]) {
    const std::string name = step["name"], change = step["class"];
    const int number = step["step"];
    SCOPED_TRACE("step " + std::to_string(number) + " " + name);
    ASSERT_TRUE(step["verify"].is_object());
    EXPECT_EQ(step["verify"]["pixels_different"], 0);
    EXPECT_GT(step["verify"]["pixels_compared"], 0);
    if (number == 0) continue;
    classes.insert(change);
    if (!plain_names) {
      EXPECT_EQ(change, name.substr(0, name.find(':')));
    }
    const bool is_whole_step =
        step["drag_frame"].is_null() && step["frame"].get<std::string>().find('_') != std::string::npos;
    if (!is_whole_step) {
      EXPECT_GT(step["pixels_changed"], 0);
    }
    if (change != "color") continue;
    for (const char* counter : {"ray_tests", "ray_updates", "shadow_updates"}) EXPECT_EQ(step[counter], 0) << counter;
  }
  for (const char* needed : {"color", "optical", "geometric"}) EXPECT_TRUE(classes.contains(needed)) << needed;
}

}  // namespace relook
