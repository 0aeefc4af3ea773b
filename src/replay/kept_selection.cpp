#include "replay/kept_selection.h"

#include <algorithm>

#include "cache/residency/eviction.h"

namespace relook {
namespace {

bool moves_anything(const StepChange& change) {
  return change.touches_segments() || change.rays.lights_changed || !change.colors.reassigned.empty();
}

}  // namespace

std::uint64_t KeptSelection::Found::bytes() const {
  return sizeof(Found) + objects.size() + tasks.of_path.size() + tasks.of_class.size() + leaves.size() * sizeof(Leaves);
}

std::uint64_t KeptSelection::bytes() const {
  std::uint64_t bytes = 0;
  for (const Found& found : found_) bytes += found.bytes();
  return bytes;
}

const KeptSelection::Found* KeptSelection::find(const StepChange& change) const {
  if (moves_anything(change)) return nullptr;
  const auto found = std::ranges::find_if(found_, [&](const Found& f) { return f.is_of(change); });
  return found != found_.end() ? &*found : nullptr;
}

const std::vector<Leaves>* KeptSelection::leaves(const StepChange& change) const {
  const Found* found = find(change);
  return found != nullptr ? &found->leaves : nullptr;
}

PathTasks KeptSelection::find_tasks(const StepChange& change, const PathSearch& search, ProgramTable& programs) const {
  const Found* found = find(change);
  if (found != nullptr && !found->paths_changed) return found->tasks;
  return find_path_tasks(search, change, programs);
}

void KeptSelection::keep(const StepChange& change, PathTasks tasks, std::vector<Leaves> leaves, double seconds) {
  ++steps_;
  if (moves_anything(change)) {
    found_.clear();
    return;
  }
  Found next;
  if (const Found* found = find(change)) {
    next.uses = found->uses;
    next.seconds = found->seconds;
    std::erase_if(found_, [&](const Found& f) { return f.is_of(change); });
  }
  note_structures(change.colors);
  if (change.touches_rays()) note_paths(leaves);
  next.colors = change.colors;
  next.objects = change.rays.objects;
  next.tasks = std::move(tasks);
  next.leaves = std::move(leaves);
  next.paths_changed = change.touches_rays();
  next.seconds = std::max(next.seconds, seconds);  // what was kept takes no time to find
  next.last_use = steps_;
  ++next.uses;
  found_.push_back(std::move(next));
  trim();
}

/// Programs of another shape may read parameters that those before did not: of their own material or of the
/// illumination.
void KeptSelection::note_structures(const ColorChange& colors) {
  if (colors.new_environment) found_.clear();
  if (colors.restructured.empty()) return;
  std::erase_if(found_, [&](const Found& found) {
    const ParameterSet& set = found.colors.parameters;
    return !set.lights.empty() || set.ambient || set.environment ||
           std::ranges::any_of(colors.restructured, [&](MaterialId id) { return set.fields_of(id) != 0; });
  });
}

/// Ray trees in these leaves have changed: they may depend on anything now.
void KeptSelection::note_paths(const std::vector<Leaves>& leaves) {
  for (Found& found : found_) {
    found.paths_changed = true;
    for (std::size_t tile = 0; tile < leaves.size(); ++tile) found.leaves[tile] |= leaves[tile];
  }
}

void KeptSelection::trim() {
  const auto weight = [&](const Found& found) {
    PieceFacts facts;
    facts.bytes = found.bytes();
    facts.return_seconds = found.seconds;
    facts.last_use = found.last_use;
    facts.uses = found.uses;
    return eviction_weight(EvictionPolicy::weight, facts, steps_);
  };
  while (found_.size() > 1 && bytes() > most_bytes_)
    found_.erase(std::ranges::min_element(found_.begin(), found_.end() - 1, {}, weight));
}

}  // namespace relook
