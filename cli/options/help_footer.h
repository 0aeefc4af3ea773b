// What stands below the options in the help of the program and of its verbs, and in the manual page.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relook {

/// Examples of a verb ("replay", "journal diff"), or of all ("" for the program), and the exit codes.
[[nodiscard]] std::string help_footer(std::string_view verb);

/// "replay shot.cache night.json -o runs/night --verify  every frame proved by a full render": of all verbs that begin
/// so.
[[nodiscard]] std::vector<std::string_view> examples_of(std::string_view verb);

struct ExitMeaning {
  std::string_view code, meaning;
};
[[nodiscard]] std::span<const ExitMeaning> exit_meanings();

}  // namespace relook
