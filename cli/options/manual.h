// relook(1), made from what --help shows: `relook --help-man` prints it, the build keeps it for installation.
#pragma once
#include <string>

namespace relook {

/// The manual page in man(7) macros.
[[nodiscard]] std::string manual_text();

}  // namespace relook
