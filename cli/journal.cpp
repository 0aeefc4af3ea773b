// `relook journal`: journals made from what a scene has to say. Each is parsed and rehearsed on the scene like any
// other before it is written.
#include <algorithm>
#include <filesystem>
#include <tuple>

#include "edit/apply.h"
#include "edit/draft/draft_diff.h"
#include "edit/draft/draft_moves.h"
#include "edit/draft/draft_rig.h"
#include "input/open_look.h"
#include "options/outputs.h"
#include "scene/gltf/animation.h"
#include "verbs.h"

namespace relook {
namespace {

/// The animation that --animation names or counts; without it the only or first one, with a warning.
Animation choose_animation(const Arguments& arguments, Console& console) {
  const std::string &scene = arguments.inputs[0], &choice = arguments.animation;
  if (is_cache_folder(scene)) throw InputError(scene, "", "a cache holds no animations; give the scene that it is of");
  std::vector<Animation> animations = import_animations(scene);
  if (animations.empty()) throw InputError(scene, "", "the scene has no animations");
  std::vector<std::string> names;
  for (const Animation& animation : animations) names.push_back(animation.name);
  std::size_t chosen = 0;
  if (!choice.empty()) {
    const auto found = std::find(names.begin(), names.end(), choice);
    chosen = static_cast<std::size_t>(found - names.begin());
    for (std::size_t i = 0; i < names.size() && found == names.end(); ++i)
      if (choice == std::to_string(i)) chosen = i;
  } else if (names.size() > 1) {
    console.warn({"the scene has " + std::to_string(names.size()) + " animations: \"" + names[0] +
                  "\" is used; --animation NAME chooses another"});
  }
  if (chosen == names.size()) {
    const std::string near = nearest_name(choice, names);
    throw InputError(scene, "",
                     "no animation \"" + choice + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }
  return std::move(animations[chosen]);
}

/// Throws InputError when the scenes are seen by different cameras of their own: no journal moves a camera.
void require_one_camera(const Arguments& arguments, const Camera& before, const Camera& after) {
  // The shape of a cache's image is its own.
  const bool has_shape = !is_cache_folder(arguments.inputs[0]) && !is_cache_folder(arguments.inputs[1]);
  const auto view = [&](const Camera& camera) {
    return std::tuple(camera.node, camera.orthographic, camera.eye, camera.right, camera.up, camera.forward,
                      has_shape ? camera.half_width : 0, has_shape ? camera.half_height : 0, camera.near, camera.far);
  };
  if ((!before.node.empty() || !after.node.empty()) && view(before) != view(after))
    throw InputError(arguments.inputs[1], "",
                     "camera \"" + after.name + "\" is not as in " + arguments.inputs[0] +
                         ", which no journal can say; another may be chosen with --camera");
}

DiffDraft make_diff(const Arguments& arguments, const SceneState& before, Console& console) {
  const SceneState after = open_look_state(arguments.inputs[1], arguments, console);
  const Camera& camera = after.scene().camera;
  require_one_camera(arguments, before.scene().camera, camera);
  const std::filesystem::path journal(arguments.output);
  return draft_diff(before.document(), after.document(), journal.stem().string() + ".files");
}

DiffDraft make_draft(const Arguments& arguments, const SceneState& state, Console& console) {
  switch (arguments.journal_source) {
    case JournalSource::diff:
      return make_diff(arguments, state, console);
    case JournalSource::variants:
      return {draft_variants(state.document()), {}};
    case JournalSource::animation:
      return {draft_animation(state, choose_animation(arguments, console), arguments.sample_times), {}};
    case JournalSource::turntable:
      return {draft_turntable(state.document(), arguments.inputs[1], arguments.turntable), {}};
    case JournalSource::aim:
      return {
          draft_aim(state.document(), state.scene().camera, arguments.inputs[1], arguments.inputs[2], arguments.aim),
          {}};
    case JournalSource::rig:
      return {draft_rig(state.document(), state.scene().camera, arguments.rig), {}};
    case JournalSource::wedge:
      break;
  }
  return {draft_wedge(arguments.inputs[1], {arguments.inputs.begin() + 2, arguments.inputs.end()}), {}};
}

/// Writes the files that a journal brings in. Those that were not there before are removed again unless keep() is
/// called.
class BroughtFiles {
 public:
  BroughtFiles() = default;
  ~BroughtFiles() {
    std::error_code ignored;
    for (auto path = written_.rbegin(); path != written_.rend(); ++path) std::filesystem::remove(*path, ignored);
  }
  BroughtFiles(const BroughtFiles&) = delete;
  BroughtFiles& operator=(const BroughtFiles&) = delete;
  void bring(const std::vector<DraftFile>& files, const std::filesystem::path& folder) {
    for (const DraftFile& file : files) {
      const std::filesystem::path path = folder / file.name;
      if (std::filesystem::exists(path)) continue;  // named after its content
      if (!std::filesystem::exists(path.parent_path())) written_.push_back(path.parent_path());
      make_folders(path.parent_path());
      written_.push_back(path);
      write_file(path, *file.bytes);
    }
  }
  void keep() { written_.clear(); }

 private:
  std::vector<std::filesystem::path> written_;
};

}  // namespace

ExitCode run_journal(const Arguments& arguments, Console& console) {
  SceneState state = open_look_state(arguments.inputs[0], arguments, console);
  const auto [draft, files] = make_draft(arguments, state, console);
  console.warn(draft.warnings);
  const std::string text = journal_text(draft);
  const Journal journal = parse_journal(text, arguments.output);
  BroughtFiles brought;
  brought.bring(files, journal.path.parent_path());
  static_cast<void>(check_journal(state, journal));  // a step that changes nothing is as the scene has it
  if (arguments.journal_source == JournalSource::animation && !changes_scene(state, journal))
    throw InputError(arguments.inputs[0], "", "the animation moves nothing that the scene shows");
  write_file(arguments.output, text);
  brought.keep();
  const std::size_t frames = frame_count(journal);
  console.line(arguments.output + ": " + std::to_string(journal.steps.size()) + " steps, " + std::to_string(frames) +
               " frames");
  Json warnings = Json::array();
  for (const std::string& warning : draft.warnings) warnings.push_back(printable(warning));
  console.json({{"journal", arguments.output},
                {"hash", journal.hash},
                {"steps", journal.steps.size()},
                {"frames", frames},
                {"warnings", std::move(warnings)}});
  return ExitCode::ok;
}

}  // namespace relook
