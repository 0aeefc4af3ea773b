#include "engine/kept_selection.h"

namespace relook {
namespace {

bool moves_anything(const StepChange& change) {
  return change.touches_segments() || change.rays.lights_changed || !change.colors.reassigned.empty();
}

}  // namespace

bool KeptSelection::is_same(const StepChange& change) const {
  return found_ && !moves_anything(change) && found_->colors == change.colors && found_->objects == change.rays.objects;
}

const std::vector<Leaves>* KeptSelection::leaves(const StepChange& change) const {
  return is_same(change) ? &found_->leaves : nullptr;
}

PathTasks KeptSelection::find_tasks(const StepChange& change, const PathSearch& search, ProgramTable& programs) const {
  if (is_same(change) && !found_->paths_changed) return found_->tasks;
  return find_path_tasks(search, change, programs);
}

void KeptSelection::keep(const StepChange& change, PathTasks tasks, std::vector<Leaves> leaves) {
  if (moves_anything(change))
    found_.reset();
  else
    found_ = Found{change.colors, change.rays.objects, std::move(tasks), std::move(leaves), change.touches_rays()};
}

}  // namespace relook
