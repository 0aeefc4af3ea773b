// Rows of the paper's Table 1 as edits, and steps through them, each against a full render and a fresh preprocess of
// the edited scene.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {

/// Operations of one edit.
struct MatrixRow {
  std::string name;
  Json operations;
};

[[nodiscard]] inline Json set(const std::string& pointer, Json value) {
  return {{"op", "replace"}, {"path", pointer}, {"value", std::move(value)}};
}
[[nodiscard]] inline Json add(const std::string& pointer, Json value) {
  return {{"op", "add"}, {"path", pointer}, {"value", std::move(value)}};
}
[[nodiscard]] inline Json removed(const std::string& pointer) { return {{"op", "remove"}, {"path", pointer}}; }
template <class... Operations>
[[nodiscard]] MatrixRow row(std::string name, Operations... operations) {
  return {std::move(name), Json::array({std::move(operations)...})};
}

/// Steps through rows. `is_of_class`: what the class of a row must be, if anything. Frames, ray trees, tiles and
/// counters that are not those of a full render are gtest failures; under `path` sums of light, too, but no tiles.
void expect_full_renders(SceneState state, const ViewOptions& view, const std::vector<MatrixRow>& rows,
                         std::optional<ChangeClass> is_of_class, const RegionOptions& regions = {});
/// The frame has the bits of a full render, and the ray trees are those of a fresh preprocess.
void expect_fresh_image(const Replayer& replayer);

}  // namespace relook
