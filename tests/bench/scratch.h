// A folder for files of the benchmark, and programs it runs.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace relook {

/// A folder that is gone in the end.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Runs a program (searched for in PATH) and waits. Throws IoError unless it exits with 0.
void run_program(std::vector<std::string> command);

}  // namespace relook
