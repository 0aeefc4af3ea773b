// `relook render`: a frame (.exr) or preview (.png) of a scene, after the steps of a journal if one is given.
#include "image/render.h"

#include <functional>
#include <optional>

#include "base/hash.h"
#include "edit/apply.h"
#include "edit/journal_walk.h"
#include "frame/frame_layers.h"
#include "frame/preview.h"
#include "image/layers/half_light.h"
#include "image/layers/layered_frame.h"
#include "input/load_scene.h"
#include "options/named_files.h"
#include "options/outputs.h"
#include "report/edit_hashes.h"
#include "report/report.h"
#include "run/step_text.h"
#include "verbs.h"

namespace relook {
namespace {

/// The scene as edited by steps 1..last, and where the frame's header says it comes from: as the last frame of a replay
/// has it. `before_last` is called when that is about to change the frame.
void apply_journal(SceneState& state, const Journal& journal, const std::optional<std::uint32_t>& last, FrameMeta& meta,
                   const std::function<void()>& before_last, Console& console) {
  if (last && *last > journal.steps.size())
    throw UsageError("--step: " + std::to_string(*last) + " is beyond the " + std::to_string(journal.steps.size()) +
                     " steps of " + journal.file);
  const std::uint32_t count = last ? *last : static_cast<std::uint32_t>(journal.steps.size());
  console.warn(check_journal(state, journal));
  ChangeClass change = ChangeClass::base;
  follow_edits(JournalWalk(journal, 1, count), [&](const JournalEvent& event) {
    const bool is_last = event.place.step == count && event.frame + 1 == event.step->frames();
    if (is_last) before_last();
    change = classify(state.scene(), apply_edit(state, event.edit(), journal.file, journal.path.parent_path())).change;
  });
  meta.edits_hash = EditHashes(journal).after(count);
  meta.step = step_label(last_place_of(journal, count));
  meta.change_class = change_class_name(change);
}

/// The frame, with its sums of light where layers need them.
Image rendered_image(const Arguments& arguments, const Scene& scene, RenderStats& stats, const Progress& progress) {
  const ViewOptions& view = arguments.view.sampling;
  if (arguments.layers) return render_with_sums(scene, view, stats, progress);
  Image image;
  image.view = view;
  image.frame = render(scene, view, stats, progress);
  return image;
}

/// `image`: with its sums of light, if the frame is to have layers and is of Integrator::path.
Bytes encoded(const Arguments& arguments, const SceneState& state, const Image& image,
              const std::optional<Frame>& before, const FrameMeta& meta, Console& console) {
  const Frame& frame = image.frame;
  if (is_preview_name(arguments.output)) return encode_png(frame, {display_view_of_environment(), arguments.exposure});
  const PixelFormat format = arguments.float_frames ? PixelFormat::float32 : PixelFormat::half;
  if (!arguments.layers) return encode_exr(frame, meta, format);
  const ChangedPixels changed = before ? pixels_between(*before, frame) : ChangedPixels();
  Bytes bytes = encode_layered_exr({state.scene(), image.view, frame, changed, format, &image.light_sums}, meta,
                                   console.stage("layers"));
  console.end_stage();
  return bytes;
}

}  // namespace

ExitCode run_render(const Arguments& arguments, Console& console) {
  std::optional<Journal> journal;
  if (!arguments.journal.empty()) journal = read_journal(arguments.journal, [&] { console.check_interrupt(); });
  if (journal) require_not_outputs(arguments, files_of(*journal), "a file of the journal");
  std::optional<TraceScope> span(std::in_place, console.trace(), "load scene");
  std::optional<Interrupt::Expendable> loading(std::in_place, console.interrupt());
  LoadedScene loaded = load_scene(arguments.inputs[0], arguments.view);
  loading.reset();
  console.warn(loaded.warnings);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  FrameMeta meta{loaded.hash, "", "0", std::string(change_class_name(ChangeClass::base)),
                 exposure_text(arguments.exposure)};
  std::optional<Frame> before;  // the frame that the last step changed
  const auto render_before = [&] {
    RenderStats ignored;
    if (arguments.layers) before = render(loaded.state->scene(), arguments.view.sampling, ignored);
  };
  if (journal) span.emplace(console.trace(), "apply journal");
  if (journal) apply_journal(*loaded.state, *journal, arguments.step, meta, render_before, console);
  if (arguments.layers) require_layers(loaded.state->scene());
  make_folders(std::filesystem::absolute(arguments.output).parent_path());
  span.emplace(console.trace(), "render");
  RenderStats stats;
  const Image image = rendered_image(arguments, loaded.state->scene(), stats, console.stage("render"));
  const Frame& frame = image.frame;
  console.end_stage();
  const std::optional<double> share = noise(loaded.state->scene(), image.view, frame);
  span.emplace(console.trace(), "write frame");
  const Bytes bytes = encoded(arguments, *loaded.state, image, before, meta, console);
  console.check_interrupt();
  write_file(arguments.output, bytes);
  const bool is_half = !arguments.float_frames && !is_preview_name(arguments.output);
  const std::uint64_t clipped = is_half ? clipped_pixels(frame) : 0;
  if (clipped > 0) console.warn({arguments.output + ": " + clipping_sentence(clipped)});
  span.reset();
  console.part_done();

  const std::string hash = hash128(bytes);
  console.line(arguments.output + ": " + std::to_string(frame.width) + "x" + std::to_string(frame.height) + ", " +
               std::to_string(stats.counters.ray_updates) + " rays, " + std::to_string(stats.counters.shadow_updates) +
               " shadow rays, " + std::to_string(stats.render_seconds) + " s" + noise_text(share));
  console.json({{"frame", arguments.output},
                {"hash", hash},
                {"scene_hash", loaded.hash},
                {"camera", loaded.state->scene().camera.name},
                {"resolution", {frame.width, frame.height}},
                {"samples_total", stats.counters.samples_total},
                {"ray_updates", stats.counters.ray_updates},
                {"shadow_updates", stats.counters.shadow_updates},
                {"noise", share ? Json(*share) : Json()},
                {"build_seconds", stats.build_seconds},
                {"render_seconds", stats.render_seconds}});
  return ExitCode::ok;
}

}  // namespace relook
