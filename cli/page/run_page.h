// report.html of a run: what report.json and the journal say, and the frames themselves, for a browser. Made from the
// files of the run, so that steps of an earlier run that were kept are in it, too.
#pragma once
#include <filesystem>

#include "base/json.h"
#include "edit/journal.h"

namespace relook {

/// Writes report.html. The linear pixels of the frames, each tile once until it changes, are in the page when they take
/// no more than `embedded_bytes` there; else in pixels/*.js beside it. `report`: as in report.json; the frames,
/// previews and overlays that it names are in `folder`. Throws InputError (a frame is missing or damaged), IoError,
/// ResourceError.
void write_run_page(const std::filesystem::path& folder, const Json& report, const Journal& journal,
                    std::size_t embedded_bytes = std::size_t{24} << 20);

}  // namespace relook
