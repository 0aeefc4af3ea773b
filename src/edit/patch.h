// RFC 6902 and RFC 6901 on one JSON value, in place. Nothing here knows look documents.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"

namespace relook {

using Tokens = std::vector<std::string>;  // of a JSON pointer, unescaped

/// Where a pointer was written, for messages.
struct PatchPlace {
  std::string_view file;
  std::string where;
};

[[nodiscard]] std::string pointer_text(const Tokens& tokens);

/// How many of `tokens` lead to values that exist.
[[nodiscard]] std::size_t existing_depth(const Json& root, const Tokens& tokens);
/// The value at `tokens`. These three throw InputError{place} if there is none.
[[nodiscard]] Json& value_at(Json& root, const Tokens& tokens, const PatchPlace& place);
/// Adds as RFC 6902 4.1 does: into an object, before an array's item, or instead of the root. "-" becomes an index.
void add_at(Json& root, Tokens& tokens, Json value, const PatchPlace& place);
/// Removes and returns the value.
Json remove_at(Json& root, const Tokens& tokens, const PatchPlace& place);

}  // namespace relook
