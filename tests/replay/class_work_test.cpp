// The class that a step is said to be of is the work that it does (paper 2.1): each step of the journals that have a
// row of Table 1 or of Table 3 for each step. A change of colours shoots no ray; one of optics tests nothing against a
// moved selection, but the segments to lights where other surfaces let light pass; one of geometry tests what it moves.
#include <gtest/gtest.h>

#include <filesystem>

#include "edit/journal.h"
#include "replay/replay.h"
#include "run_program.h"
#include "scene/surface_optics.h"
#include "test_scenes.h"
#include "tree_reader.h"

namespace relook {
namespace {

const std::filesystem::path kProject = RELOOK_SOURCE_DIR;

/// What a step has changed about where things are, from the scenes before and after alone.
struct Moved {
  bool objects = false;      // an object is there, is gone, or has another place, form, holes or back faces
  bool light_paths = false;  // a surface lets light pass that did not, or the other way round
  bool lights = false;       // a light is there that was not, or has another place
};

SurfaceOptics optics_of(const Scene& scene, const Object& object) {
  return surface_optics(scene.material(object.material), scene.mesh(object.mesh));
}

/// Is a surface met by the same rays in the same places?
bool same_extent(const SurfaceOptics& a, const Material& then, const SurfaceOptics& b, const Material& now) {
  const bool same_holes = then.alpha_cutoff == now.alpha_cutoff && then.base_color.a == now.base_color.a &&
                          then.slot(Slot::base_color) == now.slot(Slot::base_color);
  return a.cut_out == b.cut_out && a.culls_back == b.culls_back && (same_holes || !a.cut_out);
}

/// Ids are those of one state before and after an edit.
Moved moved_between(const Scene& before, const Scene& after) {
  Moved moved;
  for (std::size_t i = 0; i < after.objects.size(); ++i) {
    const Object& now = after.objects[i];
    if (i >= before.objects.size() || !before.objects[i].alive || !now.alive) {
      moved.objects |= now.alive || (i < before.objects.size() && before.objects[i].alive);
      continue;
    }
    Object then = before.objects[i];
    const SurfaceOptics old_optics = optics_of(before, then), optics = optics_of(after, now);
    moved.light_paths |= old_optics.passes_light != optics.passes_light;
    moved.objects |= !same_extent(old_optics, before.material(then.material), optics, after.material(now.material));
    then.material = now.material;
    moved.objects |= !(then == now);
  }
  for (std::size_t i = 0; i < after.lights.size(); ++i) {
    const Light& now = after.lights[i];
    const bool was_there = i < before.lights.size() && before.lights[i].alive;
    moved.lights |= now.alive && (!was_there || before.lights[i].position != now.position ||
                                  before.lights[i].direction != now.direction);
  }
  return moved;
}

void expect_work_of_class(const StepResult& step, const Moved& moved, std::uint64_t shadow_segments) {
  const Counters& counters = step.counters;
  const std::uint64_t rays = counters.ray_updates, shadows = counters.shadow_updates, tests = counters.ray_tests;
  switch (step.classification.change) {
    case ChangeClass::color:
      EXPECT_EQ(rays + shadows + tests, 0U);
      break;
    case ChangeClass::optical:
      EXPECT_FALSE(moved.objects || moved.lights);
      EXPECT_LE(tests, moved.light_paths ? shadow_segments : 0);
      break;
    default:
      EXPECT_EQ(tests > 0, moved.objects || moved.light_paths);
      EXPECT_TRUE(!moved.lights || shadows > 0);
  }
}

/// Steps through a journal. Of a drag the frames are edits of their own, the selection being out of the trees.
void expect_work_of_classes(SceneState state, const std::filesystem::path& file) {
  const Journal journal = read_journal(file);
  const std::filesystem::path folder = journal.path.parent_path();
  Image image = preprocessed(state.scene(), {1, 6, 0});
  Replayer replayer(std::move(state), std::move(image));
  for (const JournalStep& step : journal.steps)
    for (std::size_t frame = 0; frame < step.frames(); ++frame) {
      SCOPED_TRACE(step.name);
      const Scene before = replayer.state().scene();
      const std::uint64_t segments = size_of(replayer.image(), before.light_order.size()).shadows;
      const StepResult result = replayer.step(step.edit_of(frame), journal.file, folder);
      expect_work_of_class(result, moved_between(before, replayer.state().scene()), segments);
    }
}

TEST(ClassIsWork, EachStepOfTable1) {
  expect_work_of_classes(scene_of_file(kProject / "scenes/spheres/spheres.gltf", 96, 54),
                         kProject / "journals/table1.json");
}

TEST(ClassIsWork, EachStepOfTable3) {
  const ScratchFolder folder("class_work");
  const ProgramResult made = run_program(
      {"python3", (kProject / "scenes/generate.py").string(), "garden", (folder / "garden").string(), "20"});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  expect_work_of_classes(scene_of_file(folder / "garden/garden.gltf", 96, 96), kProject / "journals/table3.json");
}

}  // namespace
}  // namespace relook
