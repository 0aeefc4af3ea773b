// The numbers, words and switches of a glTF document against the table of look/look_schema.h, the one table of bounds:
// a value that is beyond by rounding is put right, a wrong one that nothing uses is left out, both with a warning; the
// rest is an error. Used by import.cpp alone.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/gltf/check/gltf_use.h"

namespace relook {

/// Requires: check_document() passed. Throws InputError{file, pointer, ...}; under --strict-gltf for what would be put
/// right, too.
void check_gltf_values(Json& gltf, const GltfUse& use, std::string_view file, std::vector<std::string>& warnings);

}  // namespace relook
