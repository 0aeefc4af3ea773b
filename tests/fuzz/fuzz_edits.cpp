// Look patches and journals on a fixed small scene. An edit that is accepted leaves the scene that a compilation from
// scratch gives; one that is refused, or only rehearsed, leaves everything as it was.
#include "edit/apply.h"
#include "edit/growth.h"
#include "edit/journal_walk.h"
#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "gltf_writer.h"
#include "look_fixture.h"
#include "report/edit_hashes.h"

namespace relook {
namespace {

constexpr std::size_t kMostPlayedFrames = 64;
const std::initializer_list<ExitCode> kCodes{ExitCode::bad_input, ExitCode::out_of_resources};

/// With files that edits may bring in: square.glb and, beside them, one that is none.
const std::filesystem::path& folder_of_edits() {
  static const FuzzFolder folder("edits");
  static const bool is_filled = [] {
    overwrite_file(folder.path() / "square.glb", bytes_of(square().glb()));
    overwrite_file(folder.path() / "broken.png", bytes_of("\x89PNG\r\n\x1a\n"));
    return true;
  }();
  static_cast<void>(is_filled);
  return folder.path();
}

struct StateNow {
  explicit StateNow(const SceneState& state) : look(state.document().look), scene(scene_text(state.scene())) {}
  bool operator==(const StateNow&) const = default;
  Json look;
  std::string scene;
};

void expect_as_from_scratch(const SceneState& state) {
  const SceneState again(state.document(), state.scene().camera, state.pyramids());
  expect(scene_text(again.scene()) == scene_text(state.scene()), "the scene is not as compiled from scratch");
}

/// Whether the edit was accepted.
bool apply(SceneState& state, const Edit& edit, const std::string& file) {
  const StateNow before(state);
  const bool is_accepted = is_answered(kCodes, [&] {
    const SceneDelta delta = apply_edit(state, edit, file, folder_of_edits());
    (void)classify(state.scene(), delta);
  });
  if (is_accepted)
    expect_as_from_scratch(state);
  else
    expect(StateNow(state) == before, "a refused edit left something behind");
  return is_accepted;
}

void play(SceneState& state, const Journal& journal) {
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    if (event.kind == EventKind::drag) check_drag_scope(state, *event.step, event.frame, journal.file);
    expect(apply(state, event.edit(), journal.file), "an edit of a journal that was found to be right is refused");
  });
}

}  // namespace

int fuzz_patch(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  is_answered(kCodes, [&] {
    const Edit edit = parse_patch(text_of(fuzz_bytes(data, size)), "patch.json");
    SceneState state = small_state();
    apply(state, edit, "patch.json");
  });
  return 0;
}

int fuzz_journal(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  is_answered(kCodes, [&] {
    const Journal journal = parse_journal(text_of(fuzz_bytes(data, size)), folder_of_edits() / "j.json");
    if (frame_count(journal) > kMostPlayedFrames) return;
    const EditHashes hashes(journal);
    SceneState state = small_state();
    const StateNow before(state);
    const bool is_right = is_answered(kCodes, [&] { (void)check_journal(state, journal); });
    expect(StateNow(state) == before, "the rehearsal of a journal left something behind");
    if (is_right) play(state, journal);
  });
  return 0;
}

}  // namespace relook
