// Wildcards of journals: "*" in the name of a pointer that a "replace" goes to, "/materials/Leaves*/emissiveFactor",
// stands for any characters, and the operation is made for each name that it matches. A name that has the "*" itself
// is meant by it alone.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "edit/patch.h"
#include "edit/patch_operation.h"
#include "scene/look/look.h"

namespace relook {

/// Whether "*" in `pattern` can stand for characters so that it is `text`.
[[nodiscard]] bool matches_wildcard(std::string_view pattern, std::string_view text);

/// The paths that an operation goes to, in the order of their names: its own, unless there are wildcards in it. Throws
/// InputError when these match no name.
[[nodiscard]] std::vector<std::string> matching_paths(const LookDocument& document, const PatchOperation& operation,
                                                      const PatchPlace& place);

}  // namespace relook
