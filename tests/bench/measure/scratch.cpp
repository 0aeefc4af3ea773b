#include "scratch.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"

namespace relook {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "relook_bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw IoError(name, "cannot create the folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

namespace {

/// What a child does to its files: one of them goes to a path, if there is one.
class FileActions {
 public:
  FileActions(int file, const std::filesystem::path& path) {
    posix_spawn_file_actions_init(&actions_);
    if (!path.empty())
      posix_spawn_file_actions_addopen(&actions_, file, path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// The child's wait status.
int wait_for(std::vector<std::string>& command, const FileActions& actions, rusage& usage) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ) != 0 ||
      wait4(child, &status, 0, &usage) != child)
    throw IoError(command[0], "cannot be run");
  return status;
}

}  // namespace

ProgramRun try_program(std::vector<std::string> command, const std::filesystem::path& errors) {
  rusage usage{};
  const int status = wait_for(command, FileActions(STDERR_FILENO, errors), usage);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, static_cast<std::uint64_t>(usage.ru_maxrss) << 10,
          std::string(text_of(read_file(errors)))};
}

void run_program(std::vector<std::string> command, const std::filesystem::path& output) {
  rusage usage{};
  const FileActions actions(STDOUT_FILENO, output);
  if (wait_for(command, actions, usage) != 0) throw IoError(command[0], "failed");
}

}  // namespace relook
