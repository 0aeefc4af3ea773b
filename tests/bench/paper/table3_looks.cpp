#include "table3_looks.h"

#include "pixel_work.h"
#include "replay/chosen_parameters.h"
#include "tree_shares.h"

namespace relook {
namespace {

constexpr int kRuns = 9, kFirstRuns = 3;

/// The replays that are measured, side by side.
struct Bench {
  const BenchOptions& options;
  const Image& image;
  const Journal& journal;
  std::vector<Replayer> by_ray_trees;
  Replayer compressed;
  SearchTimer search;
  SceneState state;          // for what parameters are
  std::vector<Edit> so_far;  // done on all of them

  Bench(const BenchOptions& o, const Image& i, const Journal& j)
      : options(o), image(i), journal(j), compressed(load_scene(o), i), search(load_scene(o)), state(load_scene(o)) {
    for (const double share : kLookShares) {
      RegionOptions regions;  // without colour trees, so that each edit goes through the ray trees
      regions.ray_trees = share;
      regions.color_trees = 0;
      by_ray_trees.emplace_back(load_scene(o), i, regions);
    }
  }

  /// The fastest of some runs, each taken back.
  TimedStep there_and_back(Replayer& replayer, const Edit& edit, const Edit& inverse, int runs) const {
    TimedStep best;
    for (int run = 0; run < runs; ++run) {
      keep_faster(best, timed(replayer, StepKind::step, edit, journal));
      static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
    }
    return best;
  }

  /// The first edit of parameters whose colour trees have been built before any edit, as the paper's are.
  double first_of_chosen(const Edit& edit) {
    ParameterSet set;
    for (const PatchOperation& operation : edit) set.add(parameters_at(state, operation.path));
    TimedStep best;
    for (int run = 0; run < kFirstRuns; ++run) {
      Replayer replayer(load_scene(options), image);
      for (const Edit& before : so_far) static_cast<void>(timed(replayer, StepKind::step, before, journal));
      replayer.choose_parameters({set});
      keep_faster(best, timed(replayer, StepKind::step, edit, journal));
    }
    return best.seconds;
  }

  void time_compressed(const Edit& edit, const Edit& inverse, LookTimes& times) {
    const auto kept = static_cast<double>(compressed.resident().color_trees);
    const TimedStep first = timed(compressed, StepKind::step, edit, journal);
    times.first = first.seconds;
    times.samples = static_cast<double>(first.result.counters.samples_affected);
    times.column_bytes = static_cast<double>(compressed.resident().color_trees) - kept;
    static_cast<void>(timed(compressed, StepKind::step, inverse, journal));
    times.later = there_and_back(compressed, edit, inverse, kRuns).seconds;
    times.chosen = first_of_chosen(edit);
  }

  void time_optical(const Edit& edit, const Edit& inverse, const TimedStep& step, LookTimes& times) {
    Replayer& replayer = by_ray_trees.back();
    const Counters& counters = step.result.counters;
    times.segments_again =
        static_cast<double>(counters.ray_updates + counters.shadow_updates) / static_cast<double>(replayer.segments());
    static_cast<void>(timed(replayer, StepKind::step, edit, journal));
    times.work =
        time_pixel_work(replayer.state().scene(), image.view, step.result.changed_pixels.indices(image.frame.width));
    static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
  }

  /// Leaves the step done. No row: neither a colour nor an optical step.
  std::optional<LookTimes> time(const JournalStep& step) {
    const Edit edit = whole_edit(step), inverse = inverse_of(edit, state.document().look);
    LookTimes times;
    times.name = step.name;
    Replayer& all_trees = by_ray_trees.back();
    times.search = search.next(all_trees, edit, journal);
    const TimedStep once = timed(all_trees, StepKind::step, edit, journal);
    times.change = once.result.classification.change;
    times.pixels = static_cast<double>(once.result.counters.pixels_changed);
    static_cast<void>(timed(all_trees, StepKind::step, inverse, journal));
    const bool is_color = times.change == ChangeClass::color, is_optical = times.change == ChangeClass::optical;
    if (is_color || is_optical) {
      TimedStep best;
      for (std::size_t k = 0; k < kLookShares.size(); ++k) {
        best = there_and_back(by_ray_trees[k], edit, inverse, kRuns);
        times.by_ray_trees[k] = best.seconds;
      }
      if (is_color) time_compressed(edit, inverse, times);
      if (is_optical) time_optical(edit, inverse, best, times);
    }
    for (Replayer& replayer : by_ray_trees) static_cast<void>(timed(replayer, StepKind::step, edit, journal));
    static_cast<void>(timed(compressed, StepKind::step, edit, journal));
    apply_edit(state, edit, journal.file, journal.path.parent_path());
    so_far.push_back(edit);
    return is_color || is_optical ? std::optional(std::move(times)) : std::nullopt;
  }
};

}  // namespace

LookTable time_looks(const BenchOptions& options, const Image& image, const Journal& journal, FullRender& full) {
  Bench bench(options, image, journal);
  LookTable table;
  for (std::size_t k = 0; k < kLookShares.size(); ++k)
    table.kept[k] = share_of_trees_kept(bench.by_ray_trees[k].image());
  for (const JournalStep& step : journal.steps) {
    full.again();
    if (std::optional<LookTimes> times = bench.time(step)) table.rows.push_back(std::move(*times));
  }
  return table;
}

}  // namespace relook
