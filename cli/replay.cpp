// `relook replay`: journals against a cache, a run folder each.
#include <optional>
#include <set>

#include "base/memory.h"
#include "base/parallel.h"
#include "edit/apply.h"
#include "engine/chosen_parameters.h"
#include "engine/frame_layers.h"
#include "journal_run.h"
#include "load_cache.h"
#include "load_scene.h"
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

/// Of what --params names, each.
std::vector<ParameterSet> chosen_parameters(SceneState& state, const std::vector<std::string>& pointers) {
  std::vector<ParameterSet> sets;
  for (const std::string& pointer : pointers) sets.push_back(parameters_at(state, pointer));
  return sets;
}

/// The journals of the command line, their names distinct.
std::vector<Journal> read_journals(const Arguments& arguments) {
  std::vector<Journal> journals;
  std::set<std::string> names;
  for (std::size_t i = 1; i < arguments.inputs.size(); ++i) {
    journals.push_back(read_journal(arguments.inputs[i]));
    check_steps(arguments, journals.back());
    if (!names.insert(journals.back().name).second)
      throw UsageError("two journals are called \"" + journals.back().name + "\": their runs would share a folder");
  }
  return journals;
}

/// What --memory and --access-log ask for; null: nothing. The run folder is made to spill into.
std::unique_ptr<Residency> residency_of(const Arguments& arguments, const std::filesystem::path& folder) {
  const StructureOptions& structures = arguments.structures;
  if (!structures.memory_bytes && arguments.access_log.empty()) return nullptr;
  ResidencyOptions options;
  options.memory_bytes = structures.memory_bytes;
  const std::uint64_t tile_bytes = thread_count() * (std::uint64_t{26} << 20);  // about what works on tiles and writes
  options.reserve_bytes = options.memory_bytes.value_or(0) / 16 + tile_bytes;
  options.working_bytes = tile_bytes / 2;
  for (const EvictionPolicy policy : kEvictionPolicies)
    if (policy_name(policy) == structures.policy) options.policy = policy;
  options.spill_folder = arguments.spill.empty() ? folder : std::filesystem::path(arguments.spill);
  if (structures.disk_bytes) options.disk_bytes = *structures.disk_bytes;
  options.logs_accesses = !arguments.access_log.empty();
  if (arguments.spill.empty()) make_folders(folder);
  return std::make_unique<Residency>(std::move(options));
}

/// For another run from the same state.
OpenedCache copy_of(const OpenedCache& opened) {
  const SceneState& state = *opened.state;
  return {std::make_unique<SceneState>(state.document(), state.scene().camera, state.pyramids()), opened.image,
          opened.scene_hash, opened.losses};
}

std::uint64_t samples_in(const Image& image, const std::vector<std::size_t>& tiles) {
  std::uint64_t samples = 0;
  for (const std::size_t tile : tiles) samples += image.trees[tile].paths.size();
  return samples;
}

}  // namespace

ExitCode run_replay(const Arguments& arguments, Console& console) {
  if (arguments.structures.memory_bytes) give_back_large_blocks();
  const std::string& cache = arguments.inputs[0];
  const std::vector<Journal> journals = read_journals(arguments);
  const std::shared_ptr<const DisplayView> view = display_view_of_environment();
  const bool has_several = journals.size() > 1;
  std::vector<std::filesystem::path> folders;
  for (const Journal& journal : journals) {
    folders.push_back(arguments.output);
    if (has_several) folders.back() /= journal.name;
    RunFolder::refuse_foreign(folders.back());
  }
  Json manifest;
  require_sound(read_manifest(cache, manifest), cache);
  if (!arguments.access_log.empty()) write_file(arguments.access_log, kAccessLogHeader);  // found out before the work
  std::optional<TraceScope> reading(std::in_place, console.trace(), "read cache");
  std::unique_ptr<Residency> residency = residency_of(arguments, folders.front());
  OpenedCache opened = open_cache(cache, !arguments.strict, residency.get());
  std::vector<std::string> damage = sentences(opened.losses);
  for (std::string& sentence : damage) sentence = cache + ": " + sentence + "; traced again";
  console.warn(damage);
  if (!arguments.scene.empty() && load_document(arguments.scene, arguments.view).hash != opened.scene_hash)
    require_sound({CacheFault::other_scene, "", ""}, cache);
  if (arguments.layers) require_layers(opened.state->scene());
  const std::uint32_t shadow_bits = opened.image.view.shadow_bits;
  if (arguments.shadow_bits.value_or(shadow_bits) != shadow_bits)
    throw Error(ExitCode::cache_mismatch, cache, "",
                "the cache holds shadow counters of " + std::to_string(shadow_bits) +
                    " bits; preprocess again with --shadow-bits");
  const CacheFacts facts{opened.scene_hash, cache_sizes(manifest), damage,
                         samples_in(opened.image, opened.losses.tiles)};

  reading.reset();
  std::uint64_t pixels_different = 0;
  std::optional<TraceScope> checking(std::in_place, console.trace(), "check journals");
  for (const Journal& journal : journals) check_journal(*opened.state, journal);
  checking.reset();
  Json runs = Json::array();
  for (std::size_t i = 0; i < journals.size(); ++i) {
    if (i > 0 && !opened.state) {  // pieces of the run before may be anywhere
      residency = residency_of(arguments, folders[i]);
      opened = open_cache(cache, !arguments.strict, residency.get());
    }
    OpenedCache next = i + 1 < journals.size() && !residency ? copy_of(opened) : OpenedCache();
    const std::vector<ParameterSet> chosen = chosen_parameters(*opened.state, arguments.structures.params);
    JournalRun run(arguments, console, journals[i], std::exchange(opened, std::move(next)), std::move(residency), facts,
                   view, folders[i]);
    if (!chosen.empty()) run.choose_parameters(chosen);
    pixels_different += run.run(i, journals.size());
    runs.push_back({{"run", folders[i].string()}, {"report", report_json(run.report())}});
    if (i + 1 == journals.size()) keep_to_the_end(run.take_replayer());
  }
  console.json({{"runs", std::move(runs)}, {"pixels_different", pixels_different}});
  return pixels_different == 0 ? ExitCode::ok : ExitCode::difference;
}

}  // namespace relook
