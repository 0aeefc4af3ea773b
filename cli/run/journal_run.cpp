#include "run/journal_run.h"

#include <sys/resource.h>

#include <cstdio>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/system/memory.h"
#include "compare/compare.h"
#include "image/render.h"
#include "input/load_cache.h"
#include "replay/memory_needs.h"
#include "report/journal_words.h"
#include "report/places.h"
#include "run/step_text.h"

namespace relook {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What the entry of a frame that another command has made says of the frame itself.
void take_over(const Json& kept, StepReport& entry) {
  entry.has_overlays = kept.at("overlays").get<bool>();
  entry.has_relight = kept.at("relight").get<bool>();
  entry.exposure = kept.at("exposure").get<double>();
  if (kept.at("verify_percent").is_number()) entry.verify_percent = kept.at("verify_percent").get<double>();
  if (const Json& verify = kept.at("verify"); verify.is_object())
    entry.verify = VerifyResult{verify.at("pixels_compared").get<std::uint64_t>(),
                                verify.at("pixels_different").get<std::uint64_t>()};
  for (const auto& [name, stamp] : kept.at("files").items())
    entry.files[name] = {stamp.at("hash").get<std::string>(), stamp.at("bytes").get<std::uint64_t>(),
                         stamp.at("modified").get<std::int64_t>()};
}

/// Of all threads of this process so far.
double process_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

RegionOptions region_options(const StructureOptions& structures) {
  return {.groups = structures.groups,
          .tunnels = structures.tunnels,
          .ray_trees = structures.ray_trees_percent / 100,
          .color_trees = structures.color_trees_percent / 100,
          .atoms = structures.atoms,
          .tunnel_levels = structures.tunnel_levels,
          .most_tunnels = structures.most_tunnels};
}

}  // namespace

WorkClock::WorkClock() : start_(std::chrono::steady_clock::now()), cpu_start_(process_cpu_seconds()) {}
double WorkClock::seconds() const { return seconds_since(start_); }
double WorkClock::cpu_seconds() const { return process_cpu_seconds() - cpu_start_; }

JournalRun::JournalRun(const Arguments& arguments, Console& console, const Journal& journal, RunPlan& plan,
                       OpenedCache opened, std::unique_ptr<Residency> residency, const CacheFacts& cache,
                       const PreviewStyle& previews)
    : arguments_(arguments),
      console_(console),
      journal_(journal),
      plan_(plan),
      folder_(plan, journal,
              {opened.image.frame.width, opened.image.frame.height,
               arguments.float_frames ? PixelFormat::float32 : PixelFormat::half, previews, arguments.report}),
      tunnels_(opened.tunnels),
      replayer_(std::move(*opened.state), std::move(opened.image), region_options(arguments.structures),
                std::move(residency), std::move(opened.tunnels)),
      replay_(journal, replayer_) {
  describe(cache, previews);
}

JournalRun::JournalRun(const Arguments& arguments, Console& console, const Journal& journal, RunPlan& plan,
                       Replayer replayer, std::uint32_t made, const CacheFacts& cache, const PreviewStyle& previews)
    : arguments_(arguments),
      console_(console),
      journal_(journal),
      plan_(plan),
      folder_(plan, journal,
              {replayer.image().frame.width, replayer.image().frame.height,
               arguments.float_frames ? PixelFormat::float32 : PixelFormat::half, previews, arguments.report}),
      replayer_(std::move(replayer)),
      made_(made),
      replay_(journal, replayer_) {
  describe(cache, previews);
}

void JournalRun::describe(const CacheFacts& cache, const PreviewStyle& previews) {
  report_.scene = replayer_.state().document().file;
  report_.scene_hash = cache.scene_hash;
  report_.cache_folder = arguments_.inputs[0];
  report_.journal = journal_.file;
  report_.journal_hash = journal_.hash;
  report_.said = journal_.said;
  report_.source = plan_.source();
  report_.places = {{"cache", place_json(plan_.folder(), arguments_.inputs[0])},
                    {"journal", place_json(plan_.folder(), journal_.path)}};
  report_.camera = replayer_.state().scene().camera;
  report_.view = replayer_.image().view;
  report_.structures = arguments_.structures;
  report_.float_frames = arguments_.float_frames;
  report_.layers = arguments_.layers;
  report_.relight = arguments_.relight;
  report_.exposure = previews.exposure;
  report_.verify_percent = arguments_.verify_percent;
  report_.step_range = arguments_.steps;
  report_.threads = thread_count();
  report_.cache = cache.sizes;
  report_.noise = cache.noise;
  report_.cache_damage = cache.damage;
  rebuilt_ = cache.rebuilt;
}

std::uint64_t JournalRun::run(std::size_t place, std::size_t runs) {
  runs_before_ = static_cast<double>(place);
  runs_ = static_cast<double>(runs);
  try {
    run_steps();
    make_room_for_page();
    folder_.write_report(report_, false, [this] { console_.check_interrupt(); });
  } catch (const Interrupted&) {
    leave_off();
    throw;
  }
  if (!arguments_.access_log.empty()) write_file(arguments_.access_log, replayer_.residency().access_log());
  print_summary();
  return pixels_different_ + plan_.pixels_different();
}

void JournalRun::make_room_for_page() {
  Residency& residency = replayer_.residency();
  if (!residency.is_limited()) return;
  static_cast<void>(residency.make_room(kPageBytes));
  trim_allocator();
}

/// Reports the frames that are finished. The same command takes the run up again.
void JournalRun::leave_off() {
  const Uninterrupted to_the_end;
  folder_.write_report(report_, true, [] {});
}

void JournalRun::run_steps() {
  if (arguments_.baseline && !arguments_.verify_percent) {
    (void)full_render(baseline_.emplace());
    baseline_segments_ = replayer_.segments();
  }
  for (const JournalEvent& event : JournalWalk(journal_, 0, plan_.last_step())) {
    const bool is_asked_for = event.place.step >= plan_.first_step();
    switch (event.kind) {
      case EventKind::base:
      case EventKind::edit:
      case EventKind::drag:
        if (is_asked_for)
          run_frame(event);
        else if (event.place.step > made_)
          replay_.skip(event);
        ++frame_number_;
        break;
      case EventKind::release:
      case EventKind::wedge_end:
        if (is_asked_for && (step_so_far_ || !plan_.keeps_whole_step(event.place.step))) end_step(event);
        break;
    }
  }
  console_.part_done();
}

void JournalRun::run_frame(const JournalEvent& event) {
  if (plan_.keeps(event.place.step, event.frame))
    pass_kept(event);
  else
    make_frame(event);
  ++frames_done_;
}

StepReport JournalRun::new_entry(const JournalEvent& event) const {
  StepReport entry;
  entry.place = event.place;
  entry.is_drag = event.step != nullptr && event.step->form() == StepForm::drag;
  entry.name = step_name(journal_, event.place.step);
  const bool is_frame = event.has_frame();
  entry.words = entry_words(journal_, event.place.step, is_frame ? std::optional(event.frame) : std::nullopt);
  entry.edits_hash = plan_.hashes().at(event.place.step, event.frame);
  entry.source_hash = plan_.source_hash();
  entry.verify_percent = arguments_.verify_percent;
  entry.exposure = report_.exposure;
  return entry;
}

/// A frame that is there already: its edit is made with the next ones, or at once while a selection is being dragged.
void JournalRun::pass_kept(const JournalEvent& event) {
  const StepReport entry = new_entry(event);
  console_.log_line(label_of(entry) + " \"" + printable(entry.name) + "\": kept");
  if (event.place.step <= made_) return;  // the frame before any edit is of step 0
  follows_last_ = false;
  replay_.skip(event);
}

/// Goes to where the scene is before the next frame.
void JournalRun::catch_up() {
  if (replay_.is_up_to_date()) return;
  const auto start = std::chrono::steady_clock::now();
  const TraceScope span = console_.span("edits before");
  replay_.catch_up();
  follows_last_ = false;
  report_.resume_seconds += seconds_since(start);
}

/// Does what leads to a frame, or to the end of a step.
StepResult JournalRun::follow(const JournalEvent& event) {
  StepResult result = replay_.follow(event);
  if (event.kind != EventKind::base) return result;
  const Frame& base = replayer_.image().frame;
  result.counters.samples_total = std::uint64_t{base.width} * base.height * report_.view.samples;
  result.counters.rebuilt = rebuilt_;
  result.classification.change = ChangeClass::base;
  return result;
}

void JournalRun::make_frame(const JournalEvent& event) {
  StepReport entry = new_entry(event);
  console_.check_interrupt();
  show_part(entry);
  StepResult result;
  WorkClock clock;
  try {
    catch_up();
    clock = WorkClock();
    result = follow(event);
  } catch (const ResourceError&) {  // with more memory the run goes on from here
    leave_off();
    throw;
  } catch (const std::bad_alloc&) {
    leave_off();
    throw;
  }
  entry.change = result.classification.change;
  entry.reasons = result.classification.reasons;
  entry.counters = result.counters;
  entry.seconds = result.seconds;
  finish(std::move(entry), result, clock);
}

/// The entry of a drag or wedge as a whole, which names the last of its frames; a dragged selection goes back into the
/// ray trees.
void JournalRun::end_step(const JournalEvent& event) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint32_t step = event.place.step;
  const std::size_t last = event.frame;
  const bool is_last_kept = plan_.keeps(step, last);
  StepReport entry = step_so_far_ && !is_last_kept ? *step_so_far_ : new_entry(event);
  step_so_far_.reset();
  if (is_last_kept) take_over(plan_.kept_entry(step, last), entry);
  entry.is_whole_step = true;
  entry.words = entry_words(journal_, step, std::nullopt);
  entry.full_render.reset();  // of its frames
  const StepResult result = follow(event);
  entry.counters = result.counters;
  entry.seconds = result.seconds;
  if (entry.is_drag) entry.counters.samples_total = plan_.samples();  // also where all frames were there
  entry.reasons = {entry.is_drag ? "the selection is released where the last entry put it"
                                 : "the last value of the wedge stays"};
  // The class is that of all its frames, those of earlier commands included.
  entry.change = ChangeClass::color;
  for (std::size_t frame = 0; frame <= last; ++frame) {
    if (!plan_.keeps(step, frame)) continue;
    entry.change =
        combined(entry.change, change_class_of(plan_.kept_entry(step, frame).at("class").get<std::string>()));
  }
  entry.change = combined(entry.change, step_class_);
  step_class_ = ChangeClass::color;
  entry.frame = frame_name(entry.place);
  entry.preview = preview_name(entry.place);
  entry.resident = replayer_.resident();
  entry.peak_rss_bytes = peak_rss_bytes();
  entry.seconds.total = seconds_since(start);
  trace_step(entry, start, console_.trace());
  folder_.note(std::move(entry));
}

/// The share of the run that a frame is, and what it is.
void JournalRun::show_part(const StepReport& entry) {
  const auto done = static_cast<double>(frames_done_), all = static_cast<double>(plan_.frames());
  const auto share = [&](double frames) { return (runs_before_ + frames / all) / runs_; };
  console_.part(share(done), share(done + 1), "step " + label_of(entry) + " " + entry.name);
}

/// Damage of tunnels comes to light when they are first used.
void JournalRun::note_tunnel_damage() {
  if (!tunnels_) return;
  std::vector<std::string> damage = sentences({tunnels_->take_faults(), {}, {}});
  report_.cache_damage.insert(report_.cache_damage.end(), damage.begin(), damage.end());
  for (std::string& sentence : damage) sentence = arguments_.inputs[0] + ": " + sentence + "; built again";
  console_.warn(damage);
}

void JournalRun::finish(StepReport entry, const StepResult& result, const WorkClock& clock) {
  note_tunnel_damage();
  FrameMeta meta;
  meta.scene_hash = report_.scene_hash;
  meta.edits_hash = entry.edits_hash;
  add_journal_words(meta, journal_, entry.place.step, entry.place.number ? *entry.place.number - 1 : 0);
  const bool is_numbered = entry.place.number.has_value();
  folder_.write_frame(entry, replayer_, {result.changed_pixels, follows_last_, replay_.changed_in_step()},
                      std::move(meta), {arguments_.layers, arguments_.relight});
  follows_last_ = true;
  warn_of_clipping(entry);
  if (arguments_.overlays) folder_.write_overlays(entry, replayer_, result);
  entry.seconds.total = clock.seconds();
  entry.seconds.cpu = clock.cpu_seconds();
  entry.resident = replayer_.resident();
  entry.peak_rss_bytes = peak_rss_bytes();
  entry.full_render = foreseen_full_render();
  if (arguments_.verify_percent) verify(entry);
  trace_step(entry, clock.start(), console_.trace());
  console_.log_line(line_of(entry));
  if (is_numbered) {
    step_class_ = combined(step_class_, entry.change);
    step_so_far_ = entry;
  }
  folder_.note(std::move(entry));
}

/// Renders the scene as it is now, as `relook render` does; `cost`: what that took, without writing.
Frame JournalRun::full_render(FullRender& cost) {
  Residency& residency = replayer_.residency();
  const Residency::Aside aside = residency.begin_aside();
  const SceneState& state = replayer_.state();
  const Scene scene = compiled_scene(state.document(), report_.camera, *state.pyramids(), report_.view.integrator);
  RenderStats stats;
  const TraceScope span = console_.span("full render");
  const auto progress = [&residency, shown = console_.stage("full render")](double share) {
    residency.measure_aside();
    shown(share);
  };
  const MemoryMonitor monitor = [&](std::int64_t bytes) { residency.claim(bytes); };
  const WorkClock clock;
  Frame frame = render(scene, report_.view, stats, progress, residency.is_limited() ? monitor : MemoryMonitor());
  cost = {stats.build_seconds + stats.render_seconds, clock.cpu_seconds(),
          stats.counters.ray_updates + stats.counters.shadow_updates, true};
  console_.end_stage();
  if (!report_.full_render_seconds) report_.full_render_seconds = cost.seconds;
  return frame;
}

/// What a full render of the present frame's scene would take, from the one of --baseline: by the segments of their ray
/// trees, which a replay knows without tracing.
std::optional<FullRender> JournalRun::foreseen_full_render() const {
  if (!baseline_ || baseline_segments_ == 0) return std::nullopt;
  const double ratio = static_cast<double>(replayer_.segments()) / static_cast<double>(baseline_segments_);
  const auto rays = static_cast<std::uint64_t>(static_cast<double>(baseline_->rays) * ratio);
  return FullRender{baseline_->seconds * ratio, baseline_->cpu_seconds * ratio, rays, false};
}

void JournalRun::verify(StepReport& entry) {
  const FrameDifference difference = compare_frames(full_render(entry.full_render.emplace()), replayer_.image().frame,
                                                    *arguments_.verify_percent, frame_number_);
  entry.verify = VerifyResult{difference.pixels_compared, difference.pixels_different};
  pixels_compared_ += difference.pixels_compared;
  pixels_different_ += difference.pixels_different;
}

/// Warns of the first frames with pixels that half cannot hold; print_summary() counts all.
void JournalRun::warn_of_clipping(const StepReport& entry) {
  constexpr std::size_t kMostSaid = 3;
  if (folder_.clipped_pixels() == 0 || ++clipped_frames_ > kMostSaid) return;
  console_.warn({entry.frame + ": " + clipping_sentence(folder_.clipped_pixels())});
}

void JournalRun::print_summary() {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3g s", seconds_since(start_));
  std::string line = plan_.folder().string() + ": " + std::to_string(plan_.frames()) + " frames";
  if (plan_.kept_frames() > 0) line += " (" + std::to_string(plan_.kept_frames()) + " kept)";
  line += std::string(" in ") + seconds;
  if (arguments_.verify_percent)
    line += ", verified: " + std::to_string(pixels_different_) + " of " + std::to_string(pixels_compared_) +
            " pixels differ";
  if (plan_.pixels_different() > 0)
    line += ", in kept frames " + std::to_string(plan_.pixels_different()) + " pixels differ from full renders";
  if (clipped_frames_ > 0) line += ", " + std::to_string(clipped_frames_) + " with pixels beyond half's range";
  if (arguments_.report != ReportKind::none)
    line +=
        "; see " + (plan_.folder() / (arguments_.report == ReportKind::html ? "report.html" : kReportName)).string();
  console_.line(printable(line));
}

}  // namespace relook
