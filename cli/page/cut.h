// Texts and values of scenes and journals, cut to what a page has room for. Used by run_entry.cpp and run_marks.cpp.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "base/json.h"

namespace relook {

/// At most `most` bytes of a text, whole characters, with "…" where it was cut.
[[nodiscard]] std::string cut_text(std::string_view text, std::size_t most);

/// A value with its texts cut to `longest` bytes, its lists to 64 items and its depth to 8.
[[nodiscard]] Json cut_json(const Json& value, std::size_t longest, int depth = 0);

/// The text at a key of an object; empty where there is none.
[[nodiscard]] std::string text_at(const Json& object, const char* key);

}  // namespace relook
