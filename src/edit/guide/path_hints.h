// What is meant by a pointer that leads nowhere in a look document: for messages alone.
#pragma once
#include <string>
#include <vector>

#include "edit/journal.h"
#include "edit/patch.h"
#include "scene/look/look.h"

namespace relook {

/// "no "color" in /materials/Gold; did you mean /materials/Gold/pbrMetallicRoughness/baseColorFactor?", where a known
/// place is meant: deeper, of another section, of the light or the material of a node, or by the word of another
/// program. "" where nothing better can be said than what is missing, or where the pointer leads somewhere. `tokens`:
/// resolved (names for indices, /lights for lights).
[[nodiscard]] std::string path_hint(const LookDocument& document, const Tokens& tokens);

/// Warnings of values that are taken but hardly meant: degrees where radians count, colours of lights from 0 to 255.
[[nodiscard]] std::vector<std::string> slip_warnings(const Journal& journal);

}  // namespace relook
