// Selection-dependent preprocessing (paper 3.1): the regions that depend on what steps edit, kept as long as steps
// change colours or optics, also where they edit several things in turn. What has the least information weight goes
// first (paper 4.3).
#pragma once
#include <cstdint>
#include <vector>

#include "region/quadtree.h"
#include "replay/path_tasks.h"

namespace relook {

class KeptSelection {
 public:
  /// `most_bytes`: of what all steps have found; the last one's is kept in any case.
  explicit KeptSelection(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The leaves that depend on the things that `change` edits, by tile, if a step that is remembered edited the same;
  /// else null. Optical steps may have made them more than depend on them now, never fewer.
  [[nodiscard]] const std::vector<Leaves>* leaves(const StepChange& change) const;
  /// What to do with each path: that step's, if no path has changed since; else found.
  [[nodiscard]] PathTasks find_tasks(const StepChange& change, const PathSearch& search, ProgramTable& programs) const;

  /// Notes what a step has found, in `seconds`. What moves anything makes it forget all.
  void keep(const StepChange& change, PathTasks tasks, std::vector<Leaves> leaves, double seconds);

  [[nodiscard]] std::size_t size() const { return found_.size(); }
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  struct Found {
    ColorChange colors;
    std::vector<std::uint8_t> objects;  // flags of RayChange
    PathTasks tasks;
    std::vector<Leaves> leaves;
    bool paths_changed = false;
    double seconds = 0;
    std::uint64_t last_use = 0, uses = 0;

    [[nodiscard]] bool is_of(const StepChange& change) const {
      return colors == change.colors && objects == change.rays.objects;
    }
    [[nodiscard]] std::uint64_t bytes() const;
  };
  [[nodiscard]] const Found* find(const StepChange& change) const;
  void note_structures(const ColorChange& colors);
  void note_paths(const std::vector<Leaves>& leaves);
  void trim();

  std::uint64_t most_bytes_, steps_ = 0;
  std::vector<Found> found_;  // the last step's at the end
};

}  // namespace relook
