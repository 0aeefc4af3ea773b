// One journal replayed into one run folder: its frames, its report and its notes, from the start or from where an
// earlier run ended.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "color/expression/parameter_set.h"
#include "edit/journal_walk.h"
#include "image/cached_image.h"
#include "options/arguments.h"
#include "replay/journal_replay.h"
#include "report/report.h"
#include "run/run_folder.h"
#include "terminal/console.h"

namespace relook {

/// What a report says of the cache.
struct CacheFacts {
  std::string scene_hash;
  CacheSizes sizes;
  std::optional<double> noise;
  std::vector<std::string> damage;
  Moves rebuilt;  // what was damaged
};

/// Times a piece of work: by the clock, and what all threads of the process did.
class WorkClock {
 public:
  WorkClock();
  [[nodiscard]] std::chrono::steady_clock::time_point start() const { return start_; }
  [[nodiscard]] double seconds() const;
  [[nodiscard]] double cpu_seconds() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_start_;
};

/// One journal on its way into one run folder.
class JournalRun {
 public:
  /// `residency`: null, or with which the cache was opened.
  JournalRun(const Arguments& arguments, Console& console, const Journal& journal, RunPlan& plan, OpenedCache opened,
             std::unique_ptr<Residency> residency, const CacheFacts& cache,
             const PreviewStyle& previews);

  /// Goes on with the replayer of an earlier run of the same cache and the first steps of the same journal, `made` of
  /// them, as take_replayer() hands it over after reach_end().
  JournalRun(const Arguments& arguments, Console& console, const Journal& journal, RunPlan& plan, Replayer replayer,
             std::uint32_t made, const CacheFacts& cache, const PreviewStyle& previews);

  /// Builds the colour trees of these sets of parameters; no others will be kept.
  void choose_parameters(const std::vector<ParameterSet>& sets) {
    const TraceScope span = console_.span("colour trees of --params");
    replayer_.choose_parameters(sets);
  }
  /// `place`: of this run among `runs`, from 0. Writes the report at the end of the run, or when a signal or want of
  /// memory ends it; other errors leave none. Returns the number of pixels that --verify found different, in frames
  /// that were kept, too.
  std::uint64_t run(std::size_t place, std::size_t runs);
  /// Makes the edits of frames at the end that were there already. To be called after run().
  void reach_end() { catch_up(); }
  /// Hands over the replayer. To be called after run().
  [[nodiscard]] Replayer take_replayer() { return std::move(replayer_); }

 private:
  void describe(const CacheFacts& cache, const PreviewStyle& previews);
  void run_steps();
  void make_room_for_page();
  void leave_off();
  void catch_up();
  void run_frame(const JournalEvent& event);
  void pass_kept(const JournalEvent& event);
  void make_frame(const JournalEvent& event);
  [[nodiscard]] StepResult follow(const JournalEvent& event);
  void end_step(const JournalEvent& event);
  [[nodiscard]] StepReport new_entry(const JournalEvent& event) const;
  void show_part(const StepReport& entry);
  void finish(StepReport entry, const StepResult& result, const WorkClock& clock);
  void verify(StepReport& entry);
  [[nodiscard]] Frame full_render(FullRender& cost);
  [[nodiscard]] std::optional<FullRender> foreseen_full_render() const;
  void print_summary();
  void note_tunnel_damage();
  void warn_of_clipping(const StepReport& entry);

  const Arguments& arguments_;
  Console& console_;
  const Journal& journal_;
  RunPlan& plan_;
  RunFolder folder_;
  std::shared_ptr<StoredTunnels> tunnels_;  // of the cache; null: it has none
  Replayer replayer_;
  RunReport report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::uint64_t pixels_different_ = 0, pixels_compared_ = 0;
  Moves rebuilt_;                          // as the cache was read
  std::uint32_t made_ = 0;                 // so many steps are in the replayer's scene from the start
  JournalReplay replay_;                   // leads replayer_ from frame to frame
  bool follows_last_ = false;              // the frame to come follows the last one written: no edit lies between
  std::size_t frames_done_ = 0;            // of those asked for
  std::size_t frame_number_ = 0;           // of the journal, for the tiles that --verify takes
  std::optional<StepReport> step_so_far_;  // the last frame of the present drag or wedge, if it was made here
  ChangeClass step_class_ = ChangeClass::color;  // of its frames so far
  std::size_t clipped_frames_ = 0;               // that half cannot hold
  double runs_before_ = 0, runs_ = 1;            // of the command, for its progress
  std::optional<FullRender> baseline_;           // of the scene before any step
  std::uint64_t baseline_segments_ = 0;          // of its ray trees
};

}  // namespace relook
