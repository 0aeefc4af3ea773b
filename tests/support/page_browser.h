// A run's report.html in a browser: what it must show, from the files of the run, and the scripts of tests/pages that
// try it.
#pragma once
#include <filesystem>
#include <string>

#include "base/json.h"
#include "run_program.h"

namespace relook {

/// What a browser must find, from report.json and frames, without the page: labels, names, pixels of entry 1 and the
/// last.
[[nodiscard]] Json page_expectations(const std::filesystem::path& run, bool has_overlays);

/// Runs tests/pages/<script> on a run; a gtest failure with what it says, or a skipped test when there is no Chromium.
void use_in_browser(const std::string& script, const std::filesystem::path& run, const Json& expected,
                    const ScratchFolder& folder);

}  // namespace relook
