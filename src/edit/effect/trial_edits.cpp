#include "edit/effect/trial_edits.h"

#include "base/error.h"
#include "edit/transaction.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

class Trials {
 public:
  Trials(SceneState& state, std::string_view file, const std::function<bool(const SceneDelta&)>& is_wanted)
      : state_(state), file_(file), is_wanted_(is_wanted), counts_(state.slot_counts()) {}

  void walk(Tokens& tokens, const Json& value) {
    if (value.is_structured()) {
      for (const auto& [key, below] : value.items()) {
        tokens.push_back(key);
        walk(tokens, below);
        tokens.pop_back();
      }
      return;
    }
    for (Json& other : others(value))
      if (try_value(tokens, std::move(other))) return;
  }

 private:
  /// Values that may stand in place of one, the likeliest first: a smaller or a larger number, an image, a texture.
  [[nodiscard]] std::vector<Json> others(const Json& value) const {
    if (value.is_null()) return {1.0};
    if (value.is_number()) {
      const auto number = value.get<double>();
      return number == 0 ? std::vector<Json>{0.5, 1e-3} : std::vector<Json>{number / 2, number * 2};
    }
    std::vector<Json> names;
    if (!value.is_string()) return names;
    for (const char* section : {"images", "textures"})
      for (const auto& [name, entry] : state_.document().look.at(section).items())
        if (name != value.get_ref<const std::string&>()) {
          names.emplace_back(name);
          break;
        }
    return names;
  }

  bool try_value(const Tokens& tokens, Json value) {
    PatchOperation operation;
    operation.path = pointer_text(tokens);
    operation.value = std::move(value);
    Transaction transaction(state_, file_, {});
    SceneDelta delta;
    try {
      delta = transaction.apply({std::move(operation)});
    } catch (const InputError&) {
      return false;  // out of range, say
    }
    const bool wanted = is_wanted_(delta);
    transaction.undo();
    state_.drop_slots_after(counts_);
    return wanted;
  }

  SceneState& state_;
  std::string_view file_;
  const std::function<bool(const SceneDelta&)>& is_wanted_;
  const SlotCounts counts_;
};

}  // namespace

void try_edits(SceneState& state, std::string_view file, const std::string& pointer,
               const std::function<bool(const SceneDelta&)>& is_wanted) {
  Tokens tokens = split_pointer(pointer, file, pointer);
  const std::optional<Section> section = tokens.size() > 1 ? section_of(tokens[0]) : std::nullopt;
  if (section) tokens[1] = resolve_token(state.document(), *section, tokens[1]);
  const Json value = value_at(state.editable_document().look, tokens, {file, pointer});
  Trials(state, file, is_wanted).walk(tokens, value);
}

}  // namespace relook
