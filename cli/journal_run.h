// One journal replayed into one run folder: its frames, its report and its notes, from the start or from where an
// earlier run ended.
#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "arguments.h"
#include "color/parameter_set.h"
#include "console.h"
#include "edit/journal.h"
#include "engine/cached_image.h"
#include "engine/replay.h"
#include "engine/report.h"
#include "run_folder.h"

namespace relook {

/// What a report says of the cache.
struct CacheFacts {
  std::string scene_hash;
  CacheSizes sizes;
  std::vector<std::string> damage;
  std::uint64_t ray_trees_rebuilt = 0;
};

/// Replays one journal into one run folder.
class JournalRun {
 public:
  /// `residency`: null, or with which the cache was opened.
  JournalRun(const Arguments& arguments, Console& console, const Journal& journal, OpenedCache opened,
             std::unique_ptr<Residency> residency, const CacheFacts& cache,
             const std::shared_ptr<const DisplayView>& view, const std::filesystem::path& folder);

  /// Builds their colour trees; no others will be kept.
  void choose_parameters(const std::vector<ParameterSet>& sets) {
    const TraceScope span = console_.span("colour trees of --params");
    replayer_.choose_parameters(sets);
  }
  /// `place`: of this run among `runs`, from 0. Writes the report at the end of the run, or when a signal or want of
  /// memory ends it; other errors leave none. Returns the number of pixels that --verify found different.
  std::uint64_t run(std::size_t place, std::size_t runs);
  [[nodiscard]] const RunReport& report() const { return report_; }
  /// After run().
  [[nodiscard]] Replayer take_replayer() { return std::move(replayer_); }

 private:
  void run_steps();
  void leave_off();
  void apply_to(std::size_t steps);
  void start_late();
  void resume();
  void base_step();
  void show_part(const StepReport& entry);
  void journal_step(const JournalStep& step);
  template <class Work>
  ChangeClass frame(StepReport entry, const Work& work);
  void finish(StepReport entry, const StepResult& result, std::chrono::steady_clock::time_point start);
  void verify(StepReport& entry);
  Frame full_render();
  void print(const StepReport& entry);

  const Arguments& arguments_;
  Console& console_;
  const Journal& journal_;
  RunFolder folder_;
  Replayer replayer_;
  RunReport report_;
  std::uint64_t pixels_different_ = 0, ray_trees_rebuilt_ = 0;
  std::size_t steps_done_ = 0;                  // of the journal
  std::size_t first_step_ = 0, last_step_ = 0;  // whose frames are asked for
  std::size_t frames_ = 0;                      // of these steps
  double runs_before_ = 0, runs_ = 1;           // of the command, for its progress
};

}  // namespace relook
