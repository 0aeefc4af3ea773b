// The program: parses, runs one verb, and is the only place that catches, prints errors and picks the exit code.
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string_view>

#include "base/parallel.h"
#include "options/outputs.h"
#include "options/reach.h"
#include "scene/texture/image_library.h"
#include "terminal/standard_streams.h"
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
    case Verb::blame:
      return run_blame(arguments, console);
    case Verb::plan:
      return run_plan(arguments, console);
    case Verb::journal:
      return run_journal(arguments, console);
    case Verb::export_scene:
      return run_export(arguments, console);
    case Verb::watch:
      return run_watch(arguments, console);
    case Verb::report:
      return run_report(arguments, console);
    case Verb::sheet:
      return run_sheet(arguments, console);
    case Verb::completions:
      return run_completions(arguments, console);
    case Verb::schema:
      return run_schema(arguments, console);
    case Verb::complete:
      return run_complete(arguments, console);
  }
  return ExitCode::usage;
}

/// The exit code of `work`, or of what it threw, after report(code, sentence).
template <class Work, class Report>
int guarded(const Work& work, const Report& report) {
  try {
    return static_cast<int>(work());
  } catch (const Interrupted& interrupted) {
    report(static_cast<ExitCode>(kSignalExitBase + interrupted.signal), "interrupted");
    return kSignalExitBase + interrupted.signal;
  } catch (const Error& error) {
    report(error.code(), error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    report(ExitCode::out_of_resources, "out of memory");
    return static_cast<int>(ExitCode::out_of_resources);
  } catch (const std::exception& error) {
    report(ExitCode::io, printable(error.what()).c_str());
    return static_cast<int>(ExitCode::io);
  }
}

/// Whether a verb makes frames; others read, and write a small file in the end, if any.
bool makes_pictures(Verb verb) {
  return verb == Verb::render || verb == Verb::preprocess || verb == Verb::replay || verb == Verb::watch;
}

/// RELOOK_SANDBOX=off is for debuggers and tools that trace, start programs or write files of their own.
bool wants_sandbox() {
  const char* wish = std::getenv("RELOOK_SANDBOX");
  return wish == nullptr || std::string_view(wish) != "off";
}

ExitCode run(const Arguments& arguments) {
  if (wants_sandbox()) enter_sandbox(reach_of(arguments));  // before Interrupt starts a thread
  Interrupt interrupt;
  Console console(arguments, interrupt);
  const auto report = [&](ExitCode code, const char* what) { console.error(code, what); };
  interrupt.set_last_words(
      [&](int signal) { console.error(static_cast<ExitCode>(kSignalExitBase + signal), "interrupted"); });
  set_thread_count(arguments.threads);
  const int code = guarded(
      [&] {
        require_one_standard_input(arguments);
        check_outputs(arguments);
        std::optional<Interrupt::Expendable> only_reads;
        if (!makes_pictures(arguments.verb)) only_reads.emplace(interrupt);
        const ExitCode result = run_verb(arguments, console);
        console.finish();
        return result;
      },
      report);
  const int traced = guarded(
      [&] {
        if (code != static_cast<int>(ExitCode::usage)) console.trace().write();
        return ExitCode::ok;
      },
      report);
  return static_cast<ExitCode>(code == 0 ? traced : code);
}

}  // namespace
}  // namespace relook

int main(int argc, char** argv) {
  relook::open_closed_descriptors();
  relook::limit_image_library_threads();
  relook::set_float_mode();
  const auto print_error = [](relook::ExitCode, const char* what) { std::fprintf(stderr, "relook: %s\n", what); };
  relook::ParsedCommandLine parsed;
  const int code = relook::guarded(
      [&] {
        parsed = relook::parse_command_line(argc, argv);
        relook::StandardOutput output;
        output.print(parsed.text);
        output.finish();
        return relook::ExitCode::ok;
      },
      print_error);
  if (code != 0 || !parsed.arguments) return code;
  return relook::guarded([&] { return relook::run(*parsed.arguments); }, print_error);
}
