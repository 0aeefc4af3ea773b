#include "engine/render.h"

#include <functional>
#include <optional>

#include "base/hash.h"
#include "edit/apply.h"
#include "engine/frame_layers.h"
#include "engine/layered_frame.h"
#include "engine/report.h"
#include "load_scene.h"
#include "verbs.h"

namespace relook {
namespace {

/// Applies one step. Returns its class, as a replay's report has it.
ChangeClass apply_step(SceneState& state, const Journal& journal, const JournalStep& step) {
  const auto apply = [&](const Edit& edit) {
    const SceneDelta delta = apply_edit(state, edit, journal.file, journal.path.parent_path());
    return classify(state.scene(), delta).change;
  };
  ChangeClass change = ChangeClass::color;
  for (const Edit& frame : frames_of(step)) change = combined(change, apply(frame));
  return change;
}

/// The scene as edited by steps 1..last, and where the frame's header says it comes from. `before_last` is called when
/// the last step is about to change the frame.
void apply_journal(SceneState& state, const Journal& journal, const std::optional<std::uint32_t>& last, FrameMeta& meta,
                   const std::function<void()>& before_last) {
  if (last && *last > journal.steps.size())
    throw UsageError("--step: " + std::to_string(*last) + " is beyond the " + std::to_string(journal.steps.size()) +
                     " steps of " + journal.file);
  const std::size_t count = last ? *last : journal.steps.size();
  check_journal(state, journal);
  ChangeClass change = ChangeClass::base;
  for (std::size_t i = 0; i < count; ++i) {
    const JournalStep& step = journal.steps[i];
    const bool is_frame_of_last_value = !step.drag.empty() || !step.wedge.empty();
    if (i + 1 == count && !is_frame_of_last_value) before_last();
    change = apply_step(state, journal, step);
  }
  meta.journal_hash = journal.hash;
  meta.step = std::to_string(count);
  meta.change_class = change_class_name(change);
}

Bytes encoded(const Arguments& arguments, const SceneState& state, const Frame& frame,
              const std::optional<Frame>& before, const FrameMeta& meta, Console& console) {
  const PixelFormat format = arguments.float_frames ? PixelFormat::float32 : PixelFormat::half;
  if (!arguments.layers) return encode_exr(frame, meta, format);
  const ChangedPixels changed = before ? pixels_between(*before, frame) : ChangedPixels();
  Bytes bytes = encode_layered_exr({state.scene(), arguments.view.sampling, frame, changed, format}, meta,
                                   console.stage("layers"));
  console.end_stage();
  return bytes;
}

}  // namespace

ExitCode run_render(const Arguments& arguments, Console& console) {
  std::optional<Journal> journal;
  if (!arguments.journal.empty()) journal = read_journal(arguments.journal);
  std::optional<TraceScope> span(std::in_place, console.trace(), "load scene");
  LoadedScene loaded = load_scene(arguments.inputs[0], arguments.view);
  console.warn(loaded.warnings);
  FrameMeta meta{loaded.hash, "", "0", std::string(change_class_name(ChangeClass::base))};
  std::optional<Frame> before;  // the frame that the last step changed
  const auto render_before = [&] {
    RenderStats ignored;
    if (arguments.layers) before = render(loaded.state->scene(), arguments.view.sampling, ignored);
  };
  if (journal) span.emplace(console.trace(), "apply journal");
  if (journal) apply_journal(*loaded.state, *journal, arguments.step, meta, render_before);
  if (arguments.layers) require_layers(loaded.state->scene());
  make_folders(std::filesystem::absolute(arguments.output).parent_path());
  span.emplace(console.trace(), "render");
  RenderStats stats;
  const Frame frame = render(loaded.state->scene(), arguments.view.sampling, stats, console.stage("render"));
  console.end_stage();
  span.emplace(console.trace(), "write frame");
  const Bytes bytes = encoded(arguments, *loaded.state, frame, before, meta, console);
  console.check_interrupt();
  write_file(arguments.output, bytes);
  span.reset();
  console.part_done();

  const std::string hash = hash128(bytes);
  console.line(arguments.output + ": " + std::to_string(frame.width) + "x" + std::to_string(frame.height) + ", " +
               std::to_string(stats.counters.ray_updates) + " rays, " + std::to_string(stats.counters.shadow_updates) +
               " shadow rays, " + std::to_string(stats.render_seconds) + " s");
  console.json({{"frame", arguments.output},
                {"hash", hash},
                {"scene_hash", loaded.hash},
                {"camera", loaded.state->scene().camera.name},
                {"resolution", {frame.width, frame.height}},
                {"samples_total", stats.counters.samples_total},
                {"ray_updates", stats.counters.ray_updates},
                {"shadow_updates", stats.counters.shadow_updates},
                {"build_seconds", stats.build_seconds},
                {"render_seconds", stats.render_seconds}});
  return ExitCode::ok;
}

}  // namespace relook
