// The files of a run folder by name: its parts, what a killed command leaves, what is not the run's.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/own_file.h"
#include "report/progress_file.h"
#include "report/report_file.h"

namespace relook {

struct RunPart {
  std::string_view folder, suffix;
  OwnKind kind;
};
inline constexpr std::array<RunPart, 5> kRunParts{{{"frames", ".exr", OwnKind::frame},
                                                   {"previews", ".png", OwnKind::preview},
                                                   {"overlays", ".png", OwnKind::preview},
                                                   {"relight", ".exr", OwnKind::frame},
                                                   {"pixels", ".js", OwnKind::page_data}}};
/// Says to the page of a run that `watch` goes on with how many entries there are by now.
inline constexpr std::string_view kLiveName = "relook_live.js";
inline constexpr std::array<std::pair<std::string_view, OwnKind>, 4> kRunFiles{{{kReportName, OwnKind::report},
                                                                                {"report.html", OwnKind::page},
                                                                                {kLiveName, OwnKind::page_data},
                                                                                {kProgressName, OwnKind::progress}}};

/// Anything, a link to nothing, too.
[[nodiscard]] bool is_there(const std::filesystem::path& path);
/// The entries of a folder that are not the system's, in order. Throws IoError.
[[nodiscard]] std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);
/// The same; none where a link stands in place of a folder of the run: what lies beyond it is written to and never
/// removed.
[[nodiscard]] std::vector<std::filesystem::path> entries_not_beyond_link(const std::filesystem::path& folder);
/// The name that an unfinished file was to have; "" if it is none.
[[nodiscard]] std::string unfinished_name(const std::filesystem::path& path);
/// "0003_01" of "0003_01.exr", "0003_01_groups.png".
[[nodiscard]] std::string frame_stem(const std::string& name);
/// Whether a name is one that frames, their layers, previews or overlays have: 0003, 0003_01, with a kind and a suffix.
[[nodiscard]] bool is_frame_stem(const std::string& name);
[[nodiscard]] std::uint32_t step_of(const std::string& name);
/// Throws IoError.
void remove_file(const std::filesystem::path& path);

}  // namespace relook
