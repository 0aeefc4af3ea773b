#include "edit/guide/usual_class.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error.h"
#include "edit/apply.h"
#include "edit/transaction.h"
#include "scene/look/look_check.h"

namespace relook {
namespace {

enum class Step : std::uint8_t { small, large };

double other_number(const SchemaField& field, double x, Step step) {
  const double low = std::max(field.low, -1e6), high = std::min(field.high, 1e6);
  if (x == 0) {
    const double wanted = step == Step::small ? 1e-3 : 0.5;
    return wanted >= low && wanted <= high ? wanted : low + (high - low) / 2;
  }
  const double wanted = step == Step::small ? x * 0.99 : x / 2;
  return wanted >= low && wanted <= high ? wanted : x * (step == Step::small ? 1.01 : 2);
}

Json other_reals(const SchemaField& field, const Json& value, Step step) {
  Json other = value;
  const double shift = step == Step::small ? 1e-3 : 0.1;
  if (field.key == "matrix") {
    other[12] = other[12].get<double>() + shift;
    return other;
  }
  for (Json& x : other) {
    const double was = x.get<double>();
    const bool is_place = field.key == "translation" || field.key == "rotation" || field.count == 0;
    x = is_place ? was + shift : other_number(field, was, step);
  }
  return other;
}

/// Names of the section that a field refers to, other than `value`: the first of them.
void add_other_name(const LookDocument& document, const SchemaField& field, const Json* value,
                    std::vector<Json>& values) {
  if (field.target >= Target::cameras) return;
  const Json& section = document.look.at(std::string(section_name(static_cast<Section>(field.target))));
  for (const auto& [name, entity] : section.items()) {
    if (value != nullptr && *value == name) continue;
    values.emplace_back(name);
    if (values.size() >= 3) return;
  }
}

/// Values to try in place of one, the likeliest first.
std::vector<Json> other_values(const LookDocument& document, const LookPath& path, Step step) {
  const SchemaField& field = path.field;
  std::vector<Json> values;
  switch (field.kind) {
    case FieldKind::number:
      if (path.value != nullptr)
        values = {other_number(field, path.value->get<double>(), step)};
      else
        values = {step == Step::small ? 0.1 : 0.5, 5000.0};
      break;
    case FieldKind::integer:
      if (!field.codes.empty())
        for (const int code : field.codes) values.emplace_back(code);
      else
        values = {path.value == nullptr ? 1 : path.value->get<int>() + 1, field.low};
      break;
    case FieldKind::boolean:
      values = {path.value == nullptr || !path.value->get<bool>()};
      break;
    case FieldKind::text:
      values = {"another"};
      break;
    case FieldKind::reals:
      if (path.value != nullptr) values = {other_reals(field, *path.value, step)};
      if (path.value == nullptr && field.count > 0) values = {Json(std::vector<double>(field.count, 0.5))};
      break;
    case FieldKind::choice:
      for (const std::string_view choice : field.choices) values.emplace_back(choice);
      break;
    case FieldKind::name:
      add_other_name(document, field, path.value, values);
      break;
    case FieldKind::names: {
      std::vector<Json> names;
      if (field.key == "excludes") add_other_name(document, field, nullptr, names);
      if (!names.empty()) values = {Json(names)};
      break;
    }
    case FieldKind::object:
      if (field.key == "mapping") values = {{{"kind", "spherical"}}};
      if (field.key == "background") values = {{{"color", {0.5, 0.5, 0.5}}}};
      break;
    case FieldKind::texts:
    case FieldKind::list:
      break;
  }
  std::erase_if(values, [&](const Json& other) { return path.value != nullptr && other == *path.value; });
  return values;
}

struct Outcome {
  bool is_taken = false;              // a value was
  std::optional<ChangeClass> change;  // of the first that changed something
};

Outcome try_step(SceneState& state, const LookPath& path, Step step) {
  Outcome outcome;
  const SlotCounts counts = state.slot_counts();
  for (Json& value : other_values(state.document(), path, step)) {
    PatchOperation operation;
    operation.path = path.pointer;
    operation.value = std::move(value);
    Transaction transaction(state, "", {});
    try {
      const SceneDelta delta = transaction.apply({std::move(operation)});
      outcome.is_taken = true;
      if (!delta.empty()) outcome.change = classify(state.scene(), delta).change;
    } catch (const InputError&) {
      continue;  // out of range, say, or the camera's
    }
    transaction.undo();
    state.drop_slots_after(counts);
    if (outcome.change) break;
  }
  return outcome;
}

}  // namespace

std::string usual_class(SceneState& state, const LookPath& path) {
  const bool has_steps = path.field.kind == FieldKind::number || path.field.kind == FieldKind::reals;
  const Outcome large = try_step(state, path, Step::large);
  const Outcome small = has_steps ? try_step(state, path, Step::small) : large;
  if (!large.is_taken && !small.is_taken) return "fixed";
  const std::optional<ChangeClass> usual = small.change ? small.change : large.change;
  if (!usual) return "no effect";
  const std::string name(change_class_name(*usual));
  if (!large.change || *large.change == *usual) return name;
  const std::string other(change_class_name(*large.change));
  return *usual == ChangeClass::color && *large.change == ChangeClass::optical ? "color, optical across a bucket"
                                                                               : name + ", larger ones " + other;
}

}  // namespace relook
