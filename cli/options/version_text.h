// What --version prints.
#pragma once
#include <string>

#include "base/json.h"

namespace relook {

/// The program, and all that decides whether its caches are exchangeable with others'.
[[nodiscard]] std::string version_text();

/// --version --json, "version/1": that, and what the program was built with, can do, reads and writes.
[[nodiscard]] Json version_json();

}  // namespace relook
