#include "table3_moves.h"

#include "pixel_work.h"
#include "tree_shares.h"

namespace relook {
namespace {

constexpr int kRounds = 3;

/// One replay with a share of the ray trees and a number of tunnels.
class MoveBench {
 public:
  /// `measures_work`: too.
  MoveBench(Replayer& replayer, const Journal& journal, bool measures_work)
      : replayer_(replayer), journal_(journal), measures_work_(measures_work) {}

  /// Times all parts of a move and leaves it done. `inverse`: takes it back. The move has been done and taken back
  /// before, so that all structures stand.
  [[nodiscard]] MoveTimes time(const JournalStep& step, const Edit& inverse) {
    const Edit edit = whole_edit(step);
    MoveTimes times;
    for (int round = 0; round < kRounds; ++round) time_drag(step, inverse, times, measures_work_ && round == 0);
    for (int round = 0; round < kRounds; ++round) {
      if (round > 0) static_cast<void>(timed(replayer_, StepKind::step, inverse, journal_));
      keep_faster(times.merged, timed(replayer_, StepKind::step, edit, journal_));
    }
    if (measures_work_) times.merged_work = work(times.merged);
    return times;
  }

 private:
  [[nodiscard]] double work(const TimedStep& step) const {
    const Image& image = replayer_.image();
    return time_pixel_work(replayer_.state().scene(), image.view,
                           step.result.changed_pixels.indices(image.frame.width));
  }

  /// Times one drag and takes it back.
  void time_drag(const JournalStep& step, const Edit& inverse, MoveTimes& times, bool measures_work) {
    const std::vector<Edit> entries = step.drag.empty() ? std::vector<Edit>{step.edit} : step.drag;
    TimedStep first = timed(replayer_, StepKind::drag, entries[0], journal_);
    if (measures_work) times.first_work = work(first);
    keep_faster(times.first, std::move(first));
    keep_faster(times.again, timed(replayer_, StepKind::drag, entries[0], journal_));
    times.later.resize(entries.size() - 1);
    for (std::size_t k = 1; k < entries.size(); ++k) {
      TimedStep later = timed(replayer_, StepKind::drag, entries[k], journal_);
      if (measures_work) times.later_work.push_back(work(later));
      keep_faster(times.later[k - 1], std::move(later));
    }
    keep_faster(times.release, timed_release(replayer_));
    static_cast<void>(timed(replayer_, StepKind::step, inverse, journal_));
  }

  Replayer& replayer_;
  const Journal& journal_;
  bool measures_work_;
};

}  // namespace

double MoveTimes::rendering() const {
  double seconds = again.seconds;
  for (const TimedStep& frame : later) seconds += frame.seconds;
  return seconds / static_cast<double>(1 + later.size());
}

MoveTable time_moves(const BenchOptions& options, const Image& image, const Journal& journal, FullRender& full) {
  MoveTable table;
  for (std::size_t share = 0; share < kMoveShares.size(); ++share)
    for (std::size_t tunnels = 0; tunnels < kTunnelCounts; ++tunnels) {
      RegionOptions regions;
      regions.tunnels = tunnels;
      regions.ray_trees = kMoveShares[share];
      Replayer replayer(load_scene(options), image, regions);
      table.kept[share] = share_of_trees_kept(replayer.image());
      MoveBench bench(replayer, journal, share == 0);
      std::size_t row = 0;
      for (const JournalStep& step : journal.steps) {
        full.again();
        const Edit edit = whole_edit(step), inverse = inverse_of(edit, replayer.state().document().look);
        const TimedStep once = timed(replayer, StepKind::step, edit, journal);
        if (step.drag.empty() && once.result.classification.change != ChangeClass::geometric) continue;
        static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
        if (row == table.rows.size()) table.rows.push_back({step.name, {}});
        table.rows[row++].times[share][tunnels] = bench.time(step, inverse);
      }
    }
  return table;
}

}  // namespace relook
