#include "replay/drag.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace relook {
namespace {

using Samples = std::vector<std::uint32_t>;  // of a tile, increasing

/// How many values two increasing lists have in common.
std::size_t common(const Samples& a, const Samples& b) {
  Samples both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both.size();
}

Samples united(const Samples& a, const Samples& b) {
  Samples both;
  std::ranges::set_union(a, b, std::back_inserter(both));
  return both;
}

}  // namespace

bool Drag::is_movement(const StepChange& change) {
  if (!change.colors.empty() || change.rays.lights_changed || change.any_respawns) return false;
  return std::ranges::all_of(change.rays.objects, [](std::uint8_t flags) {
    return flags == 0 || flags == (RayChange::moved | RayChange::shadows);
  });
}

void Drag::show(StepChange& change, StepResult& result, StopWatch& watch) {
  const std::vector<NewSamples> without = lift(change, result, watch);
  render_lifted(without, result, watch);
}

std::vector<SampleColors> Drag::end_with(StepChange& change) {
  put_back_with(change);
  lifted_.clear();
  return std::exchange(on_top_, {});
}

/// First step of a frame: what moves and is still in the ray trees is taken out of them. The frame is not brought up to
/// date yet.
std::vector<NewSamples> Drag::lift(StepChange& change, StepResult& result, StopWatch& watch) {
  std::vector<ObjectId> all;
  std::ranges::set_union(lifted_, selection_of(change), std::back_inserter(all));
  if (all.size() == lifted_.size()) return {};
  if (on_top_.empty()) on_top_.resize(parts_.image().trees.size());
  for (const ObjectId id : lifted_) change.rays.objects[id.index()] = 0;  // not in any tree
  lifted_ = std::move(all);
  std::vector<NewSamples> fresh = run_pass(parts_, change, {.absent = lifted_}, result, watch);
  keep_trees(parts_, fresh, change);
  watch.lap(result.seconds.update);
  return fresh;
}

/// Second step: what is lifted is rendered where it is; the ray trees stay without it. `without`: what the first step
/// has changed.
void Drag::render_lifted(std::span<const NewSamples> without, StepResult& result, StopWatch& watch) {
  if (lifted_.empty()) return;  // nothing has moved yet
  StepChange change = no_change(parts_.stored.lights());
  put_back_with(change);
  std::vector<NewSamples> fresh = run_pass(parts_, change, {.keeps_trees = false}, result, watch);
  std::vector<SampleColors> others = std::exchange(on_top_, std::vector<SampleColors>(parts_.image().trees.size()));
  for (const NewSamples& of_tile : without) {
    Samples& other = others[of_tile.tile].samples;
    other = united(other, of_tile.shaded.samples);
  }
  for (NewSamples& of_tile : fresh) {
    if (const NewSamples* also = find_tile(without, of_tile.tile))
      result.counters.samples_affected -= common(also->shaded.samples, of_tile.shaded.samples);
    on_top_[of_tile.tile] = {of_tile.shaded.samples, std::move(of_tile.shaded.colors)};
  }
  refresh_pixels(parts_.stored, fresh, others, on_top_, result);
  watch.lap(result.seconds.evaluate);
  parts_.stored.bring_back_tunnels(fresh, parts_.grow());
  watch.lap(result.seconds.update);
}

void Drag::put_back_with(StepChange& change) const {
  if (lifted_.empty()) return;
  change.rays.reserve(parts_.state.scene().objects.size());
  for (const ObjectId id : lifted_) {
    change.rays.objects[id.index()] |= RayChange::moved | RayChange::shadows;
    change.rays.before_index[id.index()] = kNoNode;  // in no tree
  }
  change.any_moved = true;
  change.any_shadows = true;
}

}  // namespace relook
