// What people mean by what a look document does not have: keys that stand elsewhere, words of other programs, numbers
// in other units. For messages alone.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "scene/look/look_schema.h"

namespace relook {

/// Where below an object of this schema stands what `key` means, as "pbrMetallicRoughness/roughnessFactor": the same
/// key deeper (case and British spelling count for nothing), what other programs call so ("color" of a material), or
/// what is spelled nearly so. "" if nothing is meant that is known.
[[nodiscard]] std::string deeper_place(const Schema& schema, std::string_view key);

/// Does a schema know the place that tokens lead to, items of lists and of arrays of numbers included?
[[nodiscard]] bool knows_place(const Schema& schema, std::span<const std::string> tokens);

/// To be added to what is wrong with a value: three angles for a quaternion, colours from 0 to 255, degrees where
/// radians count. "" for other values.
[[nodiscard]] std::string value_hint(const SchemaField& field, const Json& value);

}  // namespace relook
