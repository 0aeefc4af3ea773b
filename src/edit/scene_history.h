// The states of a scene along a journal, so that a step may start from the state after an earlier one (`from`), and a
// wedge or drag be put back (`keep`). What is kept of a state is the entries of the look document that differ from
// those of the state it came from; to go back is to give those their values that differ, so that its price follows from
// the edits between. Where no step ever goes back nothing is kept. All who apply a journal's edits do it through
// apply_event().
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "edit/apply.h"
#include "edit/journal_walk.h"
#include "edit/transaction.h"

namespace relook {

class SceneHistory {
 public:
  explicit SceneHistory(const Journal& journal);

  /// What a document's entries are in the state after a step (0: before any), of those that may be another now.
  /// Requires: a step of the journal goes back there.
  [[nodiscard]] EntryValues values_at(std::uint32_t step, const LookDocument& document) const;

  /// To be told what has been done, in the order of the walk: that the scene went back to the state after a step;
  void went_back(std::uint32_t step);
  /// what a transaction changed;
  void note(const Transaction& transaction);
  /// that the last frame of a step is done.
  void end_step(std::uint32_t step, const LookDocument& document);

 private:
  struct State {
    std::uint32_t parent = 0;
    std::map<TouchedEntity, std::optional<Json>> values;  // of what was touched since the parent; none: no such entry
  };
  [[nodiscard]] const std::optional<Json>& value_at(std::uint32_t step, const TouchedEntity& entity) const;

  std::set<std::uint32_t> wanted_;  // states that steps go back to
  std::map<std::uint32_t, State> states_;
  std::map<TouchedEntity, std::optional<Json>> base_;  // of all that was ever touched: before any step
  std::uint32_t last_ = 0;                             // the last state of states_ that the scene came from; 0: base
  std::set<TouchedEntity> touched_;                    // since then
};

/// What was done to a scene.
struct EditedScene {
  SceneDelta delta;
  Classification classification;  // of the last edit, from the state that it was made in
};
/// Edits a scene and says what that was. Throws InputError with the scene as before.
using SceneEdit = std::function<EditedScene(SceneState&)>;
/// apply_edit() of a patch. Refers to it.
[[nodiscard]] SceneEdit scene_edit(const Edit& edit, std::string_view file, std::filesystem::path folder);

/// Takes the scene back to where an event's step starts, if that is not where it is. Nothing for other events.
SceneDelta go_back(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history);
/// Makes the edit of an event of kind edit or drag, from where its step starts.
EditedScene make_edit(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history);
/// Both.
EditedScene apply_event(SceneState& state, const Journal& journal, const JournalEvent& event, SceneHistory& history);

/// Two changes, one after the other, as one. `after`: the scene with both.
[[nodiscard]] SceneDelta merged(SceneDelta first, SceneDelta second, const Scene& after);

}  // namespace relook
