#include "edit/guide/field_schema.h"

namespace relook {
namespace {

constexpr std::string_view kItem = "/([0-9]+|-)";

Json array_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

class PlaceWalk {
 public:
  PlaceWalk(FieldSchemas& schemas, const std::function<void(const std::string&, const Json&)>& visit)
      : schemas_(schemas), visit_(visit) {}

  void object(const Schema& schema, const std::string& above) {
    for (const SchemaField& field : schema.fields) {
      const std::string at = above + "/" + std::string(field.key);
      visit_(at, schemas_.of_field(field));
      switch (field.kind) {
        case FieldKind::reals:
          visit_(at + (field.count > 0 && field.count <= 10 ? "/[0-" + std::to_string(field.count - 1) + "]"
                                                            : std::string("/[0-9]+")),
                 number_schema(field));
          break;
        case FieldKind::texts:
        case FieldKind::names:
          visit_(at + std::string(kItem), schemas_.of_field(field).at("items"));
          break;
        case FieldKind::object:
          object(*field.inner, at);
          break;
        case FieldKind::list:
          visit_(at + std::string(kItem), schemas_.of_object(field.key, *field.inner));
          object(*field.inner, at + std::string(kItem));
          break;
        default:
          break;
      }
    }
  }

 private:
  FieldSchemas& schemas_;
  const std::function<void(const std::string&, const Json&)>& visit_;
};

}  // namespace

Json number_schema(const SchemaField& field) {
  Json schema{{"type", field.kind == FieldKind::integer ? "integer" : "number"}};
  if (!field.codes.empty()) return {{"enum", field.codes}};
  if (field.low == kAboveZero)
    schema["exclusiveMinimum"] = 0;
  else if (field.low > -kCeiling)
    schema["minimum"] = field.low;
  if (field.high < kCeiling) schema["maximum"] = field.high;
  if (field.zero_too) return {{"anyOf", {{{"const", 0}}, std::move(schema)}}};
  return schema;
}

Json FieldSchemas::of_field(const SchemaField& field) {
  Json schema;
  switch (field.kind) {
    case FieldKind::number:
    case FieldKind::integer:
      schema = number_schema(field);
      break;
    case FieldKind::boolean:
      schema = {{"type", "boolean"}};
      break;
    case FieldKind::text:
      schema = {{"type", "string"}};
      break;
    case FieldKind::texts:
      schema = array_of({{"type", "string"}});
      break;
    case FieldKind::reals:
      schema = array_of(number_schema(field));
      if (field.count > 0) schema["minItems"] = schema["maxItems"] = field.count;
      break;
    case FieldKind::choice:
      schema = {{"enum", Json(field.choices)}};
      break;
    case FieldKind::name:
      schema = name_schema_(field.target);
      break;
    case FieldKind::names:
      schema = array_of(name_schema_(field.target));
      break;
    case FieldKind::object:
      schema = of_object(field.key, *field.inner);
      break;
    case FieldKind::list:
      schema = array_of(of_object(field.key, *field.inner));
      break;
  }
  if (field.nullable) return {{"anyOf", {{{"type", "null"}}, std::move(schema)}}};
  return schema;
}

Json FieldSchemas::of_object(std::string_view name, const Schema& schema, const Json& extra) {
  Json body{{"type", "object"}, {"additionalProperties", false}, {"properties", extra}};
  Json required = Json::array();
  for (const SchemaField& field : schema.fields) {
    body["properties"][std::string(field.key)] = of_field(field);
    if (field.required) required.push_back(field.key);
  }
  if (!required.empty() && extra.empty()) body["required"] = std::move(required);
  std::string key(name);
  for (int i = 2; definitions_.contains(key) && definitions_[key] != body; ++i)
    key = std::string(name) + std::to_string(i);
  definitions_[key] = std::move(body);
  return {{"$ref", "#/$defs/" + key}};
}

void for_each_place_below(const Schema& schema, FieldSchemas& schemas,
                          const std::function<void(const std::string&, const Json&)>& visit) {
  PlaceWalk(schemas, visit).object(schema, "");
}

std::string quoted_pattern(std::string_view text) {
  std::string pattern;
  for (const char c : text) {
    if (std::string_view(R"(\^$.|?*+()[]{}/-)").find(c) != std::string_view::npos && c != '/' && c != '-')
      pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace relook
