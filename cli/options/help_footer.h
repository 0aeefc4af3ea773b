// What stands below the options in the help of the program and of its verbs.
#pragma once
#include <string>
#include <string_view>

namespace relook {

/// Examples of a verb ("replay", "journal diff"), or of all ("" for the program), and the exit codes.
[[nodiscard]] std::string help_footer(std::string_view verb);

}  // namespace relook
