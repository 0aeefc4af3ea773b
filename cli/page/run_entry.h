// One entry of a run's report as its page has it: a short row for the list and the plots, which is always in the page,
// and details, shown for one step at a time. Texts of scenes and journals can be of any length: here they are cut.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "base/json.h"
#include "edit/journal.h"

namespace relook {

/// Pointers to what rows have in numbers, in their order after the stem, whether it is a frame of a drag or a wedge,
/// name and class.
[[nodiscard]] std::span<const std::string_view> row_columns();

/// "0003_01" of "frames/0003_01.exr" and "previews/0003_01.png". Throws InputError when an entry names anything else.
[[nodiscard]] std::string stem_of(const Json& entry, std::size_t i);
[[nodiscard]] Json row_of(const Json& entry, const std::string& stem);

/// Reasons, selection and edit, kinds of overlays, where it is from: what is there of them. `kinds`: of overlays.
[[nodiscard]] Json details_of(const Json& entry, const Journal& journal, const Json& kinds);

/// What report.json has above its steps, as far as the page shows it.
[[nodiscard]] Json shown_head(const Json& head);

/// At most `most` bytes of a text, whole characters, with "…" where it was cut.
[[nodiscard]] std::string cut_text(std::string_view text, std::size_t most);

}  // namespace relook
