// Names for the entities of a look document: unique, printable, and put where glTF has indices.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "scene/look.h"
#include "scene/look_schema.h"

namespace relook {

/// `wanted` if it is free, else with the first free of "_2", "_3", ...
[[nodiscard]] std::string unique_name(std::string wanted, const std::function<bool(const std::string&)>& is_taken);

/// The section called `name`, if there is one.
[[nodiscard]] std::optional<Section> section_of(std::string_view name);

/// The name that a JSON pointer's token means in a section: itself if it exists or is no glTF index (which
/// has no leading zeros).
[[nodiscard]] std::string resolve_token(const LookDocument& document, Section section, const std::string& token);

/// Puts names where `value` has glTF indices (of the scene file); unknown indices stay.
void name_indices(const LookDocument& document, Section section, Json& value);

}  // namespace relook
