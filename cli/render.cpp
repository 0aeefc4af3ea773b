// `relook render`: a frame (.exr) or preview (.png) of a scene, after the steps of a journal if one is given.
#include "image/render.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "base/hash.h"
#include "edit/apply.h"
#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "frame/frame_layers.h"
#include "frame/preview.h"
#include "frame/sheet/contact_sheet.h"
#include "image/layers/half_light.h"
#include "image/layers/layered_frame.h"
#include "input/load_scene.h"
#include "input/open_look.h"
#include "inspect/inspect_cameras.h"
#include "options/named_files.h"
#include "options/outputs.h"
#include "report/edit_hashes.h"
#include "report/journal_words.h"
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
  SceneHistory history(journal);
  follow_edits(JournalWalk(journal, 1, count), [&](const JournalEvent& event) {
    const bool is_last = event.place.step == count && event.frame + 1 == event.step->frames();
    static_cast<void>(go_back(state, journal, event, history));
    if (is_last) before_last();
    change = make_edit(state, journal, event, history).classification.change;
  });
  meta.edits_hash = EditHashes(journal).after(count);
  meta.step = step_label(last_place_of(journal, count));
  add_journal_words(meta, journal, count, frames_in(journal, count) - 1);
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

/// The cameras that `--camera all` is for; none for another --camera, or where a camera is called so.
std::vector<std::string> cameras_of_sheet(const Arguments& arguments) {
  if (arguments.view.camera != "all") return {};
  const LookDocument document = load_document(arguments.inputs[0], arguments.view).document;
  std::vector<std::string> names = camera_names(document);
  if (std::ranges::find(names, "all") != names.end()) return {};
  if (names.empty())
    throw InputError(arguments.inputs[0], "", "the scene has no camera; --camera auto frames the scene");
  if (arguments.layers) throw UsageError("--aovs: a sheet of all cameras has no layers");
  return names;
}

/// A sheet with a labelled picture for each camera; each is the frame that --camera NAME gives.
ExitCode render_sheet(const Arguments& arguments, const std::vector<std::string>& cameras,
                      const std::optional<Journal>& journal, Console& console) {
  const bool is_preview = is_preview_name(arguments.output);
  const PreviewStyle style{display_view_of_environment(), arguments.exposure};
  ContactSheet sheet;
  sheet.title = std::filesystem::path(arguments.inputs[0]).filename().string();
  sheet.groups.emplace_back();
  FrameMeta meta;
  Json pictures = Json::array();
  for (const std::string& name : cameras) {
    Arguments of_camera = arguments;
    of_camera.view.camera = name;
    LoadedScene loaded = load_scene(arguments.inputs[0], of_camera.view);
    if (name == cameras.front()) console.warn(loaded.warnings);
    require_not_outputs(arguments, loaded.files, "a file of the scene");
    meta = FrameMeta();
    meta.scene_hash = loaded.hash;
    meta.step = "0";
    meta.change_class = change_class_name(ChangeClass::base);
    meta.exposure = exposure_text(arguments.exposure);
    if (journal)
      apply_journal(
          *loaded.state, *journal, arguments.step, meta, [] {}, console);
    RenderStats stats;
    Frame frame = render(loaded.state->scene(), arguments.view.sampling, stats, console.stage("render " + name));
    console.end_stage();
    if (is_preview) frame = as_displayed(frame, style);
    sheet.groups[0].pictures.push_back({std::move(frame), name, {}});
    pictures.push_back({{"camera", name}, {"render_seconds", stats.render_seconds}});
  }
  make_folders(std::filesystem::absolute(arguments.output).parent_path());
  const Frame drawn = draw_contact_sheet(sheet);
  const PixelFormat format = arguments.float_frames ? PixelFormat::float32 : PixelFormat::half;
  console.check_interrupt();
  write_file(arguments.output, is_preview ? encode_displayed(drawn, style) : encode_exr(drawn, meta, format));
  console.line(arguments.output + ": " + std::to_string(cameras.size()) + " cameras, " + std::to_string(drawn.width) +
               "x" + std::to_string(drawn.height));
  console.json(
      {{"sheet", arguments.output}, {"resolution", {drawn.width, drawn.height}}, {"pictures", std::move(pictures)}});
  return ExitCode::ok;
}

}  // namespace

ExitCode run_render(const Arguments& arguments, Console& console) {
  if (is_cache_folder(arguments.inputs[0]))
    throw UsageError(
        arguments.inputs[0],
        "is a cache, whose base frame and edits relook replay writes; render takes the scene that it is of");
  std::optional<Journal> journal;
  if (!arguments.journal.empty()) journal = read_journal(arguments.journal, [&] { console.check_interrupt(); });
  if (journal) require_not_outputs(arguments, files_of(*journal), "a file of the journal");
  if (const std::vector<std::string> cameras = cameras_of_sheet(arguments); !cameras.empty())
    return render_sheet(arguments, cameras, journal, console);
  std::optional<TraceScope> span(std::in_place, console.trace(), "load scene");
  std::optional<Interrupt::Expendable> loading(std::in_place, console.interrupt());
  LoadedScene loaded = load_scene(arguments.inputs[0], arguments.view);
  loading.reset();
  console.warn(loaded.warnings);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  FrameMeta meta;
  meta.scene_hash = loaded.hash;
  meta.step = "0";
  meta.change_class = change_class_name(ChangeClass::base);
  meta.exposure = exposure_text(arguments.exposure);
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
