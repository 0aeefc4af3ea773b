// `relook watch`: each new export of a scene becomes a step of a journal and a frame of a run. The scene as the journal
// leaves it is held against the export (edit/draft/draft_diff.h); the cache stays open, so that a step costs its edit.
// A command that was ended goes on: the journal says where it was.
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "base/parallel.h"
#include "cache/manifest.h"
#include "edit/apply.h"
#include "edit/draft/draft_diff.h"
#include "input/load_cache.h"
#include "input/watched_scene.h"
#include "options/named_files.h"
#include "options/outputs.h"
#include "report/own_file.h"
#include "report/run_source.h"
#include "run/cache_structures.h"
#include "run/journal_run.h"
#include "run/run_files.h"
#include "scene/look/counted_assets.h"
#include "verbs.h"

namespace relook {
namespace {

/// Tells the run's page how many entries there are, and that no more will come when it is gone.
class LiveNote {
 public:
  explicit LiveNote(std::filesystem::path folder) : file_(std::move(folder) / kLiveName) {}
  ~LiveNote() {
    const Uninterrupted to_the_end;
    try {
      if (entries_) write(false);
    } catch (const Error&) {  // the page goes on asking
    }
  }
  LiveNote(const LiveNote&) = delete;
  LiveNote& operator=(const LiveNote&) = delete;
  void set(std::size_t entries) {
    entries_ = entries;
    write(true);
  }

 private:
  void write(bool is_live) const {
    write_file(file_, "relook_live(" + std::to_string(*entries_) + ", " + (is_live ? "true" : "false") + ");\n");
  }

  std::filesystem::path file_;
  std::optional<std::size_t> entries_;
};

/// The arguments of the replay that a watch goes on with.
Arguments replay_arguments(const Arguments& given, const std::string& journal) {
  Arguments arguments = given;
  arguments.verb = Verb::replay;
  arguments.inputs = {given.cache, journal};
  arguments.json = false;
  return arguments;
}

void make_cache(const Arguments& given, Console& console) {
  std::error_code error;
  if (std::filesystem::exists(given.cache, error)) return;
  Arguments arguments = given;
  arguments.verb = Verb::preprocess;
  arguments.output = given.cache;
  (void)run_preprocess(arguments, console);
}

class Watch {
 public:
  Watch(const Arguments& given, Console& console)
      : given_(given),
        console_(console),
        journal_file_(journal_beside(given.output)),
        arguments_(replay_arguments(given, journal_file_.string())),
        previews_{display_view_of_environment(), given.exposure},
        view_(given.view),
        scene_(given.inputs[0], view_),
        live_(given.output) {
    make_cache(given, console);
    require_sound(read_manifest(given.cache, manifest_), given.cache);
    take_structures_of(manifest_, arguments_, console);
    const Json& camera = manifest_["content"]["camera"];
    view_.width = camera["width"].get<std::uint32_t>();
    view_.height = camera["height"].get<std::uint32_t>();
    view_.sampling.integrator = integrator_of(manifest_);
    read_steps();
  }

  ExitCode run() {
    catch_up();
    while (!given_.watch.most_exports || exports_ < *given_.watch.most_exports) {
      WatchedScene::Look look = scene_.look();
      if (!look.fault.empty()) console_.warn({look.fault + "; waiting for the next export"});
      if (look.scene)
        follow(std::move(*look.scene), look.camera);
      else
        wait();
    }
    console_.json({{"run", printable(given_.output)},
                   {"journal", printable(journal_file_.string())},
                   {"exports", exports_},
                   {"steps", draft_.steps.size()}});
    return ExitCode::ok;
  }

 private:
  void wait() const {
    using Clock = std::chrono::steady_clock;
    constexpr double kMostAtOnce = 0.05;  // seconds, until a signal is heard
    const auto end = Clock::now() + std::chrono::duration<double>(given_.watch.interval_seconds);
    do {
      console_.check_interrupt();
      const std::chrono::duration<double> rest = end - Clock::now();
      std::this_thread::sleep_for(std::min(rest, std::chrono::duration<double>(kMostAtOnce)));
    } while (Clock::now() < end);
  }

  /// The journal that an earlier command has begun.
  void read_steps() {
    std::error_code error;
    if (!std::filesystem::exists(journal_file_, error)) return;
    const Bytes bytes = read_file(journal_file_);
    const Journal journal = parse_journal(text_of(bytes), journal_file_);
    const auto last = static_cast<std::uint32_t>(journal.steps.size());
    if (state_after(journal, last) != last)
      throw InputError(journal_file_.string(), journal.steps.back().where + "/keep",
                       "the last step is put back, and an export goes on from what the last step leaves");
    draft_.steps = parse_json(text_of(bytes), journal_file_.string()).at("steps");
  }

  [[nodiscard]] std::uint32_t steps() const { return static_cast<std::uint32_t>(draft_.steps.size()); }

  /// Replays what there is of the journal, frames that are there aside; then the replayer is where the scene last was.
  void catch_up() {
    const std::string text = journal_text(draft_);
    journal_.emplace(parse_journal(text, journal_file_));
    OpenedCache opened = open_cache(given_.cache, true, nullptr);
    console_.warn(check_journal(*opened.state, *journal_));
    facts_ = {opened.scene_hash, cache_sizes(manifest_), noise_of(manifest_), sentences(opened.losses), opened.rebuilt};
    RunPlan plan = plan_run();
    write_file(journal_file_, text);
    JournalRun run(arguments_, console_, *journal_, plan, std::move(opened), nullptr, facts_, previews_);
    finish(run);
  }

  [[nodiscard]] RunPlan plan_run() const {
    const FrameStyle style{arguments_.float_frames, arguments_.layers,
                           previews_.view != nullptr ? previews_.view->id() : ""};
    return {arguments_, *journal_, given_.output, run_source(manifest_, style)};
  }

  void finish(JournalRun& run) {
    live_.set(steps());  // one less than there will be: the page that is being made knows better
    (void)run.run(0, 1);
    run.reach_end();
    replayer_.emplace(run.take_replayer());
    live_.set(steps() + 1);
  }

  /// Makes a step of what an export has otherwise, and its frame.
  void follow(LoadedDocument scene, const Camera& camera) {
    console_.warn(scene.warnings);
    require_not_outputs(given_, scene.files, "a file of the scene");
    const bool is_first = !std::exchange(has_looked_, true);
    if (is_first && is_as_known(scene.document, camera)) return;  // no export, but where the watch begins
    ++exports_;
    if (std::optional<Json> step = difference(std::move(scene.document), camera)) make_step(std::move(*step));
  }

  [[nodiscard]] bool is_as_known(const LookDocument& document, const Camera& camera) const {
    try {
      return is_same_view(camera) &&
             draft_diff(replayer_->state().document(), document, "files").draft.steps.at(0).at("edit").empty();
    } catch (const InputError&) {
      return false;
    }
  }

  /// The step, tried, with its files beside the journal; none where nothing differs that a journal can say.
  std::optional<Json> difference(LookDocument export_, const Camera& camera) {
    const std::string number = "export " + std::to_string(exports_);
    const std::string folder = journal_file_.stem().string() + ".files";
    const bool is_same = is_same_view(camera);
    if (!is_same) keep_camera(export_);
    try {
      DiffDraft diff = draft_diff(replayer_->state().document(), export_, folder);
      if (!is_same)
        diff.draft.warnings.push_back("the camera is not as in " + given_.cache +
                                      ", which no journal can say: frames keep the cache's");
      for (std::string& warning : diff.draft.warnings) warning = number + ": " + warning;
      console_.warn(diff.draft.warnings);
      JournalDraft alone;
      alone.steps.push_back(std::move(diff.draft.steps.at(0)));
      Json& step = alone.steps[0];
      if (step["edit"].empty()) return std::nullopt;
      step["name"] = "export " + std::to_string(steps() + 1);
      bring(diff.files);
      rehearse(parse_journal(journal_text(alone), journal_file_));
      return step;
    } catch (const InputError& error) {
      console_.warn({number + ": no journal can say what differs: " + error.what()});
      return std::nullopt;
    }
  }

  /// Files are named after their bytes: what is there is the same.
  void bring(const std::vector<DraftFile>& files) const {
    for (const DraftFile& file : files) {
      const std::filesystem::path path = journal_file_.parent_path() / file.name;
      make_folders(path.parent_path());
      std::error_code error;
      if (!std::filesystem::exists(path, error)) write_file(path, *file.bytes);
    }
  }

  [[nodiscard]] bool is_same_view(const Camera& camera) const {
    const Camera& own = replayer_->state().scene().camera;
    return camera.eye == own.eye && camera.right == own.right && camera.up == own.up && camera.forward == own.forward &&
           camera.orthographic == own.orthographic && camera.half_width == own.half_width &&
           camera.half_height == own.half_height;
  }

  /// Puts the node of the camera back where the cache has it, so that the other differences can be said.
  void keep_camera(LookDocument& document) const {
    const std::string& name = replayer_->state().scene().camera.node;
    const Json& nodes = replayer_->state().document().look["nodes"];
    Json& others = document.look["nodes"];
    if (name.empty() || !nodes.contains(name) || !others.contains(name)) return;
    for (const char* member : {"translation", "rotation", "scale", "matrix"}) {
      others[name].erase(member);
      if (nodes[name].contains(member)) others[name][member] = nodes[name][member];
    }
  }

  /// Tries a step on a copy of the scene. Throws InputError.
  void rehearse(const Journal& step) const {
    const SceneState& state = replayer_->state();
    LookDocument document = state.document();
    document.assets = counted_assets();
    *document.assets = *state.document().assets;
    SceneState copy(std::move(document), state.scene().camera, state.pyramids(), state.scene().integrator);
    (void)check_journal(copy, step);
  }

  void make_step(Json step) {
    const std::uint32_t made = steps();
    draft_.steps.push_back(std::move(step));
    const std::string text = journal_text(draft_);
    journal_.emplace(parse_journal(text, journal_file_));
    write_file(journal_file_, text);
    arguments_.steps = StepRange{made + 1, made + 1};
    RunPlan plan = plan_run();
    Replayer replayer = std::move(*replayer_);
    replayer_.reset();
    JournalRun run(arguments_, console_, *journal_, plan, std::move(replayer), made, facts_, previews_);
    finish(run);
  }

  const Arguments& given_;
  Console& console_;
  std::filesystem::path journal_file_;
  Arguments arguments_;  // of the replay
  PreviewStyle previews_;
  ViewArguments view_;  // of the cache
  WatchedScene scene_;
  LiveNote live_;
  Json manifest_;
  CacheFacts facts_;
  JournalDraft draft_;
  std::optional<Journal> journal_;  // of the draft
  std::optional<Replayer> replayer_;
  bool has_looked_ = false;
  std::uint32_t exports_ = 0;
};

}  // namespace

ExitCode run_watch(const Arguments& arguments, Console& console) {
  Watch watch(arguments, console);
  return watch.run();
}

}  // namespace relook
