#include "setup.h"

#include <chrono>
#include <cstdio>

#include "base/error.h"

namespace relook {

BenchOptions parse_options(const std::vector<std::string>& words, std::uint32_t width, std::uint32_t height) {
  BenchOptions options;
  options.width = width;
  options.height = height;
  std::vector<std::string> places;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] != "--camera")
      places.push_back(words[i]);
    else if (++i < words.size())
      options.camera = words[i];
    else
      throw UsageError("--camera: which one?");
  }
  if (places.size() < 2) throw UsageError("SCENE and JOURNAL are missing; tests/bench/README.md has all commands");
  options.scene = places[0];
  options.journal = places[1];
  if (places.size() > 2 && std::sscanf(places[2].c_str(), "%ux%u", &options.width, &options.height) != 2)
    throw UsageError("the resolution is WIDTHxHEIGHT");
  if (places.size() > 3) options.view.samples = static_cast<std::uint32_t>(std::stoul(places[3]));
  return options;
}

void BenchOptions::note(std::string table, std::string row, std::string column, double value, std::string unit,
                        std::string paper, std::optional<Goal> goal) const {
  if (record == nullptr) return;
  record->add(
      {"", std::move(table), std::move(row), std::move(column), value, std::move(unit), std::move(paper), goal});
}

LookDocument import_look(const BenchOptions& options) { return make_look_document(import_gltf(options.scene)); }

SceneChoices scene_choices(const BenchOptions& options, const LookDocument& document) {
  const bool needs_camera = options.camera.empty() && document.cameras.empty();
  return {needs_camera ? "auto" : options.camera, document.look.at("lights").empty()};
}

SceneState load_scene(const BenchOptions& options) {
  LookDocument document = import_look(options);
  const SceneChoices choices = scene_choices(options, document);
  const Camera camera = choose_camera(document, choices.camera, options.width, options.height);
  if (choices.has_auto_lights) (void)add_auto_lights(document, camera, options.view.integrator);
  return SceneState(std::move(document), camera, std::make_shared<PyramidStore>(), options.view.integrator);
}

double time_of(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double fastest(int runs, const std::function<void()>& body) {
  double best = 0;
  for (int run = 0; run < runs; ++run) {
    const double seconds = time_of(body);
    if (run == 0 || seconds < best) best = seconds;
  }
  return best;
}

TimedStep timed(Replayer& replayer, StepKind kind, const Edit& edit, const Journal& journal) {
  TimedStep step;
  const std::filesystem::path folder = journal.path.parent_path();
  step.seconds = time_of([&] {
    step.result =
        kind == StepKind::drag ? replayer.drag(edit, journal.file, folder) : replayer.step(edit, journal.file, folder);
  });
  return step;
}

TimedStep timed_release(Replayer& replayer) {
  TimedStep step;
  step.seconds = time_of([&] { step.result = replayer.release(); });
  return step;
}

void keep_faster(TimedStep& best, TimedStep step) {
  if (best.seconds == 0 || step.seconds < best.seconds) best = std::move(step);
}

Edit whole_edit(const JournalStep& step) {
  Edit whole;
  for (std::size_t frame = 0; frame < step.frames(); ++frame) {
    const Edit entry = step.edit_of(frame);
    whole.insert(whole.end(), entry.begin(), entry.end());
  }
  return whole;
}

Edit inverse_of(const Edit& edit, const Json& look) {
  Edit inverse;
  for (const PatchOperation& operation : edit) {
    if (operation.op == PatchOp::test) continue;
    require(operation.op != PatchOp::move && operation.op != PatchOp::copy, "an edit to be undone moves no values");
    PatchOperation undo = operation;
    const Json::json_pointer at(operation.path);
    if (look.contains(at)) {
      undo.op = operation.op == PatchOp::remove ? PatchOp::add : PatchOp::replace;
      undo.value = look.at(at);
    } else if (operation.op == PatchOp::add) {
      undo.op = PatchOp::remove;
    } else {
      continue;  // below something that the edit has added
    }
    inverse.insert(inverse.begin(), std::move(undo));
  }
  return inverse;
}

}  // namespace relook
