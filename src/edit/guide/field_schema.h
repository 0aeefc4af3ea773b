// The tables of look documents (scene/look/look_schema.h) as JSON Schema: what may stand where, and which pointers
// there are. Parts of the schema of journals (journal_schema.h).
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "base/json.h"
#include "scene/look/look_schema.h"

namespace relook {

/// Schemas of values, those of objects once each under "$defs".
class FieldSchemas {
 public:
  /// `name_schema`: of a name that refers to a target.
  explicit FieldSchemas(std::function<Json(Target)> name_schema) : name_schema_(std::move(name_schema)) {}

  [[nodiscard]] Json of_field(const SchemaField& field);
  /// A reference to the schema of an object. `extra`: members beside those of the table, a schema each.
  [[nodiscard]] Json of_object(std::string_view name, const Schema& schema, const Json& extra = Json::object());
  /// What the references refer to.
  [[nodiscard]] const Json& definitions() const { return definitions_; }

 private:
  std::function<Json(Target)> name_schema_;
  Json definitions_ = Json::object();
};

/// The number that a number, an integer or a component of an array of numbers is.
[[nodiscard]] Json number_schema(const SchemaField& field);

/// Visits each place below an object of a look document: a regular expression for what follows the object's own
/// pointer,
/// "/pbrMetallicRoughness/baseColorFactor/[0-3]", and the schema of what stands there.
void for_each_place_below(const Schema& schema, FieldSchemas& schemas,
                          const std::function<void(const std::string& pattern, const Json& value)>& visit);

/// Text as a regular expression that matches it alone.
[[nodiscard]] std::string quoted_pattern(std::string_view text);

}  // namespace relook
