// The numbers, words and switches of a glTF document against look_schema.h's table, the one table of bounds: what is
// beyond by rounding is put right, what nothing uses is left out, both with a warning; the rest is an error. Used by
// import.cpp alone.
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
