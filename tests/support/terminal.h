// Runs a program as a user at a terminal would.
#pragma once
#include <string>
#include <vector>

#include "run_program.h"

namespace relook {

/// Runs `command[0]` (searched for in PATH) with a terminal for its three standard descriptors and waits for it; its
/// lines end with "\r\n".
[[nodiscard]] ProgramResult run_on_terminal(const std::vector<std::string>& command);

}  // namespace relook
