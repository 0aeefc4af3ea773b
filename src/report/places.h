// Where the files of a run are, said so that they are found again when the run, or all of it together, has moved, and
// from any working folder: relative to the run and absolute, as ASCII with other bytes as %XX. Written to report.json
// by `replay`, followed by `blame`.
#pragma once
#include <filesystem>
#include <optional>

#include "base/json.h"

namespace relook {

/// [relative to `run`, absolute].
[[nodiscard]] Json place_json(const std::filesystem::path& run, const std::filesystem::path& path);
/// The first of the places that exists; none if none does or `places` is not as place_json() makes it.
[[nodiscard]] std::optional<std::filesystem::path> find_place(const std::filesystem::path& run, const Json& places);

}  // namespace relook
