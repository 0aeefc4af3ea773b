// `relook replay`: journals against a cache, a run folder each.
#include <optional>
#include <set>

#include "base/parallel.h"
#include "base/system/memory.h"
#include "cache/manifest.h"
#include "edit/apply.h"
#include "frame/frame_layers.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "input/run_input.h"
#include "options/outputs.h"
#include "page/index_page.h"
#include "replay/chosen_parameters.h"
#include "replay/memory_needs.h"
#include "report/run_source.h"
#include "run/cache_structures.h"
#include "run/journal_run.h"
#include "run/run_index.h"
#include "verbs.h"

namespace relook {
namespace {

void check_steps(const Arguments& arguments, const Journal& journal) {
  if (!arguments.steps) return;
  const std::size_t last = arguments.steps->last.value_or(arguments.steps->first);
  if (last > journal.steps.size())
    throw UsageError("--steps: " + std::to_string(last) + " is beyond the " + std::to_string(journal.steps.size()) +
                     " steps of " + journal.file);
}

/// A set of parameters for each pointer of --params.
std::vector<ParameterSet> chosen_parameters(SceneState& state, const std::vector<std::string>& pointers) {
  std::vector<ParameterSet> sets;
  for (const std::string& pointer : pointers) sets.push_back(parameters_at(state, pointer));
  return sets;
}

/// The journals of the command line, their names distinct.
std::vector<Journal> read_journals(const Arguments& arguments, const Console& console) {
  std::vector<Journal> journals;
  std::set<std::string> names;
  for (std::size_t i = 1; i < arguments.inputs.size(); ++i) {
    journals.push_back(read_journal(arguments.inputs[i], [&] { console.check_interrupt(); }));
    check_steps(arguments, journals.back());
    if (!names.insert(journals.back().name).second)
      throw UsageError("two journals are called \"" + journals.back().name + "\": their runs would share a folder");
  }
  return journals;
}

/// The folder, or the nearest one above it that is there.
std::filesystem::path existing_folder(std::filesystem::path folder) {
  std::error_code error;
  while (!folder.empty() && !std::filesystem::is_directory(folder, error)) folder = folder.parent_path();
  return folder.empty() ? "." : folder;
}

/// What --memory and --access-log ask for; null: nothing.
std::unique_ptr<Residency> residency_of(const Arguments& arguments, const std::filesystem::path& folder) {
  const StructureOptions& structures = arguments.structures;
  if (!structures.memory_bytes && arguments.access_log.empty()) return nullptr;
  ResidencyOptions options;
  options.memory_bytes = structures.memory_bytes;
  const std::uint64_t tile_bytes = thread_count() * (std::uint64_t{26} << 20);  // about what works on tiles and writes
  options.reserve_bytes = options.memory_bytes.value_or(0) / 16 + tile_bytes;
  for (const EvictionPolicy policy : kEvictionPolicies)
    if (policy_name(policy) == structures.policy) options.policy = policy;
  options.spill_folder = arguments.spill.empty() ? existing_folder(folder) : std::filesystem::path(arguments.spill);
  if (structures.disk_bytes) options.disk_bytes = *structures.disk_bytes;
  options.logs_accesses = !arguments.access_log.empty();
  return std::make_unique<Residency>(std::move(options));
}

/// A copy of the opened cache, for another run from the same state.
OpenedCache copy_of(const OpenedCache& opened) {
  const SceneState& state = *opened.state;
  return {std::make_unique<SceneState>(state.document(), state.scene().camera, state.pyramids(),
                                       state.scene().integrator),
          opened.image,
          opened.scene_hash,
          opened.losses,
          opened.rebuilt,
          opened.tunnels,
          opened.manifest};
}

/// The runs that are to be made, one a journal. Throws UsageError when anything is in the way of one.
std::vector<RunPlan> plan_runs(const Arguments& arguments, const std::vector<Journal>& journals, const Json& manifest,
                               const DisplayView* view) {
  const FrameStyle style{arguments.float_frames, arguments.layers, view != nullptr ? view->id() : ""};
  std::vector<RunPlan> plans;
  plans.reserve(journals.size());
  if (journals.size() > 1) require_free_index(arguments.output);
  for (const Journal& journal : journals) {
    std::filesystem::path folder = arguments.output;
    if (journals.size() > 1) folder /= journal.name;
    require_not_outputs(arguments, files_of(journal), "a file of the journal");
    plans.emplace_back(arguments, journal, std::move(folder), run_source(manifest, style));
  }
  return plans;
}

std::string difference_text(std::uint64_t pixels_different) {
  return pixels_different == 0 ? ""
                               : ", of which " + std::to_string(pixels_different) + " pixels differ from full renders";
}

Json result_json(const Arguments& arguments, const RunPlan& plan) {
  Json result{{"run", printable(plan.folder().string())}, {"frames", plan.frames()}, {"kept", plan.kept_frames()}};
  if (arguments.json && arguments.report != ReportKind::none) {
    const std::string file = (plan.folder() / kReportName).string();
    result["report"] = parse_json(text_of(read_file(file)), file);
  }
  return result;
}

/// RUN/index.html, over the runs of this command and others beside them.
void write_index_of(const std::vector<RunPlan>& plans) {
  const std::filesystem::path folder = plans.front().folder().parent_path();
  write_index(folder / kIndexName, runs_at(folder));
}

void require_fitting(const Arguments& arguments, const OpenedCache& opened) {
  const std::string& cache = arguments.inputs[0];
  if (!arguments.scene.empty()) {
    const LoadedDocument loaded = load_document(arguments.scene, arguments.view);
    require_not_outputs(arguments, loaded.files, "a file of the scene");
    if (loaded.hash != opened.scene_hash) require_sound({CacheFault::other_scene, "", ""}, cache);
  }
  if (arguments.layers || arguments.relight) require_layers(opened.state->scene());
  if (arguments.relight && opened.image.view.integrator != Integrator::path)
    throw UsageError("--relight: frames of --integrator whitted are no sums of lights; preprocess with path");
  if (opened.image.view.integrator == Integrator::path) return;  // it has no counters
  const std::uint32_t shadow_bits = opened.image.view.shadow_bits;
  if (arguments.shadow_bits.value_or(shadow_bits) != shadow_bits)
    throw Error(ExitCode::cache_mismatch, cache, "",
                "the cache holds shadow counters of " + std::to_string(shadow_bits) +
                    " bits; preprocess again with --shadow-bits");
}

/// Replays the journals of one command, one after the other, each from the state of the cache.
class ReplayCommand {
 public:
  ReplayCommand(const Arguments& arguments, Console& console, const std::vector<Journal>& journals,
                std::vector<RunPlan>& plans, const Json& manifest, PreviewStyle previews)
      : arguments_(arguments),
        console_(console),
        journals_(journals),
        plans_(plans),
        manifest_text_(manifest.dump(1) + "\n"),
        previews_(std::move(previews)) {
    const Interrupt::Expendable nothing_made(console.interrupt());
    open_cache_anew();
    std::vector<std::string> damage = sentences(opened_.losses);
    for (std::string& sentence : damage) sentence = arguments.inputs[0] + ": " + sentence + "; traced again";
    console.warn(damage);
    require_fitting(arguments, opened_);
    facts_ = {opened_.scene_hash, cache_sizes(manifest), noise_of(manifest), damage, opened_.rebuilt};
    const TraceScope checking = console.span("check journals");
    for (const Journal& journal : journals) console.warn(check_journal(*opened_.state, journal));
  }

  /// The number of pixels that --verify found different.
  std::uint64_t run(std::size_t i) {
    if (!opened_.state) open_cache_anew();  // pieces of the run before may be anywhere
    const bool is_last = i + 1 == plans_.size();
    OpenedCache next = !is_last && !residency_ ? copy_of(opened_) : OpenedCache();
    if (residency_ && residency_->is_limited()) foresee_needs(journals_[i]);
    const std::vector<ParameterSet> chosen = chosen_parameters(*opened_.state, arguments_.structures.params);
    JournalRun run(arguments_, console_, journals_[i], plans_[i], std::exchange(opened_, std::move(next)),
                   std::move(residency_), facts_, previews_);
    if (!chosen.empty()) run.choose_parameters(chosen);
    const std::uint64_t different = run.run(i, plans_.size());
    if (is_last) keep_to_the_end(run.take_replayer());
    return different;
  }

 private:
  void foresee_needs(const Journal& journal) {
    const bool renders_aside = arguments_.verify_percent || arguments_.baseline;
    const bool needs_rays = shoots_rays(*opened_.state, journal);
    const ReplayWork work{needs_rays, renders_aside, arguments_.report == ReportKind::html};
    residency_->set_needs(memory_needs(opened_.state->scene(), thread_count(), work));
  }

  void open_cache_anew() {
    const TraceScope reading = console_.span("read cache");
    residency_ = residency_of(arguments_, plans_.front().folder());
    opened_ = open_cache(arguments_.inputs[0], !arguments_.strict, residency_.get());
    // The runs are planned, and perhaps begun, as of one cache.
    if (manifest_text(*opened_.manifest) != manifest_text_)
      throw Error(ExitCode::busy, arguments_.inputs[0], "",
                  "another program has exchanged the cache meanwhile; the same command again replays the new one");
  }

  const Arguments& arguments_;
  Console& console_;
  const std::vector<Journal>& journals_;
  std::vector<RunPlan>& plans_;
  std::string manifest_text_;  // of the cache that the runs are of
  PreviewStyle previews_;
  std::unique_ptr<Residency> residency_;
  OpenedCache opened_;
  CacheFacts facts_;
};

/// `manifest`: of the cache. Throws Error with exit code 3 if it is of another integrator than the command line says.
void require_integrator(const Json& manifest, const Arguments& arguments) {
  const std::string& cache = arguments.inputs[0];
  const Integrator integrator = integrator_of(manifest);
  if (arguments.integrator.value_or(integrator) != integrator)
    throw Error(ExitCode::cache_mismatch, cache, "",
                "the cache is of --integrator " + std::string(integrator_word(integrator)) +
                    "; preprocess again with --integrator " + std::string(integrator_word(*arguments.integrator)));
}

}  // namespace

ExitCode run_replay(const Arguments& given, Console& console) {
  Arguments arguments = given;
  if (arguments.structures.memory_bytes) give_back_large_blocks();
  const std::string& cache = arguments.inputs[0];
  const std::vector<Journal> journals = read_journals(arguments, console);
  const PreviewStyle previews{display_view_of_environment(), arguments.exposure};
  Json manifest;
  require_sound(read_manifest(cache, manifest), cache);
  require_integrator(manifest, arguments);
  take_structures_of(manifest, arguments, console);
  std::vector<RunPlan> plans = plan_runs(arguments, journals, manifest, previews.view.get());
  for (const RunPlan& plan : plans) console.warn(plan.warnings());
  if (!arguments.access_log.empty()) write_file(arguments.access_log, kAccessLogHeader);  // found out before the work
  // The cache is opened for complete runs, too: it and the journals must be as the command says.
  ReplayCommand command(arguments, console, journals, plans, manifest, previews);
  std::uint64_t pixels_different = 0;
  Json runs = Json::array();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const bool is_complete = plans[i].is_complete();
    if (is_complete)
      console.line(printable(plans[i].folder().string()) + ": complete, all " + std::to_string(plans[i].frames()) +
                   " frames are there" + difference_text(plans[i].pixels_different()));
    pixels_different += is_complete ? plans[i].pixels_different() : command.run(i);
    runs.push_back(result_json(arguments, plans[i]));
  }
  if (plans.size() > 1 && arguments.report == ReportKind::html) write_index_of(plans);
  console.json({{"runs", std::move(runs)}, {"pixels_different", pixels_different}});
  return pixels_different == 0 ? ExitCode::ok : ExitCode::difference;
}

}  // namespace relook
