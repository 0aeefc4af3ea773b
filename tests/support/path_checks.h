// Checks of a replay under the integrator `path` against a fresh preprocess of its document as it is now: pixels, sums
// of light, ray trees. Each check gives a sentence, "" if there is nothing to say: a failure names what differs.
#pragma once
#include <string>

#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {

/// "3 of 768 pixels", the first of them, and its two values.
[[nodiscard]] std::string pixel_differences(const Frame& found, const Frame& expected);
/// The sums whose bytes differ, by name, with the number of pixels whose values do. Sums that are not in memory are
/// fetched.
[[nodiscard]] std::string sum_differences(Replayer& replayer, const Scene& fresh_scene, const Image& fresh);
/// Pixels that are not the float32 sum, in their order, of the layers that the image's sums give.
[[nodiscard]] std::string layer_differences(const Scene& scene, const Image& image);

/// How much is compared.
struct PathExpectation {
  bool trees = true;   // their hits are in memory
  bool render = true;  // the frame also with that of render()
};
/// Everything above; gtest failures that begin with `what`. Returns the frame of a full render.
Frame expect_path_image(Replayer& replayer, const std::string& what, const PathExpectation& expected = {});
/// One step (`is_drag`: a frame of a drag) with all of that, and the changed pixels that it reports.
StepResult expect_path_step(Replayer& replayer, const Edit& edit, const std::string& what,
                            const PathExpectation& expected = {}, bool is_drag = false);

/// `path` with so many samples and four generations.
[[nodiscard]] ViewOptions path_view(std::uint32_t samples);
/// A replay of a scene under path_view(). `path`: of a cache that is written and read first; "": of no cache.
[[nodiscard]] Replayer path_replayer(const SceneState& state, const ViewOptions& view,
                                     const ResidencyOptions& residency = {}, const RegionOptions& regions = {},
                                     const std::filesystem::path& cache = {});

}  // namespace relook
