#include "scratch.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

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

void run_program(std::vector<std::string> command) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  int status = 0;
  if (posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0 ||
      waitpid(child, &status, 0) != child || status != 0)
    throw IoError(command[0], "failed");
}

}  // namespace relook
