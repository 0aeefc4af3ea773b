// A step that changes colour parameters alone (paper 2.1, 3.3): the samples that depend on them are compressed when
// the parameters change first, and afterwards only the residual programs are run.
#pragma once
#include "base/pool.h"
#include "replay/replay_parts.h"
#include "replay/step_result.h"

namespace relook {

/// Works on the parts of a replay, which outlive it.
class Recolorer {
 public:
  explicit Recolorer(ReplayParts& parts) : parts_(parts) {}

  /// Compresses what depends on the parameters of `change`, unless it is already, and evaluates it. Requires:
  /// is_compressible(change.colors); no tree is touched; nothing is shown on top of the image.
  void recolor(const StepChange& change, StepResult& result, StopWatch& watch) { run(change, true, result, watch); }
  /// The same without evaluating it, for edits to come.
  void compress(const StepChange& change) {
    StepResult result;
    StopWatch watch;
    run(change, false, result, watch);
  }

 private:
  struct Search;
  [[nodiscard]] Search search(const StepChange& change, const ColorTreeSet& kept, StepResult& result, StopWatch& watch);
  /// The tile's turn comes soon.
  void expect(const ColorTreeSet& kept, std::size_t tile) const;
  void run(const StepChange& change, bool evaluates, StepResult& result, StopWatch& watch);

  ReplayParts& parts_;
  Pool<ColorMemory> memory_;
};

}  // namespace relook
