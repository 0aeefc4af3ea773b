// Which paths a change can reach, told from the paths alone: the first half of finding what to do. The second half,
// segments that a moved object may meet, is told by tunnels.
#pragma once
#include <cstdint>
#include <vector>

#include "color/shade.h"
#include "image/stored_image.h"
#include "replay/change.h"

namespace relook {

/// What a step has to do with the samples of one path, as bits.
enum PathTask : std::uint8_t {
  kUpdateTree = 1,  // the ray tree names a changed object, or a light has changed
  kShade = 2,       // its colour may change though its tree does not
};

struct PathTasks {
  std::vector<std::uint8_t> of_path;   // bits of PathTask
  std::vector<std::uint8_t> of_class;  // those of all paths of a class together
  bool any = false;
};

/// The image side of a search.
struct PathSearch {
  const ColorScene& rays;  // after the change
  const PathTable& paths;
  const PathIndex& index;              // of `paths`
  const std::vector<LightId>& lights;  // light order of the paths
  std::uint32_t shadow_bits;           // of the paths
  const PathClasses& classes;
};
/// Both outlive it. `rays`: after the change.
[[nodiscard]] inline PathSearch search_in(const StoredImage& stored, const ColorScene& rays) {
  const Image& image = stored.image();
  return {rays, image.paths, stored.index(), stored.lights(), image.view.shadow_bits, stored.classes()};
}

[[nodiscard]] PathTasks find_path_tasks(const PathSearch& search, const StepChange& change, ProgramTable& programs);

}  // namespace relook
