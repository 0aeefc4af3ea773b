#include "journal_run.h"

#include "base/error.h"
#include "base/parallel.h"
#include "engine/compare.h"
#include "engine/render.h"
#include "resume.h"

namespace relook {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RegionOptions region_options(const StructureOptions& structures) {
  return {structures.groups, structures.tunnels, structures.ray_trees_percent / 100,
          structures.color_trees_percent / 100, structures.atoms};
}

/// Of steps first..last of a journal; 0 is the frame before any of them. A drag or wedge has one more than entries.
std::size_t frame_count(const Journal& journal, std::size_t first, std::size_t last) {
  std::size_t frames = first == 0 ? 1 : 0;
  for (std::size_t step = std::max<std::size_t>(first, 1); step <= last; ++step) {
    const JournalStep& entry = journal.steps[step - 1];
    frames += 1 + entry.drag.size() + entry.wedge.size();
  }
  return frames;
}

/// The step and, one after the other, the phases that its report times.
void trace_step(const StepReport& step, std::chrono::steady_clock::time_point start, TraceFile& trace) {
  const Seconds& seconds = step.seconds;
  const Counters& counters = step.counters;
  trace.span(step_label(step.step, step.frame_in_step()) + " " + step.name, start, seconds.total,
             {{"class", change_class_name(step.change)},
              {"pixels_changed", counters.pixels_changed},
              {"samples_affected", counters.samples_affected},
              {"ray_tests", counters.ray_tests},
              {"ray_updates", counters.ray_updates},
              {"shadow_updates", counters.shadow_updates}});
  for (const auto& [name, duration] : {std::pair{"classify", seconds.classify},
                                       {"select", seconds.select},
                                       {"test", seconds.test},
                                       {"update", seconds.update},
                                       {"evaluate", seconds.evaluate},
                                       {"write", seconds.write}}) {
    if (duration > 0) trace.span(name, start, duration);
    start += std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(duration));
  }
  const Resident& resident = step.resident;
  trace.amounts("resident bytes", {{"ray_paths", resident.ray_paths},
                                   {"ray_trees", resident.ray_trees},
                                   {"color_trees", resident.color_trees},
                                   {"tunnels", resident.tunnels}});
}

}  // namespace

JournalRun::JournalRun(const Arguments& arguments, Console& console, const Journal& journal, OpenedCache opened,
                       std::unique_ptr<Residency> residency, const CacheFacts& cache,
                       const std::shared_ptr<const DisplayView>& view, const std::filesystem::path& folder)
    : arguments_(arguments),
      console_(console),
      journal_(journal),
      folder_(folder, opened.image.frame.width, opened.image.frame.height,
              arguments.float_frames ? PixelFormat::float32 : PixelFormat::half, view,
              run_hash(arguments, journal, view.get()), arguments.fresh),
      replayer_(std::move(*opened.state), std::move(opened.image), region_options(arguments.structures),
                std::move(residency)) {
  report_.scene = replayer_.state().document().file;
  report_.scene_hash = cache.scene_hash;
  report_.cache_folder = arguments.inputs[0];
  report_.journal = journal.file;
  report_.journal_hash = journal.hash;
  report_.camera = replayer_.state().scene().camera;
  report_.view = replayer_.image().view;
  report_.structures = arguments.structures;
  report_.float_frames = arguments.float_frames;
  report_.layers = arguments.layers;
  report_.verify_percent = arguments.verify_percent;
  report_.step_range = arguments.steps;
  first_step_ = arguments.steps ? arguments.steps->first : 0;
  last_step_ = arguments.steps ? arguments.steps->last.value_or(journal.steps.size()) : journal.steps.size();
  frames_ = frame_count(journal, first_step_, last_step_);
  report_.threads = thread_count();
  report_.cache = cache.sizes;
  report_.cache_damage = cache.damage;
  ray_trees_rebuilt_ = cache.ray_trees_rebuilt;
}

std::uint64_t JournalRun::run(std::size_t place, std::size_t runs) {
  runs_before_ = static_cast<double>(place);
  runs_ = static_cast<double>(runs);
  try {
    run_steps();
  } catch (const Interrupted&) {
    leave_off();
    throw;
  }
  folder_.write_report(report_, journal_);
  if (!arguments_.access_log.empty()) write_file(arguments_.access_log, replayer_.residency().access_log());
  return pixels_different_;
}

/// Between frames: reports those that are finished. The same command takes the run up again.
void JournalRun::leave_off() {
  report_.interrupted = true;
  folder_.write_report(report_, journal_);
}

void JournalRun::run_steps() {
  if (!folder_.kept().empty())
    resume();
  else if (first_step_ == 0)
    base_step();
  else
    start_late();
  while (steps_done_ < last_step_) journal_step(journal_.steps[steps_done_]);
  console_.part_done();
}

/// Goes to where the scene is after the first `steps` steps.
void JournalRun::apply_to(std::size_t steps) {
  const TraceScope span = console_.span("edits before");
  steps_done_ = steps;
  for (const Edit& edit : edits_to(journal_, steps)) {
    console_.check_interrupt();
    (void)replayer_.step(edit, journal_.file, journal_.path.parent_path());
  }
}

/// Without a frame of what lies before the first step asked for.
void JournalRun::start_late() {
  apply_to(first_step_ - 1);
  if (arguments_.baseline && !arguments_.verify_percent) full_render();
}

/// Takes over what is in the folder already, and goes where that left off.
void JournalRun::resume() {
  const auto start = std::chrono::steady_clock::now();
  report_.resumed = folder_.kept();
  for (const Json& entry : report_.resumed)
    if (entry.at("verify").is_object())
      pixels_different_ += entry.at("verify").at("pixels_different").get<std::uint64_t>();
  apply_to(std::min(report_.resumed.back().at("step").get<std::size_t>(), journal_.steps.size()));
  if (arguments_.baseline || arguments_.verify_percent) full_render();
  report_.resume_seconds = seconds_since(start);
  console_.line("resumed after step " + std::to_string(steps_done_) + ": " + std::to_string(report_.resumed.size()) +
                " finished frames kept");
}

/// The share of the run that a frame is, and what it is.
void JournalRun::show_part(const StepReport& entry) {
  const auto done = static_cast<double>(report_.resumed.size() + report_.steps.size());
  const auto all = static_cast<double>(frames_);
  const auto share = [&](double frames) { return (runs_before_ + frames / all) / runs_; };
  console_.part(share(done), share(done + 1),
                "step " + step_label(entry.step, entry.frame_in_step()) + " " + entry.name);
}

void JournalRun::base_step() {
  StepReport entry;
  entry.name = "base";
  show_part(entry);
  const Frame& frame = replayer_.image().frame;
  entry.counters.samples_total = std::uint64_t{frame.width} * frame.height * report_.view.samples;
  entry.counters.rebuilt.ray_trees = ray_trees_rebuilt_;
  if (arguments_.baseline && !arguments_.verify_percent) full_render();
  finish(std::move(entry), StepResult(), std::chrono::steady_clock::now());
}

/// Does a frame's work, writes it and notes it; its class. An entry that has reasons already keeps them and its class.
template <class Work>
ChangeClass JournalRun::frame(StepReport entry, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  console_.check_interrupt();
  show_part(entry);
  StepResult result;
  try {
    result = work();
  } catch (const ResourceError&) {  // with more memory the run goes on from here
    leave_off();
    throw;
  }
  if (entry.reasons.empty()) {
    entry.change = result.classification.change;
    entry.reasons = result.classification.reasons;
  }
  entry.counters = result.counters;
  entry.seconds = result.seconds;
  const ChangeClass change = entry.change;
  finish(std::move(entry), result, start);
  return change;
}

void JournalRun::journal_step(const JournalStep& step) {
  StepReport entry;
  entry.step = static_cast<std::uint32_t>(++steps_done_);
  entry.name = step.name;
  const std::filesystem::path folder = journal_.path.parent_path();
  const auto edit = [&](const Edit& patch) { return replayer_.step(patch, journal_.file, folder); };
  if (step.drag.empty() && step.wedge.empty()) {
    frame(entry, [&] { return edit(step.edit); });
    return;
  }
  StepReport last = entry;
  last.change = ChangeClass::color;
  std::uint32_t number = 0;
  for (const Edit& patch : frames_of(step)) {
    (step.drag.empty() ? entry.wedge_frame : entry.drag_frame) = ++number;
    const ChangeClass change =
        frame(entry, [&] { return step.drag.empty() ? edit(patch) : replayer_.drag(patch, journal_.file, folder); });
    last.change = combined(last.change, change);
  }
  if (step.drag.empty()) {
    last.reasons = {"the last value of the wedge stays"};
    frame(last, [&] { return edit({}); });
  } else {
    last.reasons = {"the selection is released where the last entry put it"};
    frame(last, [&] { return replayer_.release(); });
  }
}

void JournalRun::finish(StepReport entry, const StepResult& result, std::chrono::steady_clock::time_point start) {
  FrameMeta meta;
  meta.scene_hash = report_.scene_hash;
  meta.journal_hash = report_.journal_hash;
  folder_.write_step(entry, replayer_.image(), result.changed_pixels, std::move(meta),
                     arguments_.layers ? &replayer_.state().scene() : nullptr);
  if (arguments_.overlays) folder_.write_overlays(entry, replayer_, result);
  entry.seconds.total = seconds_since(start);
  entry.resident = replayer_.resident();
  entry.peak_rss_bytes = peak_rss_bytes();
  report_.steps.push_back(std::move(entry));
  if (arguments_.verify_percent) verify(report_.steps.back());
  folder_.note_step(report_.steps.back());
  trace_step(report_.steps.back(), start, console_.trace());
  print(report_.steps.back());
}

Frame JournalRun::full_render() {
  const SceneState fresh(replayer_.state().document(), report_.camera, replayer_.state().pyramids());
  RenderStats stats;
  const TraceScope span = console_.span("full render");
  Frame frame = render(fresh.scene(), report_.view, stats, console_.stage("full render"));
  console_.end_stage();
  if (!report_.full_render_seconds) report_.full_render_seconds = stats.build_seconds + stats.render_seconds;
  return frame;
}

void JournalRun::verify(StepReport& entry) {
  const std::size_t round = report_.resumed.size() + report_.steps.size() - 1;
  const FrameDifference difference =
      compare_frames(full_render(), replayer_.image().frame, *arguments_.verify_percent, round);
  entry.verify = VerifyResult{difference.pixels_compared, difference.pixels_different};
  pixels_different_ += difference.pixels_different;
}

void JournalRun::print(const StepReport& entry) {
  const Counters& counters = entry.counters;
  std::string line = step_label(entry.step, entry.frame_in_step()) + " " +
                     std::string(change_class_name(entry.change)) + " \"" + printable(entry.name) +
                     "\": " + std::to_string(counters.pixels_changed) + " pixels changed, " +
                     std::to_string(counters.ray_updates) + " ray updates, " + std::to_string(counters.shadow_updates) +
                     " shadow updates, " + std::to_string(entry.seconds.total) + " s";
  if (entry.verify)
    line += ", verified: " + std::to_string(entry.verify->pixels_different) + " of " +
            std::to_string(entry.verify->pixels_compared) + " pixels differ";
  console_.line(line);
}

}  // namespace relook
