// Every value of a look document that an edit may replace, by its pointer: what `inspect --paths` lists and what the
// schema of journals (edit/guide) offers editors.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "scene/look/look.h"
#include "scene/look/look_schema.h"

namespace relook {

struct LookPath {
  const std::string& pointer;  // "/materials/Gold/pbrMetallicRoughness/roughnessFactor"; valid during the visit
  const SchemaField& field;
  const Json* value = nullptr;  // null: unset, and a "replace" may set it (SchemaField::unwritten)
  const Json& entity;           // what the value is part of
  std::string_view section;     // "materials", "scene"
};

/// Visits values section by section, entities by name. Arrays of numbers are one value. What relook itself keeps there
/// (extras.relook.content, geometry, instances, inverseBinds) is left out, and so are fields that the kind of a light
/// has no use for. Requires: check_values() (look_check.h) passed.
void for_each_path(const LookDocument& document, const std::function<void(const LookPath&)>& visit);

/// "0 to 1", "above 0", "one of point, spot", "4 numbers, 0 to 1": what may stand there.
[[nodiscard]] std::string range_text(const SchemaField& field);

/// "cd", "m", "radians", "linear RGB", ... of a value, by its place; "" where it is a plain factor or no number.
[[nodiscard]] std::string_view unit_of(const LookPath& path);

}  // namespace relook
