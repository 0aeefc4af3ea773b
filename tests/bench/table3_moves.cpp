#include "table3_moves.h"

#include <array>
#include <cstdio>

#include "pixel_work.h"

namespace relook {
namespace {

constexpr std::size_t kTunnelCounts = 3;
constexpr int kRounds = 3;

// Brière & Poulin 1996, Table 3, "transform central sphere", all ray trees, by number of tunnels: seconds, where a full
// render takes 640. The columns of the other geometric rows cannot be told apart in the text at hand.
constexpr double kPaperFull = 640, kPaperRemoving = 51;
constexpr std::array<double, kTunnelCounts> kPaperRendering{37.8, 8.8, 7.8}, kPaperReleasing{38.4, 13.3, 12.2};

/// Parts of a move; those of the paper's three steps, and the move as one step.
struct MoveTimes {
  TimedStep first;               // removing and the first frame
  std::vector<TimedStep> later;  // intermediate frames
  TimedStep release, merged;
  double first_work = 0, merged_work = 0;  // see time_pixel_work()
  std::vector<double> later_work;
};

/// The entries of a drag; of an edit: there, back, and there again.
std::vector<Edit> entries_of(const JournalStep& step, const Edit& inverse) {
  if (step.drag.empty()) return {step.edit, inverse, step.edit};
  return step.drag;
}

/// Times one drag and takes it back.
void time_drag(Replayer& replayer, const std::vector<Edit>& entries, const Edit& inverse, const Journal& journal,
               MoveTimes& times) {
  const ViewOptions& view = replayer.image().view;
  const bool is_first_round = times.later_work.empty();
  const auto work = [&](const TimedStep& step) {
    return time_pixel_work(replayer.state().scene(), view,
                           step.result.changed_pixels.indices(replayer.image().frame.width));
  };
  TimedStep first = timed(replayer, StepKind::drag, entries[0], journal);
  if (is_first_round) times.first_work = work(first);
  keep_faster(times.first, std::move(first));
  times.later.resize(entries.size() - 1);
  for (std::size_t k = 1; k < entries.size(); ++k) {
    TimedStep later = timed(replayer, StepKind::drag, entries[k], journal);
    if (is_first_round) times.later_work.push_back(work(later));
    keep_faster(times.later[k - 1], std::move(later));
  }
  keep_faster(times.release, timed_release(replayer));
  static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
}

/// Times all parts of a move and leaves it done. `edit`: has been done and taken back before, so that all structures
/// stand.
MoveTimes time_move(Replayer& replayer, const JournalStep& step, const Edit& inverse, const Journal& journal) {
  const Edit edit = whole_edit(step);
  const std::vector<Edit> entries = entries_of(step, inverse);
  MoveTimes times;
  for (int round = 0; round < kRounds; ++round) time_drag(replayer, entries, inverse, journal, times);
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
    keep_faster(times.merged, timed(replayer, StepKind::step, edit, journal));
  }
  times.merged_work = time_pixel_work(replayer.state().scene(), replayer.image().view,
                                      times.merged.result.changed_pixels.indices(replayer.image().frame.width));
  return times;
}

/// One line of the table, or the mean of several.
struct Row {
  double seconds = 0, share = 0, work = 0, culled = 0;  // culled: by tunnels alone
  void add(const TimedStep& step, double step_work, double pixels) {
    const Counters& counters = step.result.counters;
    const CulledSegments& by = counters.culled;
    const auto tests = static_cast<double>(counters.ray_tests + by.boxes + by.tunnels);  // there would be without them
    seconds += step.seconds;
    share += static_cast<double>(counters.pixels_changed) / pixels;
    work += step_work;
    if (tests > 0) culled += static_cast<double>(by.tunnels) / tests;
  }
  void divide(double count) {
    seconds /= count;
    share /= count;
    work /= count;
    culled /= count;
  }
};

/// Releasing a selection changes no pixel, and has no ideal.
void note_row(const BenchOptions& options, const std::string& name, const Row& row, double full_seconds,
              double paper_seconds, bool has_tunnels) {
  const char* const table = "Table 3, geometric rows";
  char paper[32] = "";
  if (paper_seconds > 0) std::snprintf(paper, sizeof paper, "%.1f", kPaperFull / paper_seconds);
  options.note(table, name, "full render / time", full_seconds / row.seconds, "", paper);
  if (row.share > 0) {
    const auto goal = has_tunnels ? std::optional(Goal{1.5, true}) : std::nullopt;
    options.note(table, name, "time / ideal", row.seconds / (full_seconds * row.share), "", "", goal);
    if (row.work > 0) options.note(table, name, "time / work", row.seconds / row.work);
  }
  if (has_tunnels && row.culled > 0)
    options.note(table, name, "ray tests culled by tunnels", 100 * row.culled, "%", "65 to 90 %", Goal{95});
}

/// `paper_seconds`: of this part; 0: not known.
void print_row(const BenchOptions& options, const std::string& name, std::size_t tunnels, const char* part,
               const Row& row, double full_seconds, double paper_seconds) {
  std::printf("%-26.26s %zu %-14s %9.2f %9.1f", name.c_str(), tunnels, part, row.seconds * 1e3,
              full_seconds / row.seconds);
  if (paper_seconds > 0)
    std::printf(" %7.1f", kPaperFull / paper_seconds);
  else
    std::printf(" %7s", "-");
  const double ideal = full_seconds * row.share;
  if (row.share > 0)
    std::printf(" %8.2f%% %8.2f %7.2f %8.2f %7.2f", 100 * row.share, ideal * 1e3, row.seconds / ideal, row.work * 1e3,
                row.seconds / row.work);
  else
    std::printf(" %8.2f%% %8s %7s %8s %7s", 0.0, "-", "-", "-", "-");
  std::printf(" %8.1f%%\n", 100 * row.culled);
  note_row(options, name + ", " + std::to_string(tunnels) + " tunnel(s), " + part, row, full_seconds, paper_seconds,
           tunnels > 0);
}

void print_move(const BenchOptions& options, const std::string& name, std::size_t tunnels, const MoveTimes& times,
                double full_seconds) {
  const bool is_known = name == "transform central sphere" && tunnels < kTunnelCounts;
  const double rendering = is_known ? kPaperRendering[tunnels] : 0;
  const double releasing = is_known ? kPaperReleasing[tunnels] : 0;
  const double removing = is_known ? kPaperRemoving : 0;
  Row first, later, release, merged;
  first.add(times.first, times.first_work, options.pixels());
  for (std::size_t k = 0; k < times.later.size(); ++k) later.add(times.later[k], times.later_work[k], options.pixels());
  if (!times.later.empty()) later.divide(static_cast<double>(times.later.size()));
  release.add(times.release, 0, options.pixels());
  merged.add(times.merged, times.merged_work, options.pixels());
  print_row(options, name, tunnels, "remove + frame", first, full_seconds, removing + rendering);
  if (!times.later.empty()) print_row(options, name, tunnels, "frame", later, full_seconds, rendering);
  print_row(options, name, tunnels, "release", release, full_seconds, releasing);
  print_row(options, name, tunnels, "merged", merged, full_seconds, removing + rendering + releasing);
}

/// Walks the journal, the moves step by step.
void print_journal(const BenchOptions& options, Replayer& replayer, const Journal& journal, double full_seconds) {
  for (const JournalStep& step : journal.steps) {
    const Edit edit = whole_edit(step);
    const Edit inverse = inverse_of(edit, replayer.state().document().look);
    const TimedStep once = timed(replayer, StepKind::step, edit, journal);
    const ChangeClass change = once.result.classification.change;
    if (step.drag.empty() && change != ChangeClass::geometric) continue;
    static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
    const MoveTimes times = time_move(replayer, step, inverse, journal);
    print_move(options, step.name, replayer.regions().options().tunnels, times, full_seconds);
  }
}

}  // namespace

void print_moves(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds) {
  std::printf(
      "\nTable 3, geometric rows: fastest of %d; by tunnels a region; ideal: the full render's share of pixels "
      "that change;\nwork: tracing and shading just these afresh. To reach: time / ideal 1.5, culled 95 %% of "
      "ray tests (paper: 65 to 90 %%)\n",
      kRounds);
  std::printf("%-26s %s %-14s %9s %9s %7s %9s %8s %7s %8s %7s %9s\n", "step", "t", "part", "ms", "full/time", "paper",
              "changed", "ideal", "/ideal", "work", "/work", "culled");
  for (std::size_t tunnels = 0; tunnels < kTunnelCounts; ++tunnels) {
    Replayer replayer(load_scene(options), image, {.tunnels = tunnels});
    print_journal(options, replayer, journal, full_seconds);
  }
}

}  // namespace relook
