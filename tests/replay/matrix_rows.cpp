#include "matrix_rows.h"

#include <gtest/gtest.h>

#include "image/render.h"
#include "path_checks.h"
#include "region_checks.h"
#include "tree_reader.h"

namespace relook {
namespace {

/// Steps through rows under `path`, which has no tunnels and adds sums of light: a colour edit of a light changes
/// pixels without a sample.
void expect_full_path_renders(const SceneState& state, const ViewOptions& view, const std::vector<MatrixRow>& rows,
                              std::optional<ChangeClass> is_of_class, const RegionOptions& regions) {
  Replayer replayer = path_replayer(state, view, {}, regions);
  std::size_t rows_that_changed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool renders = i % 8 == 0;  // a preprocess stands for it elsewhere
    const StepResult step =
        expect_path_step(replayer, edit_of(rows[i].operations), "row \"" + rows[i].name + "\"", {true, renders});
    if (is_of_class) {
      EXPECT_EQ(step.classification.change, *is_of_class) << rows[i].name;
    }
    rows_that_changed += step.changed_pixels.empty() ? 0 : 1;
  }
  EXPECT_GT(rows_that_changed, rows.size() / 2);
}

}  // namespace

void expect_full_renders(SceneState state, const ViewOptions& view, const std::vector<MatrixRow>& rows,
                         std::optional<ChangeClass> is_of_class, const RegionOptions& regions) {
  if (view.integrator == Integrator::path) return expect_full_path_renders(state, view, rows, is_of_class, regions);
  Image image = preprocessed(state.scene(), view);
  Replayer replayer(std::move(state), std::move(image), regions);
  std::size_t rows_that_changed = 0;
  for (const MatrixRow& row : rows) {
    SCOPED_TRACE(row.name);
    const Frame before = replayer.image().frame;
    const std::uint64_t segments = replayer.segments();
    const StepResult step = replayer.step(edit_of(row.operations), "matrix", ".");
    const SceneState again = compiled_again(replayer.state());
    const Frame full = rendered(again.scene(), view);
    const Image fresh = preprocessed(again.scene(), view);
    EXPECT_EQ(different_pixels(replayer.image().frame, full).size(), 0U);
    EXPECT_EQ(different_pixels(fresh.frame, full).size(), 0U);
    EXPECT_EQ(different_trees(replayer.image(), replayer.state().scene(), fresh, again.scene()), 0U);
    EXPECT_EQ(stale_tiles(replayer), 0U);
    EXPECT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full));
    EXPECT_EQ(step.counters.pixels_changed, step.changed_pixels.size());
    EXPECT_LE(step.counters.pixels_changed, step.counters.samples_affected);
    EXPECT_EQ(step.counters.ray_tests + step.counters.ray_tests_culled, segments);
    if (is_of_class) {
      EXPECT_EQ(step.classification.change, *is_of_class);
    }
    rows_that_changed += step.changed_pixels.empty() ? 0 : 1;
  }
  // Not every row bears on every scene, but a table that changes nothing would prove nothing.
  EXPECT_GT(rows_that_changed, rows.size() / 2);
}

void expect_fresh_image(const Replayer& replayer) {
  const SceneState again = compiled_again(replayer.state());
  const Image fresh = preprocessed(again.scene(), replayer.image().view);
  EXPECT_EQ(different_pixels(replayer.image().frame, fresh.frame).size(), 0U);
  EXPECT_EQ(different_trees(replayer.image(), replayer.state().scene(), fresh, again.scene()), 0U);
}

}  // namespace relook
