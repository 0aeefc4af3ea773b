// Choices of a scene, of structures and of edits: after each step the frame has the bits of a full render of the scene
// compiled from scratch.
#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "image/render.h"
#include "random_changes.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr std::uint32_t kWidth = 16, kHeight = 12;
constexpr std::size_t kMostSteps = 12;

RegionOptions chosen_regions(Dice& dice) {
  RegionOptions regions;
  regions.groups = dice.one_of(std::vector<std::size_t>{4, 0, 1});
  regions.tunnels = dice.below(3);
  regions.atoms = static_cast<std::uint32_t>(dice.below(3));
  regions.tunnel_levels = static_cast<std::uint32_t>(dice.below(kTileLevel + 1));
  regions.color_trees = dice.one_of(std::vector<double>{1, 0, 0.1});
  return regions;
}

/// A scene of the tests, changed a few times, seen from anywhere.
SceneState chosen_scene(Dice& dice) {
  SceneState state = test_scene(static_cast<TestScene>(dice.below(3)), kWidth, kHeight);
  for (std::size_t i = dice.below(5); i > 0; --i) {
    const Change change = random_change(state.document().look, dice);
    is_answered({ExitCode::bad_input}, [&] { apply_edit(state, edit_of_list(change.forward), "scene", "."); });
  }
  if (dice.chance(0.5)) return state;
  SceneBuilder camera;
  const auto place = [&](double low, double high) { return static_cast<float>(dice.between(low, high)); };
  camera.look_at({place(-3, 3), place(0.5, 4), place(2, 5)}, {place(-1, 1), place(0, 1), 0}, 50, kWidth, kHeight);
  return with_camera(state, camera.camera());
}

void expect_full_render(const Replayer& replayer) {
  const SceneState again = compiled_again(replayer.state());
  expect(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).empty(),
         "the frame is not a full render");
}

void drag(Replayer& replayer, Dice& dice) {
  for (std::size_t i = 1 + dice.below(3); i > 0; --i) {
    const std::string node = dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall", "Lamp"});
    const Change change = random_movement(replayer.state().document().look, node, dice);
    is_answered({ExitCode::bad_input}, [&] { replayer.drag(edit_of_list(change.forward), "drag", "."); });
    expect_full_render(replayer);
  }
  replayer.release();
  expect_full_render(replayer);
}

}  // namespace

int fuzz_replay(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  Choices choices(fuzz_bytes(data, size));
  Dice dice([&] { return choices.number(1); });
  const ViewOptions view{dice.below(4) == 3 ? 4U : 1U, 5, static_cast<std::uint32_t>(dice.below(5))};
  const RegionOptions regions = chosen_regions(dice);
  SceneState state = chosen_scene(dice);
  Image image = preprocessed(state.scene(), view);
  Replayer replayer(std::move(state), std::move(image), regions);
  for (std::size_t i = 0; i < kMostSteps && !choices.at_end(); ++i) {
    if (dice.chance(0.2)) {
      drag(replayer, dice);
      continue;
    }
    const Change change = random_change(replayer.state().document().look, dice);
    const Frame before = replayer.image().frame;
    const bool is_done = is_answered({ExitCode::bad_input}, [&] {
      const StepResult step = replayer.step(edit_of_list(change.forward), "step", ".");
      expect(step.changed_pixels.indices(kWidth) == different_pixels(before, replayer.image().frame),
             "the changed pixels are not those that differ");
    });
    expect_full_render(replayer);
    if (!is_done || !dice.chance(0.3)) continue;
    replayer.step(edit_of_list(change.backward), "step", ".");
    expect(different_pixels(before, replayer.image().frame).empty(), "an edit undone does not give the frame back");
  }
  return 0;
}

}  // namespace relook
