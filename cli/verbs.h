// One function per verb. Errors are thrown; main() prints them.
#pragma once
#include "base/error.h"
#include "options/arguments.h"
#include "terminal/console.h"

namespace relook {

[[nodiscard]] ExitCode run_render(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_preprocess(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_replay(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_compare(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_inspect(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_check(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_tune(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_blame(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_plan(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_journal(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_export(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_watch(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_report(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_sheet(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_completions(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_schema(const Arguments& arguments, Console& console);
[[nodiscard]] ExitCode run_complete(const Arguments& arguments, Console& console);

}  // namespace relook
