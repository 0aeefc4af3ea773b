// What a replay can take over from a run of the same inputs that ended early, and how it gets to where that run was.
// The files that a journal names count with their bytes.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "edit/journal.h"
#include "engine/display_view.h"

namespace relook {

/// XXH3-128 of all that decides the entries and files of a run: cache (with the build that wrote it), journal and the
/// files it names, options, `view` of the previews; none for a journal with a .gltf asset, which may name further
/// files. Throws Error when the cache has no readable manifest.
[[nodiscard]] std::optional<std::string> run_hash(const Arguments& arguments, const Journal& journal,
                                                  const DisplayView* view);

/// Edits that lead from the cache's state to that after the first `steps` steps: neighbours that only replace values
/// inside of materials, nodes and so on are one edit, since no order of things depends on them.
[[nodiscard]] std::vector<Edit> edits_to(const Journal& journal, std::size_t steps);

}  // namespace relook
