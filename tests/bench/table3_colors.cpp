#include "table3_colors.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <thread>

#include "engine/chosen_parameters.h"

namespace relook {
namespace {

constexpr int kRuns = 9;

/// Brière & Poulin 1996, Table 3: seconds, where a full render takes 640.
struct PaperRow {
  const char* step;
  double ray_paths, all_ray_trees, color_trees, compressed;
  double selection;  // selection-dependent preprocessing with groups, which a first edit needs beside its colour trees
};
constexpr double kPaperFull = 640;
constexpr std::array<PaperRow, 4> kPaperRows{PaperRow{"leaves color left tree", 4.65, 1.26, 0.28, 0.23, 1.10},
                                             {"highlight left sphere", 0.94, 0.52, 0.12, 0.09, 1.10},
                                             {"marble color on Beethoven", 8.36, 4.91, 0.35, 0.32, 1.43},
                                             {"ground color", 7.60, 2.49, 0.47, 0.44, 1.59}};

/// Bytes a second that both threads read and write in a plain copy.
double copy_bandwidth() {
  constexpr std::size_t kBytes = std::size_t{128} << 20;
  std::vector<char> from(kBytes, 1), to(kBytes, 2);
  const double seconds = fastest(5, [&] {
    std::thread other([&] { std::memcpy(to.data(), from.data(), kBytes / 2); });
    std::memcpy(to.data() + kBytes / 2, from.data() + kBytes / 2, kBytes / 2);
    other.join();
  });
  return 2 * static_cast<double>(kBytes) / seconds;
}

struct ColorTimes {
  double from_trees = 0, first = 0, later = 0;  // seconds
  double chosen = 0;                            // the first edit of parameters chosen before, by --params
  double samples = 0, column_bytes = 0;
};

double fastest_there_and_back(Replayer& replayer, const Edit& edit, const Edit& inverse, const Journal& journal) {
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    const double seconds = timed(replayer, StepKind::step, edit, journal).seconds;
    if (run == 0 || seconds < best) best = seconds;
    static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
  }
  return best;
}

/// The first edit of parameters whose colour trees have been built before any edit, as the paper's are.
double first_of_chosen(const BenchOptions& options, const Image& image, const Edit& edit, const Journal& journal) {
  SceneState state = load_scene(options);
  ParameterSet set;
  for (const PatchOperation& operation : edit) set.add(parameters_at(state, operation.path));
  Replayer replayer(std::move(state), image);
  replayer.choose_parameters({set});
  return timed(replayer, StepKind::step, edit, journal).seconds;
}

ColorTimes time_step(Replayer& uncompressed, Replayer& compressed, const Edit& edit, const Journal& journal) {
  const Edit inverse = inverse_of(edit, compressed.state().document().look);
  ColorTimes times;
  times.from_trees = fastest_there_and_back(uncompressed, edit, inverse, journal);
  const auto kept = static_cast<double>(compressed.resident().color_trees);
  const TimedStep first = timed(compressed, StepKind::step, edit, journal);
  times.first = first.seconds;
  times.samples = static_cast<double>(first.result.counters.samples_affected);
  times.column_bytes = static_cast<double>(compressed.resident().color_trees) - kept;
  static_cast<void>(timed(compressed, StepKind::step, inverse, journal));
  times.later = fastest_there_and_back(compressed, edit, inverse, journal);
  return times;
}

/// A ratio to the full render, above the paper's.
void note_ratio(const BenchOptions& options, const PaperRow& row, const char* column, double ratio, double paper) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", kPaperFull / paper);
  options.note("Table 3, colour rows: full render / edit", row.step, column, ratio, "", text, Goal{kPaperFull / paper});
}

void print_row(const BenchOptions& options, const PaperRow& paper, const ColorTimes& times, double full_seconds,
               double bandwidth) {
  constexpr double kPixelBytes = 4 * sizeof(Rgba);  // colour and pixel of a sample, each read and written
  constexpr double kWedge = 25, kMostWedge = 3;
  const double moved = (times.column_bytes + times.samples * kPixelBytes) / times.later / bandwidth;
  const double wedge = (times.first + (kWedge - 1) * times.later) / times.first;
  std::printf(
      "%-26s %8.0f %8.2f %7.0f %8.2f %7.0f %8.2f %7.0f %8.2f %7.0f %6.0f / %.0f / %.0f / %-6.0f %6.1f %6.0f%% %6.1f\n",
      paper.step, times.samples, times.from_trees * 1e3, full_seconds / times.from_trees, times.first * 1e3,
      full_seconds / times.first, times.chosen * 1e3, full_seconds / times.chosen, times.later * 1e3,
      full_seconds / times.later, kPaperFull / paper.ray_paths, kPaperFull / paper.all_ray_trees,
      kPaperFull / paper.color_trees, kPaperFull / paper.compressed, times.column_bytes / times.samples, 100 * moved,
      wedge);
  note_ratio(options, paper, "from ray trees, nothing kept (paper: from ray paths)", full_seconds / times.from_trees,
             paper.ray_paths);
  note_ratio(options, paper, "first, nothing kept (paper: selection and colour trees)", full_seconds / times.first,
             paper.selection + paper.color_trees);
  note_ratio(options, paper, "first, colour trees kept (paper: the same)", full_seconds / times.chosen,
             paper.selection + paper.color_trees);
  note_ratio(options, paper, "later (paper: compressed)", full_seconds / times.later, paper.compressed);
  options.note("Table 3, colour rows: compressed colour trees", paper.step, "moved / a plain copy", 100 * moved, "%",
               "", Goal{50});
  options.note("Table 3, colour rows: compressed colour trees", paper.step, "25 values / one", wedge, "", "",
               Goal{kMostWedge, true});
  options.note("Table 3, colour rows: compressed colour trees", paper.step, "bytes a sample",
               times.column_bytes / times.samples, "", "310 to 516 (whole trees)", Goal{160, true});
}

}  // namespace

void print_colors(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds) {
  RegionOptions none;
  none.color_trees = 0;
  Replayer uncompressed(load_scene(options), image, none), compressed(load_scene(options), image);
  const double bandwidth = copy_bandwidth();
  std::printf(
      "\nTable 3, colour rows: milliseconds and full render / edit, from ray trees (no colour trees kept), for the "
      "first edit of a parameter\n(finding and compressing its samples, once), for the first of one that was chosen "
      "before (--params), for later ones (fastest of %d). Bytes: columns a sample.\nMoved: columns and pixels of later "
      "edits, share of a plain copy (%.0f GB/s read and written; to reach: 50 %%). Wedge: 25 values / one (a first "
      "edit and\n24 later ones; to reach: 3)\n",
      kRuns, bandwidth * 1e-9);
  std::printf("%-26s %8s %8s %7s %8s %7s %8s %7s %8s %7s %28s %6s %7s %6s\n", "step", "samples", "trees", "x", "first",
              "x", "chosen", "x", "later", "x", "paper: paths/trees/color/compr.", "bytes", "moved", "wedge");
  for (const JournalStep& step : journal.steps)
    for (const PaperRow& paper : kPaperRows)
      if (step.name == paper.step) {
        const Edit edit = whole_edit(step);
        ColorTimes times = time_step(uncompressed, compressed, edit, journal);
        times.chosen = first_of_chosen(options, image, edit, journal);
        print_row(options, paper, times, full_seconds, bandwidth);
      }
}

}  // namespace relook
