// Wedges as journals write them, read strictly. Used by journal.cpp alone.
#pragma once
#include <cstddef>
#include <string>

#include "base/json.h"
#include "edit/wedge/wedge.h"

namespace relook {

/// Counts the frames of a journal as they are read.
class FrameCount {
 public:
  /// Throws JournalLimitError at `place`, which asks for `frames` more, when the journal has more than kMostFrames.
  void add(std::size_t frames, const JsonView& place);

 private:
  std::size_t frames_ = 0;
};

/// A JSON pointer in its RFC 6901 form. Throws InputError.
[[nodiscard]] std::string read_pointer(const JsonView& view);
/// One axis, or a list of two. Throws InputError, JournalLimitError.
[[nodiscard]] Wedge read_wedge(const JsonView& view, FrameCount& frames);

}  // namespace relook
