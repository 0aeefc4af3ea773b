// JSON Schema (draft 2020-12) of journals, for editors that complete and check them and for tests. What it refuses,
// edit/journal.h and the rehearsal of a journal refuse, too, with one exception: it judges each operation by itself,
// where an edit is judged by what all of its operations leave. Much that it accepts they refuse: a schema cannot tell
// what an earlier step has left.
#pragma once
#include "base/json.h"
#include "scene/look/look.h"

namespace relook {

/// Of a scene that a schema is for, at most so many names of a section, and so many pointers in all, stand in it; a
/// section beyond that has any name, and pointers are then checked by what follows the name alone.
inline constexpr std::size_t kMostListedNames = 400, kMostListedPointers = 4000;

/// `document`: the scene that journals are for, whose names and pointers are then the only ones unless a journal adds
/// or renames an entity; null: any scene.
[[nodiscard]] Json journal_schema(const LookDocument* document = nullptr);

}  // namespace relook
