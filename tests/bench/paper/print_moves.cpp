// The text that print_moves() prints for a MoveTable: our times beside the paper's, row by row.
#include <cstdio>

#include "paper.h"
#include "table3_moves.h"
#include "tree_shares.h"

namespace relook {
namespace {

/// One line of the table, or the mean of several.
struct Row {
  double seconds = 0, share = 0, work = 0, culled = 0;
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
void note_part(const BenchOptions& options, const std::string& name, const Row& row, double full_seconds,
               bool has_tunnels) {
  const char* const table = "Geometric rows, all ray trees";
  if (row.share > 0) {
    const auto goal = has_tunnels ? std::optional(Goal{1.5, true}) : std::nullopt;
    options.note(table, name, "time / ideal", row.seconds / (full_seconds * row.share), "", "", goal);
    if (row.work > 0) options.note(table, name, "time / work", row.seconds / row.work);
  }
  if (has_tunnels && row.culled > 0)
    options.note(table, name, "ray tests culled by tunnels", 100 * row.culled, "%", "65 to 90 %", Goal{95});
}

void print_part(const BenchOptions& options, const std::string& name, std::size_t tunnels, const char* part,
                const Row& row, double full_seconds) {
  std::printf("%-26.26s %zu %-14s %9.2f %9.1f", name.c_str(), tunnels, part, row.seconds * 1e3,
              full_seconds / row.seconds);
  const double ideal = full_seconds * row.share;
  if (row.share > 0)
    std::printf(" %8.2f%% %8.2f %7.2f %8.2f %7.2f", 100 * row.share, ideal * 1e3, row.seconds / ideal, row.work * 1e3,
                row.seconds / row.work);
  else
    std::printf(" %8.2f%% %8s %7s %8s %7s", 0.0, "-", "-", "-", "-");
  std::printf(" %8.1f%%\n", 100 * row.culled);
  note_part(options, name + ", " + std::to_string(tunnels) + " tunnel(s), " + part, row, full_seconds, tunnels > 0);
}

void print_parts(const BenchOptions& options, const std::string& name, std::size_t tunnels, const MoveTimes& times,
                 double full_seconds) {
  Row first, later, release, merged;
  first.add(times.first, times.first_work, options.pixels());
  for (std::size_t k = 0; k < times.later.size(); ++k) later.add(times.later[k], times.later_work[k], options.pixels());
  if (!times.later.empty()) later.divide(static_cast<double>(times.later.size()));
  release.add(times.release, 0, options.pixels());
  merged.add(times.merged, times.merged_work, options.pixels());
  print_part(options, name, tunnels, "remove + frame", first, full_seconds);
  if (!times.later.empty()) print_part(options, name, tunnels, "frame", later, full_seconds);
  print_part(options, name, tunnels, "release", release, full_seconds);
  print_part(options, name, tunnels, "merged", merged, full_seconds);
}

/// A part of a move in all columns.
void print_row(const BenchOptions& options, const MoveRow& row, const char* part, const std::vector<std::string>& heads,
               double (*seconds)(const MoveTimes&), const std::array<paper::ByTunnels, 3>& of_paper,
               double full_seconds) {
  std::vector<PaperCell> cells;
  for (std::size_t share = 0; share < kMoveShares.size(); ++share)
    for (std::size_t tunnels = 0; tunnels < kTunnelCounts; ++tunnels)
      cells.push_back({heads[cells.size()], seconds(row.times[share][tunnels]), of_paper[share][tunnels]});
  print_paper_row(options, "Table 3, geometric rows: full render / time", row.name + ", " + part, cells, full_seconds,
                  false);
}

}  // namespace

void print_moves(const BenchOptions& options, const MoveTable& table, double full_seconds) {
  std::printf(
      "\nTable 3, geometric rows, by share of ray trees (in brackets: truly kept) and tunnels a region: milliseconds "
      "and full render / time; below, the paper's. Rendering:\na frame of a drag, mean; removing: the first frame less "
      "the same frame drawn again, where the paper has one number for all columns; adding: the release\n");
  std::vector<std::string> heads, columns;
  for (std::size_t share = 0; share < kMoveShares.size(); ++share)
    for (std::size_t tunnels = 0; tunnels < kTunnelCounts; ++tunnels) {
      const std::string head = tree_share_head(kMoveShares[share], table.kept[share]);
      heads.push_back(tunnels == 0 ? head : "");
      columns.push_back(head + ", " + std::to_string(tunnels) + " tunnel(s)");
    }
  print_paper_head("", heads);
  print_paper_head("move", {"0 tunnels", "1", "2", "0 tunnels", "1", "2", "0 tunnels", "1", "2"});
  for (const MoveRow& row : table.rows) {
    const paper::Move of_paper = paper::move(row.name);
    std::array<paper::ByTunnels, 3> removing{};
    removing[0][0] = of_paper.removing;
    print_row(
        options, row, "removing", columns, [](const MoveTimes& times) { return times.removing(); }, removing,
        full_seconds);
    print_row(
        options, row, "rendering", columns, [](const MoveTimes& times) { return times.rendering(); },
        of_paper.rendering, full_seconds);
    print_row(
        options, row, "adding", columns, [](const MoveTimes& times) { return times.release.seconds; }, of_paper.adding,
        full_seconds);
  }
}

void print_move_details(const BenchOptions& options, const MoveTable& table, double full_seconds) {
  std::printf(
      "\nGeometric rows, all ray trees, more; by tunnels a region; ideal: the full render's share of pixels that "
      "change;\nwork: tracing and shading just these afresh; merged: the move as one step. To reach: time / ideal 1.5, "
      "culled 95 %% of ray tests (paper: 65 to 90 %%)\n");
  std::printf("%-26s %s %-14s %9s %9s %9s %8s %7s %8s %7s %9s\n", "step", "t", "part", "ms", "full/time", "changed",
              "ideal", "/ideal", "work", "/work", "culled");
  for (std::size_t tunnels = 0; tunnels < kTunnelCounts; ++tunnels)
    for (const MoveRow& row : table.rows) print_parts(options, row.name, tunnels, row.times[0][tunnels], full_seconds);
}

}  // namespace relook
