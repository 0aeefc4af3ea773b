#include "replay/path_tasks.h"

#include <algorithm>

#include "base/parallel.h"

namespace relook {
namespace {

class Finder {
 public:
  Finder(const PathSearch& search, const StepChange& change, ProgramTable& programs)
      : s_(search), change_(change), programs_(programs) {}

  PathTasks find() {
    tasks_.of_path.assign(s_.paths.size(), 0);
    if (change_.rays.lights_changed) {
      std::ranges::fill(tasks_.of_path, std::uint8_t{kUpdateTree});
      tasks_.any = !tasks_.of_path.empty();
    }
    for (std::uint32_t object = 0; object < change_.rays.objects.size(); ++object)
      if (change_.rays.objects[object] != 0) flag(s_.index.paths_of(ObjectId(object)), kUpdateTree);
    find_colors(change_.colors);
    tasks_.of_class.assign(s_.classes.size(), 0);
    for (std::uint32_t p = 0; p < tasks_.of_path.size(); ++p)
      tasks_.of_class[s_.classes.of(PathId(p)).index()] |= tasks_.of_path[p];
    return std::move(tasks_);
  }

 private:
  void flag(std::span<const PathId> paths, PathTask task) {
    for (PathId path : paths) tasks_.of_path[path.index()] |= task;
    tasks_.any = tasks_.any || !paths.empty();
  }

  void find_colors(const ColorChange& colors) {
    if (colors.empty()) return;
    for (ObjectId object : colors.reassigned) flag(s_.index.paths_of(object), kShade);
    const ParameterSet& parameters = colors.parameters;
    if (!parameters.lights.empty() || parameters.ambient || parameters.environment) {
      check_all(parameters);
      return;
    }
    const auto& objects = s_.rays.scene().objects;
    std::vector<PathId> candidates;
    for (std::uint32_t object = 0; object < objects.size(); ++object) {
      if (parameters.fields_of(objects[object].material) == 0) continue;
      const auto paths = s_.index.paths_of(ObjectId(object));
      candidates.insert(candidates.end(), paths.begin(), paths.end());
    }
    std::ranges::sort(candidates);
    const auto repeated = std::ranges::unique(candidates);
    candidates.erase(repeated.begin(), repeated.end());
    check(candidates, parameters);
  }

  void check_all(const ParameterSet& parameters) {
    std::vector<PathId> all;
    for (std::uint32_t p = 0; p < s_.paths.size(); ++p) all.emplace_back(p);
    check(all, parameters);
  }

  /// Flags those of the paths that have a node whose program the change reaches.
  void check(const std::vector<PathId>& paths, const ParameterSet& parameters) {
    constexpr std::size_t kGrain = 256;
    parallel_for(
        paths.size(),
        [&](std::size_t i) {
          if (reaches(s_.paths.words(paths[i]), parameters)) tasks_.of_path[paths[i].index()] |= kShade;
        },
        kGrain);
    tasks_.any = tasks_.any || std::ranges::any_of(paths, [&](PathId p) { return tasks_.of_path[p.index()] != 0; });
  }
  [[nodiscard]] bool reaches(std::span<const std::uint32_t> path, const ParameterSet& parameters) {
    std::vector<NodeKey> keys;
    append_keys(s_.rays, path, s_.lights, s_.shadow_bits, keys);
    return std::ranges::any_of(keys, [&](const NodeKey& key) {
      const BoundProgram bound = programs_.get(s_.rays.scene(), key);
      return parameters.reaches(bound) ||
             (bound.program->dependencies.lamps &&
              std::ranges::any_of(key.lights, [&](const VisibleLight& lamp) { return parameters.has(lamp.light); }));
    });
  }

  const PathSearch& s_;
  const StepChange& change_;
  ProgramTable& programs_;
  PathTasks tasks_;
};

}  // namespace

PathTasks find_path_tasks(const PathSearch& search, const StepChange& change, ProgramTable& programs) {
  return Finder(search, change, programs).find();
}

}  // namespace relook
