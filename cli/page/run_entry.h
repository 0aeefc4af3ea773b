// One entry of a run's report as its page has it: a short row for the list and the plots, which is always in the page,
// and details, shown for one step at a time. Texts of scenes and journals can be of any length: here they are cut. Used
// by run_page.cpp; assets/report.js reads both.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "base/json.h"
#include "edit/journal.h"

namespace relook {

/// JSON pointers to the numbers of a row, in their order. Before them a row has the stem, the name, the class
/// and the marks (run_marks.h).
[[nodiscard]] std::span<const std::string_view> row_columns();

/// As a journal has it, whatever its length.
[[nodiscard]] Json whole_operation_json(const PatchOperation& operation);

/// "0003_01" of "frames/0003_01.exr" and "previews/0003_01.png". Throws InputError when entry `i` names anything else.
[[nodiscard]] std::string stem_of(const Json& entry, std::size_t i);
[[nodiscard]] Json row_of(const Json& entry, const std::string& stem, Json marks);

/// Reasons, note, extras (a list of one), selection and edit, `overlays` (`kinds` of them) and whether the frame is
/// `resumed`, as far as they are there.
[[nodiscard]] Json details_of(const Json& entry, const Journal& journal, const Json& kinds);

/// What report.json has above its steps, as far as the page shows it.
[[nodiscard]] Json shown_head(const Json& head);

}  // namespace relook
