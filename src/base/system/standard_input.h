// "-" where an input file is named: standard input, called "stdin" in messages.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

#include "base/files.h"

namespace relook {

inline constexpr std::string_view kStandardInput = "-";

/// Called while an input is waited for; what it throws ends the waiting.
using WhileWaiting = std::function<void()>;

/// What an input is called: its path, or "stdin".
[[nodiscard]] std::filesystem::path input_name(const std::filesystem::path& path);
/// The whole of a file, or of standard input up to its end. Throws InputError: as read_file(), a terminal, more than
/// 1 GiB from a pipe.
[[nodiscard]] Bytes read_input(const std::filesystem::path& path, const WhileWaiting& while_waiting = {});

}  // namespace relook
