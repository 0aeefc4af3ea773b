// A folder for files of the benchmark, and programs it runs.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace relook {

/// A folder that is gone in the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// How a program ended.
struct ProgramRun {
  int exit_code = 0;             // -1: by a signal
  std::uint64_t peak_bytes = 0;  // of its resident set
  std::string errors;            // what it wrote to standard error
};
/// Runs a program (searched for in PATH) and waits. `errors`: a file for its standard error. Throws IoError if it
/// cannot be started.
[[nodiscard]] ProgramRun try_program(std::vector<std::string> command, const std::filesystem::path& errors);
/// Runs a program (searched for in PATH) and waits. `output`: a file for its standard output; "": it stays this one's.
/// Throws IoError unless it exits with 0.
void run_program(std::vector<std::string> command, const std::filesystem::path& output = {});

}  // namespace relook
