// What the contact sheet of a run's page needs of an entry beside its numbers: which step it starts from, its place in
// a drag or wedge with its values, notes, and its edit in short, for words on the card and for the search. One object
// in each row, with only the members that the entry has; assets/run_data.js reads it. Used by run_page.cpp.
#pragma once
#include <cstddef>

#include "base/json.h"
#include "edit/journal.h"

namespace relook {

/// The place of an entry among the frames of a drag or wedge, from 1; 0: it is the step's own.
[[nodiscard]] std::size_t frame_in_step(const Json& entry);
/// Its step in the journal; null for the frame before any edit.
[[nodiscard]] const JournalStep* step_of(const Json& entry, const Journal& journal);

/// `from` (0: the base), `keep` (false alone), `frame` (its place), `is` ("drag", "wedge"), `axes` ({path, label,
/// count}), `values` (texts by axis), `note`, `author`, and, where `has_edit`, `edit` ([operation, path, value in
/// short]).
[[nodiscard]] Json marks_of(const Json& entry, const Journal& journal, bool has_edit);

}  // namespace relook
