#include "edit/scene_history.h"

#include <algorithm>

namespace relook {
namespace {

/// Adds the changes of `second` to those of `first`, by id, and drops those that come to nothing.
template <class Change, class Value>
void merge_changes(std::vector<Change>& first, std::vector<Change>&& second, const std::vector<Value>& values) {
  for (Change& change : second)
    if (std::ranges::find(first, change.id, &Change::id) == first.end()) first.push_back(std::move(change));
  std::erase_if(first, [&](const Change& change) { return change.before == values[change.id.index()]; });
}

template <class Value>
void merge_value(std::optional<Value>& first, std::optional<Value>&& second, const Value& now) {
  if (!first) first = std::move(second);
  if (first && *first == now) first.reset();
}

}  // namespace

SceneDelta merged(SceneDelta first, SceneDelta second, const Scene& after) {
  if (first.empty()) return second;
  if (second.empty()) return first;
  merge_changes(first.materials, std::move(second.materials), after.materials);
  merge_changes(first.objects, std::move(second.objects), after.objects);
  merge_changes(first.lights, std::move(second.lights), after.lights);
  merge_value(first.ambient_before, std::move(second.ambient_before), after.ambient);
  merge_value(first.environment_before, std::move(second.environment_before), after.environment);
  return first;
}

SceneHistory::SceneHistory(const Journal& journal) {
  for (std::uint32_t step = 1; step <= journal.steps.size(); ++step)
    if (const std::uint32_t start = state_before(journal, step); start + 1 != step) wanted_.insert(start);
}

const std::optional<Json>& SceneHistory::value_at(std::uint32_t step, const TouchedEntity& entity) const {
  for (; step != 0; step = states_.at(step).parent) {
    const auto& values = states_.at(step).values;
    if (const auto found = values.find(entity); found != values.end()) return found->second;
  }
  return base_.at(entity);
}

EntryValues SceneHistory::values_at(std::uint32_t step, const LookDocument& document) const {
  std::set<TouchedEntity> entities = touched_;
  for (std::uint32_t end : {last_, step})
    for (; end != 0; end = states_.at(end).parent)
      for (const auto& [entity, value] : states_.at(end).values) entities.insert(entity);
  EntryValues values;
  for (const TouchedEntity& entity : entities) {
    const std::optional<Json>& wanted = value_at(step, entity);
    const Json* now = find_entry(document.look, entity);
    if (now == nullptr ? !wanted.has_value() : wanted.has_value() && *now == *wanted) continue;
    values.emplace_back(entity, wanted);
  }
  return values;
}

void SceneHistory::went_back(std::uint32_t step) {
  last_ = step;
  touched_.clear();
}

void SceneHistory::note(const Transaction& transaction) {
  if (wanted_.empty()) return;
  transaction.visit_touched([&](const TouchedEntity& entity, const Json* before) {
    touched_.insert(entity);
    base_.try_emplace(entity, before == nullptr ? std::nullopt : std::optional<Json>(*before));
  });
}

void SceneHistory::end_step(std::uint32_t step, const LookDocument& document) {
  if (!wanted_.contains(step)) return;
  State& state = states_[step];
  state.parent = last_;
  for (const TouchedEntity& entity : touched_) {
    const Json* now = find_entry(document.look, entity);
    state.values[entity] = now == nullptr ? std::nullopt : std::optional<Json>(*now);
  }
  went_back(step);
}

SceneEdit scene_edit(const Edit& edit, std::string_view file, std::filesystem::path folder) {
  return [&edit, file, folder = std::move(folder)](SceneState& state) {
    EditedScene edited{apply_edit(state, edit, file, folder), {}};
    edited.classification = classify(state.scene(), edited.delta);
    return edited;
  };
}

SceneDelta go_back(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history) {
  if (!event.back_to) return {};
  Transaction transaction(state, journal.file, journal.path.parent_path());
  SceneDelta delta = transaction.restore(history.values_at(*event.back_to, state.document()));
  history.went_back(*event.back_to);
  return delta;
}

EditedScene make_edit(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history) {
  Transaction transaction(state, journal.file, journal.path.parent_path());
  EditedScene edited;
  edited.delta = transaction.apply(event.edit());
  history.note(transaction);
  if (event.is_last_frame()) history.end_step(event.place.step, state.document());
  edited.classification = classify(state.scene(), edited.delta);
  return edited;
}

EditedScene apply_event(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history) {
  SceneDelta back = go_back(state, journal, event, history);
  EditedScene edited = make_edit(state, journal, event, history);
  edited.delta = merged(std::move(back), std::move(edited.delta), state.scene());
  return edited;
}

}  // namespace relook
