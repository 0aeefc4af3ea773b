#include "terminal/standard_streams.h"

#include <fcntl.h>
#include <stdio_ext.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "base/error.h"
#include "base/system/standard_input.h"

namespace relook {

void open_closed_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest number that is free is the one that was found closed. A folder can be neither read nor written.
    if (open("/dev/null", O_RDWR) < 0) static_cast<void>(open("/", O_RDONLY));
  }
}

void require_one_standard_input(const Arguments& arguments) {
  const Verb verb = arguments.verb;
  const bool has_journals = verb == Verb::replay || verb == Verb::plan || verb == Verb::inspect;
  const std::ptrdiff_t first = verb == Verb::inspect ? 0 : 1;
  std::ptrdiff_t uses = arguments.journal == kStandardInput ? 1 : 0;
  if (has_journals)
    uses += std::ranges::count(arguments.inputs.begin() + first, arguments.inputs.end(), kStandardInput);
  const bool has_two_scenes = verb == Verb::journal && arguments.journal_source == JournalSource::diff;
  if (arguments.view.look_patch == kStandardInput) uses += has_two_scenes ? 2 : 1;
  if (uses > 1) throw UsageError("\"-\" is standard input, which can be read only once");
}

void StandardOutput::print(std::string_view text) {
  if (!has_reader_) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note(errno);
}

void StandardOutput::flush() {
  if (!has_reader_) return;
  errno = 0;
  if (std::fflush(stdout) != 0) note(errno);
}

void StandardOutput::finish() {
  flush();
  if (has_failed_) throw IoError("standard output", "cannot be written");
}

void StandardOutput::drop() { __fpurge(stdout); }

bool StandardOutput::is_pipe() {
  struct stat status {};
  return fstat(STDOUT_FILENO, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
}

void StandardOutput::note(int error) {
  if (error == EPIPE)
    has_reader_ = false;
  else
    has_failed_ = true;
}

}  // namespace relook
