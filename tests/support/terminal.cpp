#include "terminal.h"

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

namespace relook {

ProgramResult run_on_terminal(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  ProgramResult result;
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child < 0) return result;
  if (child == 0) {
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  char piece[4096];
  for (ssize_t got = 0; (got = read(terminal, piece, sizeof piece)) > 0;)
    result.output.append(piece, static_cast<std::size_t>(got));
  int status = 0;
  if (waitpid(child, &status, 0) == child)
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  close(terminal);
  return result;
}

}  // namespace relook
