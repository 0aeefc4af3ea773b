// What --version prints.
#pragma once
#include <string>

namespace relook {

/// The program, and all that decides whether its caches are exchangeable with others'.
[[nodiscard]] std::string version_text();

}  // namespace relook
