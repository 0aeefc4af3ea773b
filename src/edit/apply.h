// Applies edits to a scene state: patch in place with undo of what was touched, recompile what was touched, classify.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "edit/journal.h"
#include "scene/compile/state.h"

namespace relook {

enum class ChangeClass : std::uint8_t { base, color, optical, geometric, mixed };
[[nodiscard]] std::string_view change_class_name(ChangeClass change);

/// The class of a step (Table 1 of the paper), and why it has it.
struct Classification {
  ChangeClass change = ChangeClass::color;
  std::vector<std::string>
      reasons;  // one sentence per changed entity: "material Glass: index of refraction 1.5 -> 1.8"
};

/// The class of two edits together, by the rule of classify(). A drag or a wedge as a whole has that of all its frames.
[[nodiscard]] ChangeClass combined(ChangeClass a, ChangeClass b);

/// The class follows from the values before and after alone. A delta that changes nothing is `color`. A delta with an
/// optical and a geometric change is `mixed`; every other has the strongest class of its changes, color < optical <
/// geometric.
[[nodiscard]] Classification classify(const Scene& after, const SceneDelta& delta);

/// Applies one edit atomically. On any error the state is as before and InputError{file, where + "/path", ...} is
/// thrown. `folder`: where {"asset": ...} and image uris are resolved. The node of the active camera may not be edited,
/// and its ancestors may not be moved, hidden or removed.
SceneDelta apply_edit(SceneState& state, const Edit& edit, std::string_view file, const std::filesystem::path& folder);

/// A drag's entry may only touch nodes of the step's selection and their descendants, and may not add or remove nodes.
/// Throws InputError.
void check_drag_scope(const SceneState& state, const JournalStep& step, std::size_t entry, std::string_view file);

/// Rehearses all steps of a journal and takes them back, so that a wrong journal is refused before anything is written.
/// Throws InputErrors that name the wrong steps, 20 at most. Returns warnings: steps that change no value of the scene,
/// guards (only "test") aside; a drag or a wedge when none of its entries does. The state is as before either way, ids
/// included. Its price follows from the edits. Call it before anything holds on to the scene's assets.
[[nodiscard]] std::vector<std::string> check_journal(SceneState& state, const Journal& journal);

/// Does a step of a journal that passed check_journal() change any value of the scene? Rehearses it, too.
[[nodiscard]] bool changes_scene(SceneState& state, const Journal& journal);

/// Does a step of a journal that passed check_journal() change rays or what they meet (optical, geometric)? Rehearses
/// it, too.
[[nodiscard]] bool shoots_rays(SceneState& state, const Journal& journal);

}  // namespace relook
