#include "scratch.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"

namespace relook {

Scratch::Scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "relook_bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw IoError(name, "cannot create the folder");
  path_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

namespace {

/// The child's wait status. `actions`: null: none.
int wait_for(std::vector<std::string>& command, const posix_spawn_file_actions_t* actions, rusage& usage) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawnp(&child, arguments[0], actions, nullptr, arguments.data(), environ) != 0 ||
      wait4(child, &status, 0, &usage) != child)
    throw IoError(command[0], "cannot be run");
  return status;
}

}  // namespace

ProgramRun try_program(std::vector<std::string> command, const std::filesystem::path& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  rusage usage{};
  const int status = wait_for(command, &actions, usage);
  posix_spawn_file_actions_destroy(&actions);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, static_cast<std::uint64_t>(usage.ru_maxrss) << 10,
          std::string(text_of(read_file(errors)))};
}

void run_program(std::vector<std::string> command) {
  rusage usage{};
  if (wait_for(command, nullptr, usage) != 0) throw IoError(command[0], "failed");
}

}  // namespace relook
