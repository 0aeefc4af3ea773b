// Selection-dependent preprocessing (paper 3.1): the regions that depend on what a step edits, kept for the next steps
// as long as these change colours or optics of the same things.
#pragma once
#include <optional>
#include <vector>

#include "engine/path_tasks.h"
#include "region/quadtree.h"

namespace relook {

class KeptSelection {
 public:
  /// The leaves that depend on the things that `change` edits, by tile, if the last step edited the same; else null. An
  /// optical step may have made them more than depend on them now, never fewer: only trees in them have changed.
  [[nodiscard]] const std::vector<Leaves>* leaves(const StepChange& change) const;
  /// What to do with each path: the last step's, under the same condition and if no path has changed since; else found.
  [[nodiscard]] PathTasks find_tasks(const StepChange& change, const PathSearch& search, ProgramTable& programs) const;

  /// Notes what a step has found, unless it moves anything.
  void keep(const StepChange& change, PathTasks tasks, std::vector<Leaves> leaves);

 private:
  [[nodiscard]] bool is_same(const StepChange& change) const;

  struct Found {
    ColorChange colors;
    std::vector<std::uint8_t> objects;  // flags of RayChange
    PathTasks tasks;
    std::vector<Leaves> leaves;
    bool paths_changed = false;
  };
  std::optional<Found> found_;
};

}  // namespace relook
