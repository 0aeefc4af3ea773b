// What a journal says of a frame, as its entry in report.json and its header carry it. Read anew whenever a report is
// written: a name or a note may have changed since a frame was made, which is then made again for its header's sake.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/json.h"
#include "edit/journal.h"
#include "frame/frame_file.h"

namespace relook {

/// The members "name", "from", "keep", "values", "axes", "note", "author" and "extras" of an entry. `frame`: within the
/// step, from 0; none: of a drag or wedge as a whole. Step 0 is the frame before any.
[[nodiscard]] Json entry_words(const Journal& journal, std::uint32_t step, std::optional<std::size_t> frame);

/// Sets the members of a header that a journal gives: name, edit, values, note, author, extras. An edit of more than
/// 16,000 bytes is cut after an operation, and says how many are left out. The frame before any step belongs to all
/// journals: it has none of them.
void add_journal_words(FrameMeta& meta, const Journal& journal, std::uint32_t step, std::size_t frame);
/// Whether a header has them.
[[nodiscard]] bool has_journal_words(const FrameMeta& meta, const Journal& journal, std::uint32_t step,
                                     std::size_t frame);

}  // namespace relook
