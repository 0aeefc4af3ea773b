// Options that would change nothing: refused in one line that names the verb and the option; those of structures that
// an integrator has none of are said in a warning, since scripts give them to all caches alike.
#pragma once
#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "options/arguments.h"

namespace relook {

/// What to say of a command line that `app` refused: of the first option that the verb does not have, if there is one,
/// which verbs have it; else `otherwise`. An unknown option's value may have been taken for an input.
[[nodiscard]] std::string refused_line_text(const CLI::App& app, std::span<const char* const> words,
                                            const std::string& otherwise);

/// Throws UsageError for an option that has no effect beside the others: --float for a PNG, --lens with whitted.
/// What sweeps and scripts give to all of their commands alike stays (--atoms beside --groups 0).
void require_effects(const CLI::App& verb, const Arguments& arguments);

/// What to say of structures that are asked for and that images of the integrator have none of: nothing or one line. To
/// ask for none is no fault.
[[nodiscard]] std::vector<std::string> idle_structures_warning(const Arguments& arguments, Integrator integrator);

}  // namespace relook
