// The walks over look_schema.h's tables, along a value: cut, fill, visit names, check. Their depth is that of the
// tables, never that of the data.
#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/look/json_place.h"
#include "scene/look/look_hints.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 10> kNouns{"material", "texture", "image", "sampler", "mesh",
                                                  "light",    "node",    "skin",  "camera",  "variant"};

const SchemaField* find_field(const Schema& schema, std::string_view key) {
  for (const SchemaField& field : schema.fields)
    if (field.key == key) return &field;
  return nullptr;
}

bool is_allowed(const SchemaField& field, double x) {
  if (!field.codes.empty()) return std::ranges::find(field.codes, x) != field.codes.end();
  return (x >= field.low && x <= field.high) || (field.zero_too && x == 0);
}

/// A limit as the number a person would write: 1, not 1.0.
Json short_limit(double x) {
  if (std::floor(x) == x && std::abs(x) < 1e15) return static_cast<std::int64_t>(x);
  return x;
}

std::string short_number(const Json& value) {
  const std::string text = value.dump();
  return text.size() > 24 ? text.substr(0, 24) + "..." : text;
}

/// Calls `visit` on the names of `value`, which may be const or not.
template <class Value, class Visit>
void walk_names(const Schema& schema, Value& value, const Visit& visit) {
  if (!value.is_object()) return;
  for (const SchemaField& field : schema.fields) {
    if (field.kind < FieldKind::name) continue;
    const auto found = value.find(field.key);
    if (found == value.end()) continue;
    Value& member = *found;
    if (field.kind == FieldKind::name) visit(field.target, member);
    if (field.kind == FieldKind::names && member.is_array())
      for (Value& item : member) visit(field.target, item);
    if (field.kind == FieldKind::object) walk_names(*field.inner, member, visit);
    if (field.kind == FieldKind::list && member.is_array())
      for (Value& item : member) walk_names(*field.inner, item, visit);
  }
}

std::vector<std::string> variant_names(const LookDocument& document) {
  const Json::json_pointer place("/extensions/KHR_materials_variants/variants");
  std::vector<std::string> names;
  if (!document.look.contains(place) || !document.look[place].is_array()) return names;
  for (const Json& item : document.look[place])
    if (item.is_string()) names.push_back(item);
  return names;
}

/// One check of one value; throws LookError at its place.
class Checker {
 public:
  Checker(const LookDocument& document, std::string_view file) : document_(document), file_(file) {}

  void object(const Schema& schema, const Json& value, const JsonPlace& place) const {
    if (!value.is_object()) fail(place, "expected an object, got " + std::string(type_noun(value)));
    std::size_t known = 0;
    for (const SchemaField& field : schema.fields) {
      const auto found = value.find(field.key);
      if (found != value.end()) {
        ++known;
        member(field, *found, {&place, field.key});
      } else if (field.required) {
        fail(place, "\"" + std::string(field.key) + "\" is missing");
      }
    }
    if (known < value.size()) unknown_key(schema, value, place);
  }

 private:
  [[noreturn]] void fail(const JsonPlace& place, const std::string& what) const {
    throw LookError(file_, place.text(), what);
  }

  [[noreturn]] void unknown_key(const Schema& schema, const Json& value, const JsonPlace& place) const {
    std::vector<std::string> known;
    for (const SchemaField& field : schema.fields) known.emplace_back(field.key);
    for (const auto& item : value.items()) {
      const std::string& key = item.key();
      if (find_field(schema, key) != nullptr) continue;
      const std::string near = nearest_name(key, known), deeper = deeper_place(schema, key);
      std::string hint = near.empty() ? "" : "; did you mean \"" + near + "\"?";
      if (!deeper.empty() && deeper != near) hint = "; did you mean " + place.text() + "/" + deeper + "?";
      throw LookError(file_, place.text() + "/" + escape_token(key), "unknown key \"" + key + "\"" + hint);
    }
    fail(place, "unknown key");
  }

  void member(const SchemaField& field, const Json& value, const JsonPlace& place) const {
    if (field.nullable && value.is_null()) return;
    switch (field.kind) {
      case FieldKind::number:
        number(field, value, place);
        break;
      case FieldKind::integer:
        if (!value.is_number_integer()) fail(place, "expected an integer, got " + std::string(type_noun(value)));
        number(field, value, place);
        break;
      case FieldKind::boolean:
        if (!value.is_boolean()) fail(place, "expected true or false, got " + std::string(type_noun(value)));
        break;
      case FieldKind::text:
        text(value, place);
        break;
      case FieldKind::texts:
        each(value, place, [&](const Json& item, const JsonPlace& at) { text(item, at); });
        break;
      case FieldKind::reals:
        reals(field, value, place);
        break;
      case FieldKind::choice:
        choice(field, value, place);
        break;
      case FieldKind::name:
        name(field.target, value, place);
        break;
      case FieldKind::names:
        each(value, place, [&](const Json& item, const JsonPlace& at) { name(field.target, item, at); });
        break;
      case FieldKind::object:
        object(*field.inner, value, place);
        break;
      case FieldKind::list:
        each(value, place, [&](const Json& item, const JsonPlace& at) { object(*field.inner, item, at); });
        break;
    }
  }

  template <class Body>
  void each(const Json& value, const JsonPlace& place, const Body& body) const {
    if (!value.is_array()) fail(place, "expected an array, got " + std::string(type_noun(value)));
    for (std::size_t i = 0; i < value.size(); ++i) body(value[i], {&place, {}, i});
  }

  void text(const Json& value, const JsonPlace& place) const {
    if (!value.is_string()) fail(place, "expected a string, got " + std::string(type_noun(value)));
  }

  void number(const SchemaField& field, const Json& value, const JsonPlace& place) const {
    if (!value.is_number()) fail(place, "expected a number, got " + std::string(type_noun(value)));
    if (!is_allowed(field, value.get<double>())) fail(place, range_fault(field, value) + value_hint(field, value));
  }

  void reals(const SchemaField& field, const Json& value, const JsonPlace& place) const {
    if (field.count == 0 && !value.is_array())
      fail(place, "expected an array of numbers, got " + std::string(type_noun(value)));
    if (field.count != 0 && (!value.is_array() || value.size() != field.count))
      fail(place, "expected an array of " + std::to_string(field.count) + " numbers, got " +
                      (value.is_array() ? std::to_string(value.size()) : std::string(type_noun(value))) +
                      value_hint(field, value));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const bool is_number = value[i].is_number();
      if (is_number && !is_allowed(field, value[i].get<double>()))
        fail({&place, {}, i}, range_fault(field, value[i]) + value_hint(field, value));
      number(field, value[i], {&place, {}, i});
    }
  }

  void choice(const SchemaField& field, const Json& value, const JsonPlace& place) const {
    text(value, place);
    const auto& word = value.get_ref<const std::string&>();
    if (std::find(field.choices.begin(), field.choices.end(), word) != field.choices.end()) return;
    const std::string near = nearest_name(word, field.choices);
    std::string known;
    for (std::string_view option : field.choices) known += (known.empty() ? "" : ", ") + std::string(option);
    fail(place, "\"" + word + "\" is not one of " + known + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }

  void name(Target target, const Json& value, const JsonPlace& place) const {
    if (value.is_number_unsigned())
      fail(place, "there is no " + std::string(target_noun(target)) + " of index " + short_number(value));
    if (!value.is_string())
      fail(place,
           "expected the name of a " + std::string(target_noun(target)) + ", got " + std::string(type_noun(value)));
    const auto& word = value.get_ref<const std::string&>();
    if (target == Target::variants ? is_variant(word) : name_exists(document_, target, word)) return;
    LookError error(file_, place.text(), missing_name(document_, target, word));
    if (target < Target::cameras)
      error.missing = "/" + std::string(section_name(static_cast<Section>(target))) + "/" + escape_token(word);
    throw error;
  }

  /// A primitive may map many variants, each of which is looked up: so the document's names are sorted once.
  [[nodiscard]] bool is_variant(const std::string& word) const {
    if (!variants_) {
      variants_ = variant_names(document_);
      std::ranges::sort(*variants_);
    }
    return std::ranges::binary_search(*variants_, word);
  }

  const LookDocument& document_;
  std::string_view file_;
  mutable std::optional<std::vector<std::string>> variants_;  // sorted
};

const Json* names_of(const LookDocument& document, Target target) {
  if (target == Target::cameras) return &document.cameras;
  if (target == Target::variants) return nullptr;
  const auto section = document.look.find(section_name(static_cast<Section>(target)));
  return section == document.look.end() || !section->is_object() ? nullptr : &*section;
}

}  // namespace

std::optional<double> fitted(const SchemaField& field, double x) {
  if (is_allowed(field, x)) return x;
  if (!std::isfinite(x) || !field.codes.empty()) return {};
  const bool is_above = x > field.high;
  if (!is_above && field.low == kAboveZero) return x > 0 ? std::optional(kAboveZero) : std::nullopt;
  const double bound = is_above ? field.high : field.low;
  constexpr double kRounding = 1e-6;
  const bool is_of_gltf = std::abs(bound) < kCeiling;
  if (is_of_gltf && std::abs(x - bound) > kRounding * std::max(1.0, std::abs(bound))) return {};
  return bound;
}

std::string range_fault(const SchemaField& field, const Json& number) {
  const auto x = number.get<double>();
  if (!std::isfinite(x)) return "expected a finite number";
  std::string fault = short_number(number);
  if (!field.codes.empty()) {
    fault += " is not one of";
    for (const int code : field.codes) fault += (code == field.codes.front() ? " " : ", ") + std::to_string(code);
    return fault;
  }
  if (x > field.high) return fault + " is above " + short_number(short_limit(field.high));
  if (field.low == kAboveZero) return fault + " is not above 0";
  return fault + " is below " + short_number(short_limit(field.low)) + (field.zero_too ? " and not 0" : "");
}

std::string_view target_noun(Target target) { return kNouns[static_cast<std::size_t>(target)]; }

std::string_view type_noun(const Json& value) {
  if (value.is_number()) return "a number";
  if (value.is_string()) return "a string";
  if (value.is_boolean()) return "a boolean";
  if (value.is_array()) return "an array";
  if (value.is_object()) return "an object";
  return "null";
}

void drop_unknown(const Schema& schema, Json& value) {
  if (!value.is_object()) return;
  for (auto member = value.begin(); member != value.end();) {
    const SchemaField* field = find_field(schema, member.key());
    // Foreign extras may be of any type.
    if (field == nullptr || (field->key == "extras" && !member->is_object())) {
      member = value.erase(member);
      continue;
    }
    if (field->kind == FieldKind::object) drop_unknown(*field->inner, *member);
    if (field->kind == FieldKind::list && member->is_array())
      for (Json& item : *member) drop_unknown(*field->inner, item);
    ++member;
  }
}

void fill_from_schema(const Schema& schema, Json& value) {
  if (!value.is_object()) return;
  for (const SchemaField& field : schema.fields) {
    auto member = value.find(field.key);
    if (member == value.end() && (field.implied || !field.fallback.is_null()))
      member = value.emplace(std::string(field.key), field.implied ? Json::object() : field.fallback).first;
    if (member == value.end()) continue;
    if (field.kind == FieldKind::object) fill_from_schema(*field.inner, *member);
    if (field.kind == FieldKind::list && member->is_array())
      for (Json& item : *member) fill_from_schema(*field.inner, item);
  }
}

const SchemaField* field_at(const Schema& schema, std::span<const std::string> tokens) {
  const SchemaField* field = nullptr;
  const Schema* level = &schema;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    field = level == nullptr ? nullptr : find_field(*level, tokens[i]);
    if (field == nullptr) return nullptr;
    if (field->kind == FieldKind::list) ++i;  // the fields of its items lie below an index
    level = field->inner;
  }
  return field;
}

void visit_names(const Schema& schema, Json& value, const std::function<void(Target, Json&)>& visit) {
  walk_names(schema, value, visit);
}
void visit_names(const Schema& schema, const Json& value, const std::function<void(Target, const Json&)>& visit) {
  walk_names(schema, value, visit);
}

void check_against_schema(const Schema& schema, const Json& value, const LookDocument& document, std::string_view file,
                          const std::string& pointer) {
  Checker(document, file).object(schema, value, {nullptr, pointer});
}

bool name_exists(const LookDocument& document, Target target, std::string_view name) {
  if (target == Target::variants) {
    const std::vector<std::string> names = variant_names(document);
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  const Json* names = names_of(document, target);
  return names != nullptr && names->contains(name);
}

std::string missing_name(const LookDocument& document, Target target, std::string_view name) {
  std::vector<std::string> candidates;
  if (target == Target::variants)
    candidates = variant_names(document);
  else if (const Json* names = names_of(document, target))
    for (const auto& item : names->items()) candidates.push_back(item.key());
  const std::string near = nearest_name(name, candidates);
  return "no " + std::string(target_noun(target)) + " \"" + std::string(name) + "\"" +
         (near.empty() ? "" : "; did you mean \"" + near + "\"?");
}

}  // namespace relook
