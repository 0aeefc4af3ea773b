#include "search_time.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "replay/path_tasks.h"

namespace relook {
namespace {

constexpr int kRuns = 5;

/// The samples of some leaves of a tile whose paths have a task.
std::size_t count_samples(const Image& image, std::size_t tile, const std::vector<std::uint8_t>& of_path,
                          const Leaves& leaves) {
  const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
  const std::uint32_t width = rect.x1 - rect.x0, samples = image.view.samples;
  const std::vector<PathId>& paths = image.trees[tile].paths;
  std::size_t count = 0;
  for (std::uint32_t y = 0; y < rect.y1 - rect.y0; ++y)
    for (std::uint32_t x = 0; x < width; x += kLeafSize) {
      if (!leaves.test(leaf_of(y * width + x, width))) continue;
      const std::uint32_t last = (y * width + std::min(x + kLeafSize, width)) * samples;
      for (std::uint32_t sample = (y * width + x) * samples; sample < last; ++sample)
        if (of_path[paths[sample].index()] != 0) ++count;
    }
  return count;
}

/// Samples with a task, by tile.
std::vector<std::size_t> find_samples(const Image& image, const ImageRegions* groups, const PathTasks& tasks) {
  std::vector<std::size_t> counts(image.trees.size());
  parallel_for(counts.size(), [&](std::size_t tile) {
    Leaves leaves;
    RegionCounters counters;
    if (groups != nullptr)
      select_leaves(groups->groups(tile), tasks.of_class, leaves, counters);
    else
      leaves.set();
    counts[tile] = count_samples(image, tile, tasks.of_path, leaves);
  });
  return counts;
}

}  // namespace

SearchTimes SearchTimer::next(const Replayer& replayer, const Edit& edit, const Journal& journal) {
  const Image& image = replayer.image();
  const std::vector<LightId> lights = state_.scene().light_order;
  const RayScene before(state_.scene());
  PathIndex index;
  PathClasses classes(false);
  index.extend(image.paths, {lights.size(), image.view.shadow_bits});
  classes.extend(image.paths, {lights.size(), image.view.shadow_bits}, {});
  const SceneDelta delta = apply_edit(state_, edit, journal.file, journal.path.parent_path());
  const StepChange change = find_change(before, state_.scene(), delta, lights);
  if (change.rays.lights_changed || change.touches_segments()) return {};  // not told from paths alone
  const ColorScene rays(before.after(state_.scene(), delta), state_.scene());
  const PathSearch search{rays, image.paths, index, lights, image.view.shadow_bits, classes};
  ProgramTable programs;
  PathTasks tasks;
  const double path_seconds = fastest(kRuns, [&] { tasks = find_path_tasks(search, change, programs); });
  std::vector<std::size_t> without, with;
  SearchTimes times;
  times.without = path_seconds + fastest(kRuns, [&] { without = find_samples(image, nullptr, tasks); });
  times.with = path_seconds + fastest(kRuns, [&] { with = find_samples(image, &replayer.regions(), tasks); });
  require(without == with, "groups find the same samples");
  return times;
}

}  // namespace relook
