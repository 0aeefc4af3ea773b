// What a look document may contain, as tables: every key with its type, range, default and the section it refers to.
// One table serves all walks: checking the values of a glTF file (gltf/check/gltf_values.h), cutting them down to what
// is supported, filling defaults, checking an edited value, visiting the names it refers to, and finding the field of a
// pointer. glTF 2.0 section 5 and the KHR_* extensions; extras.relook.
#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "scene/look/look.h"
#include "scene/material_fields.h"

namespace relook {

/// From `name` on: kinds that are names or may have names inside.
enum class FieldKind : std::uint8_t { number, integer, boolean, text, texts, reals, choice, name, names, object, list };

/// What a name refers to; the first are those of Section, in its order.
enum class Target : std::uint8_t {
  materials,
  textures,
  images,
  samplers,
  meshes,
  lights,
  nodes,
  skins,
  cameras,
  variants
};
[[nodiscard]] std::string_view target_noun(Target target);  // "material"

struct Schema;
struct SchemaField {
  std::string_view key;
  FieldKind kind = FieldKind::number;
  Json fallback = {};                          // null: absent until set
  double low = 0, high = 0;                    // number, integer, reals
  bool zero_too = false;                       // number: 0 is allowed, too, though it is below `low`
  std::vector<int> codes = {};                 // integer: one of these; empty: any from low to high
  std::size_t count = 0;                       // reals; 0: any number of them
  const Schema* inner = nullptr;               // object, list
  Target target = Target::materials;           // name, names
  std::vector<std::string_view> choices = {};  // choice
  bool required = false;
  bool implied = false;  // object: created with its defaults when absent
  // Its default cannot be written (an infinity) or depends on the mesh (a mapping), so documents omit it. An edit's
  // "replace" takes it as there all the same, as it does every other member with a default.
  bool unwritten = false;
  bool nullable = false;  // null stands for its absence
};
struct Schema {
  std::vector<SchemaField> fields;
};

[[nodiscard]] const Schema& schema_of(Section section);
[[nodiscard]] const Schema& scene_schema();       // /scene
[[nodiscard]] const Schema& extensions_schema();  // /extensions
[[nodiscard]] const Schema& camera_schema();      // an entry of glTF's cameras
/// A light of a file, by the extension that has it. Those of documents have all members of both.
[[nodiscard]] const Schema& punctual_light_schema();
[[nodiscard]] const Schema& area_light_schema();
/// The schema of materials with other fields than those of schema_of(Section::materials). `parts` takes the schemas of
/// inner objects.
[[nodiscard]] Schema material_schema(std::span<const MaterialRow> rows, std::deque<Schema>& parts);
/// A material of a file: with what is converted before it becomes one of a look document.
[[nodiscard]] const Schema& file_material_schema();

/// A number field with this lower bound must be above zero.
inline constexpr double kAboveZero = 1e-30;
/// Bounds of numbers for which glTF has none: what a float holds, or, where products of a few must stay finite, less.
inline constexpr double kUnbounded = 3.4028234663852886e38;
inline constexpr double kCeiling = 1e12;
/// The bound of numbers that are relook's own (extras.relook). A file that exceeds it is wrong as with a bound of glTF.
inline constexpr double kOwnCeiling = 1e6;

/// The number that `x` stands for in a number or reals field: itself where it is allowed; the bound where only rounding
/// (1e-6 of it, or of 1) puts `x` beyond, or where the bound is kCeiling or kUnbounded and so not glTF's; none
/// otherwise.
[[nodiscard]] std::optional<double> fitted(const SchemaField& field, double x);
/// "1.5 is above 1"; requires an `x` that the field does not allow.
[[nodiscard]] std::string range_fault(const SchemaField& field, const Json& x);

/// Removes, at every level, the keys that the schema does not know. Values of a wrong type stay.
void drop_unknown(const Schema& schema, Json& value);
/// Adds the defaults that are missing. Values of a wrong type stay.
void fill_from_schema(const Schema& schema, Json& value);
/// Calls `visit` with every name (or glTF index) that the value refers to.
void visit_names(const Schema& schema, Json& value, const std::function<void(Target, Json&)>& visit);
void visit_names(const Schema& schema, const Json& value, const std::function<void(Target, const Json&)>& visit);

/// The field that a JSON pointer's tokens lead to below `schema`; null if it knows none.
[[nodiscard]] const SchemaField* field_at(const Schema& schema, std::span<const std::string> tokens);

/// A wrong value of a look document; knows its place so that a journal's reader can name its own.
struct LookError : InputError {
  LookError(std::string_view file, std::string_view at, std::string_view why)
      : InputError(file, at, why), pointer(at), reason(why) {}
  std::string pointer, reason;
  std::string missing;  // pointer to the entry that the value names and that does not exist; "" for other errors
};

/// Checks types, ranges, unknown keys, and that every name exists in `document`. Throws LookError{file, pointer, ...}.
void check_against_schema(const Schema& schema, const Json& value, const LookDocument& document, std::string_view file,
                          const std::string& pointer);

/// "no material \"Gould\"; did you mean \"Gold\"?"
[[nodiscard]] std::string missing_name(const LookDocument& document, Target target, std::string_view name);
[[nodiscard]] bool name_exists(const LookDocument& document, Target target, std::string_view name);
/// "a string", "a number", ... for messages.
[[nodiscard]] std::string_view type_noun(const Json& value);

}  // namespace relook
