// The program: parses, runs one verb, and is the only place that catches, prints errors and picks the exit code.
#include <cstdio>
#include <new>

#include "base/parallel.h"
#include "scene/image_library.h"
#include "verbs.h"

namespace relook {
namespace {

constexpr int kSignalExitBase = 128;  // the shell's convention for "ended by a signal"

ExitCode run_verb(const Arguments& arguments, Console& console) {
  switch (arguments.verb) {
    case Verb::render:
      return run_render(arguments, console);
    case Verb::preprocess:
      return run_preprocess(arguments, console);
    case Verb::replay:
      return run_replay(arguments, console);
    case Verb::compare:
      return run_compare(arguments, console);
    case Verb::inspect:
      return run_inspect(arguments, console);
    case Verb::check:
      return run_check(arguments, console);
    case Verb::tune:
      return run_tune(arguments, console);
  }
  return ExitCode::usage;
}

/// A large result is written piece by piece, so that the last flush alone may succeed.
void require_printed() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw IoError("standard output", "cannot be written");
}

ExitCode run(int argc, const char* const* argv) {
  const ParsedCommandLine parsed = parse_command_line(argc, argv);
  if (!parsed.arguments) {
    std::fputs(parsed.text.c_str(), stdout);
    require_printed();
    return ExitCode::ok;
  }
  const Interrupt interrupt;
  Console console(*parsed.arguments, interrupt);
  set_thread_count(parsed.arguments->threads);
  const ExitCode code = run_verb(*parsed.arguments, console);
  require_printed();
  return code;
}

int report(ExitCode code, const char* what) {
  std::fprintf(stderr, "relook: %s\n", what);
  return static_cast<int>(code);
}

}  // namespace
}  // namespace relook

int main(int argc, char** argv) {
  using relook::ExitCode;
  relook::limit_image_library_threads();
  relook::set_float_mode();
  try {
    return static_cast<int>(relook::run(argc, argv));
  } catch (const relook::Interrupted& interrupted) {
    relook::report(ExitCode::ok, "interrupted");
    return relook::kSignalExitBase + interrupted.signal;
  } catch (const relook::Error& error) {
    return relook::report(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return relook::report(ExitCode::out_of_resources, "out of memory");
  } catch (const std::exception& error) {
    return relook::report(ExitCode::io, relook::printable(error.what()).c_str());
  }
}
