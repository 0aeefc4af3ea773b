// Everything a look document says, checked before any of it is compiled: types, ranges, unknown keys, names, and what
// the schema (look_schema.h) cannot tell of an entity alone. One gate for scene files, the entities that edits touch,
// and caches. The check_ functions throw LookError{file, pointer, ...}.
#pragma once
#include <string>
#include <string_view>

#include "base/json.h"
#include "scene/compile/state.h"
#include "scene/look/look.h"
#include "scene/look/look_schema.h"

namespace relook {

/// All sections are there and are objects, `scene` is there, and nothing else but `extensions` is.
void check_sections(const LookDocument& document, std::string_view file);

/// The name of an entity in a section is printable and not empty.
void check_entity_name(const TouchedEntity& entity, std::string_view file);

/// Types, ranges, keys and names of one entity. Requires: check_sections() passed.
void check_entity_values(const LookDocument& document, const TouchedEntity& entity, const Json& value,
                         std::string_view file);

/// As check_entity_values(), and what a light, image, sampler, mesh, skin or node says beyond its schema: of stored
/// images, geometry, matrices. Requires: check_sections() passed, and the entity has its defaults.
void check_entity(const LookDocument& document, const TouchedEntity& entity, const Json& value, std::string_view file);

/// The values of all entities: what names, bounds and cameras may read without a look at types.
void check_values(const LookDocument& document);

/// Sets extras.relook.<key> of an entity; not where something else stands in its place, which the checks refuse.
void set_relook_extra(Json& value, const char* key, const Json& extra);
/// The schema of the entities of a section, of "scene" or of "extensions".
[[nodiscard]] const Schema& schema_of_entity(const std::string& section);
/// The JSON pointer to an entity: "/materials/Gold", "/scene".
[[nodiscard]] std::string entity_pointer(const TouchedEntity& entity);

}  // namespace relook
