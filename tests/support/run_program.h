// Runs a program as a user would, and reads what a replay left behind.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

/// A folder for one test, empty at first and removed with its contents at the end.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

struct ProgramResult {
  int exit_code = -1;  // 128 + signal when it was killed
  std::string output;  // stdout and stderr
};

/// Runs `command[0]` (searched for in PATH) without standard input and waits for it.
[[nodiscard]] ProgramResult run_program(const std::vector<std::string>& command);
/// The same of the program that is tested.
ProgramResult relook(std::vector<std::string> arguments);

/// For tests to which one scene is as good as another.
inline const std::string kScene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();

struct MeasuredResult {
  int exit_code = -1;
  double peak_mib = 0;  // of the program's resident set, as the operating system saw it
  double seconds = 0;
  std::string output;  // stdout and stderr
};
/// Runs relook and measures it. A gtest failure when that cannot be.
[[nodiscard]] MeasuredResult measure_relook(std::vector<std::string> arguments);

/// Starts the program without waiting; its output is not caught.
[[nodiscard]] pid_t start_relook(std::vector<std::string> arguments);
/// Its exit code; 128 + signal when it was killed.
int wait_for(pid_t child);

/// The bytes of a file; of a preview (.png) the last chunk only: that it is whole.
[[nodiscard]] std::vector<std::byte> frame_bytes(const std::filesystem::path& file);

/// What a replay is to be run on.
struct ReplayCase {
  std::filesystem::path scene, journal;
  std::string resolution;
  std::vector<std::string> view;  // further flags of `relook preprocess`
};

/// Preprocesses and replays with --verify below `folder`; returns report.json. A gtest failure, and an empty object,
/// when a program fails.
[[nodiscard]] Json verified_report(const ReplayCase& replay, const ScratchFolder& folder);

/// Checks each step of a report: no pixel differs from the full render, the step's name begins with its class (as in
/// "color: ..."; not checked for `plain_names`), it changed the image, and a colour step shot no ray. There is a
/// colour, an optical and a geometric step.
void expect_exact_steps(const Json& report, bool plain_names = false);

}  // namespace relook
