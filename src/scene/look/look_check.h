// Everything a look document says, checked before any of it is compiled: types, ranges, unknown keys, names, and what
// the schema cannot tell of an entity alone. One gate for scene files, the entities that edits touch, and caches.
#pragma once
#include <string>
#include <string_view>

#include "base/json.h"
#include "scene/compile/state.h"
#include "scene/look/look.h"
#include "scene/look/look_schema.h"

namespace relook {

/// All functions throw LookError{file, pointer, ...}.

/// The sections are there and objects, and nothing else is.
void check_sections(const LookDocument& document, std::string_view file);

/// Not empty and printable, in a section that is keyed by name.
void check_entity_name(const TouchedEntity& entity, std::string_view file);

/// Types, ranges, keys and names of one entity. Requires check_sections() and default values.
void check_entity_values(const LookDocument& document, const TouchedEntity& entity, const Json& value,
                         std::string_view file);

/// check_entity_values(), and what an entity says of stored images and geometry.
void check_entity(const LookDocument& document, const TouchedEntity& entity, const Json& value, std::string_view file);

/// The values of all entities: what names, bounds and cameras may read without a look at types.
void check_values(const LookDocument& document);

/// Sets extras.relook.<key> of an entity; not where something else stands in its place, which the checks refuse.
void set_relook_extra(Json& value, const char* key, const std::string& text);
/// Of a section, of "scene" or of "extensions".
[[nodiscard]] const Schema& schema_of_entity(const std::string& section);
/// "/materials/Gold", "/scene"
[[nodiscard]] std::string entity_pointer(const TouchedEntity& entity);

}  // namespace relook
