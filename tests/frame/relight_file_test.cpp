// Layers for relighting (image/layers/relight_file.h): over a journal of any edits they are the sums that the frames
// are made of, bit by bit, whatever tiles are shared, and each control scales just what an edit of its settings scales.
#include "image/layers/relight_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "layer_file.h"
#include "look_fixture.h"
#include "path_checks.h"
#include "random_lights.h"
#include "run_program.h"
#include "scene/light_sums.h"

namespace relook {
namespace {

constexpr std::uint32_t kRelightWidth = 72, kRelightHeight = 66;  // tiles clipped on both sides
constexpr double kHalf = 1.0 / 2048;                              // the largest relative rounding of a half

using Rgb = std::array<double, 3>;

Rgb times(const Rgb& a, const Rgb& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Rgb times(const Rgb& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }

Bytes encoded(RelightEncoder& encoder, Replayer& replayer) {
  return encoder.exr(replayer.state(), replayer.image(), replayer.sum_versions(), replayer.residency(), {});
}

/// Layers in float32, as the file has them.
class Layers {
 public:
  Layers(Replayer& replayer, const ScratchFolder& folder)
      : table(replayer.state()), sums(light_sums(replayer.state().scene())) {
    RelightEncoder encoder(false);
    file_ = read_layers(encoded(encoder, replayer), folder / "relight.exr");
  }
  [[nodiscard]] float value(std::size_t layer, int channel, std::size_t pixel) const {
    return file_.channel(table.layers[layer].name +
                         std::array{".R", ".G", ".B"}[static_cast<std::size_t>(channel)])[pixel];
  }

  RelightTable table;
  std::vector<LightSum> sums;

 private:
  LayerFile file_;
};

/// How many pixels are not colour by scale times layer, but for the rounding of halves.
std::size_t pixels_off(const Frame& frame, const Layers& layers) {
  std::size_t off = 0;
  for (std::size_t pixel = 0; pixel < frame.pixels.size(); ++pixel)
    for (int channel = 0; channel < 3; ++channel) {
      double sum = 0;
      for (std::size_t l = 0; l < layers.table.layers.size(); ++l) {
        const RelightLayer& layer = layers.table.layers[l];
        sum += layers.sums[layer.sum].color[static_cast<std::size_t>(channel)] / layer.scale *
               layers.value(l, channel, pixel);
      }
      const double value = frame.pixels[pixel][channel];
      off += std::abs(sum - value) > kHalf * std::abs(value) + 1e-5 ? 1U : 0U;
    }
  return off;
}

TEST(RelightFile, after_any_edit_is_that_of_a_fresh_image_and_makes_its_frame) {
  Dice dice(seed_of_run());
  std::cout << "RELOOK_SEED=" << seed_of_run() << "\n";
  const ScratchFolder folder("relight_steps");
  Replayer replayer = path_replayer(lights_scene(kRelightWidth, kRelightHeight), path_view(2));
  RelightEncoder encoder(true);
  for (int step = 0; step < 16; ++step) {
    if (step > 0)
      (void)replayer.step(edit_of_list(random_path_change(replayer.state().document().look, dice).forward), "test",
                          ".");
    const SceneState& state = replayer.state();
    Replayer fresh =
        path_replayer({state.document(), state.scene().camera, state.pyramids(), Integrator::path}, path_view(2));
    RelightEncoder of_fresh(false);
    EXPECT_EQ(encoded(encoder, replayer), encoded(of_fresh, fresh)) << "step " << step;
    EXPECT_EQ(layer_differences(state.scene(), replayer.image()), "") << "step " << step;
    EXPECT_EQ(pixels_off(replayer.image().frame, Layers(replayer, folder)), 0U) << "step " << step;
  }
}

Json replace(const std::string& path, Json value) {
  return {{"op", "replace"}, {"path", path}, {"value", std::move(value)}};
}

/// What multiplies a control's colour, and the edit that does it.
Rgb turn(const LightControl& control, std::vector<Json>& operations) {
  const Rgb tint{0.5, 0.75, 0.25};
  for (const LightSetting& setting : control.settings) {
    operations.push_back(replace(setting.color_pointer, times(setting.color, tint)));
    if (!setting.intensity_pointer.empty())
      operations.push_back(replace(setting.intensity_pointer, 4 * setting.intensity));
  }
  return times(tint, control.settings.front().intensity_pointer.empty() ? 1 : 4);
}

/// Of a document in which lights share sums, have temperatures, are placed twice.
SceneState scene_of_all_controls() {
  SceneState state = lights_scene(kRelightWidth, kRelightHeight);
  apply_json(state, R"([
    {"op": "add", "path": "/lights/Lamp/extras", "value": {"relook": {"sum": "pair"}}},
    {"op": "add", "path": "/lights/Spot/extras/relook/sum", "value": "pair"},
    {"op": "add", "path": "/lights/Sun/extras/relook/temperature", "value": 4000},
    {"op": "add", "path": "/nodes/Window2", "value": {"extensions": {"EXT_lights_area": {"light": "Window"}}, "translation": [-1, 3, 1]}},
    {"op": "add", "path": "/scene/extras/relook/ambient", "value": [0.02, 0.03, 0.05]}])");
  return state;
}

TEST(RelightFile, each_control_scales_what_an_edit_of_its_settings_does) {
  const ScratchFolder folder("relight_controls");
  const SceneState state = scene_of_all_controls();
  Replayer replayer = path_replayer(state, path_view(2));
  const Layers layers(replayer, folder);
  const Frame before = replayer.image().frame;
  std::set<std::string_view> kinds;
  for (const LightControl& control : layers.table.controls) {
    kinds.insert(control_kind_name(control.kind));
    if (control.settings.empty()) continue;
    std::vector<Json> operations;
    const Rgb factor = turn(control, operations);
    Replayer edited = path_replayer(state, path_view(2));
    const StepResult step = edited.step(edit_of_list(operations), "test", ".");
    EXPECT_EQ(step.classification.change, ChangeClass::color) << control.name;
    const LightSetting& setting = control.settings.front();
    const bool is_shared = control.kind == LightControl::Kind::shared;
    const Rgb color = is_shared ? Rgb{1, 1, 1} : times(times(setting.color, setting.intensity), control.unit);
    std::size_t off = 0, changed = 0;
    for (std::size_t pixel = 0; pixel < before.pixels.size(); ++pixel)
      for (int channel = 0; channel < 3; ++channel) {
        const auto c = static_cast<std::size_t>(channel);
        double change = 0;
        for (const std::size_t layer : control.sums)
          change += color[c] * (factor[c] - 1) / layers.table.layers[layer].scale * layers.value(layer, channel, pixel);
        const double found = edited.image().frame.pixels[pixel][channel],
                     expected = before.pixels[pixel][channel] + change;
        off += std::abs(found - expected) > kHalf * std::abs(change) + 1e-5 ? 1U : 0U;
        changed += std::abs(change) > 1e-3 ? 1U : 0U;
      }
    EXPECT_EQ(off, 0U) << control_kind_name(control.kind) << " " << control.name;
    EXPECT_GT(changed, 20U) << control_kind_name(control.kind) << " " << control.name;
  }
  EXPECT_EQ(kinds, (std::set<std::string_view>{"light", "shared", "environment", "emission", "ambient", "background",
                                               "fixed"}));
}

TEST(RelightFile, scales_are_powers_of_four_so_that_small_changes_of_a_color_share_tiles) {
  Replayer replayer = path_replayer(lights_scene(kRelightWidth, kRelightHeight), path_view(1));
  const auto scale_of_lamp = [&] {
    const RelightTable table(replayer.state());
    for (const RelightLayer& layer : table.layers)
      if (layer.name == "light_Lamp") return layer.scale;
    return 0.0;
  };
  for (const auto& [intensity, scale] :
       std::map<double, double>{{0, 1}, {16, 16}, {25, 16}, {63, 16}, {64, 64}, {0.2, 0.0625}, {0.0624, 0.015625}}) {
    (void)replayer.step(
        edit_of_list({replace("/lights/Lamp/intensity", intensity), replace("/lights/Lamp/color", {1, 1, 1})}), "test",
        ".");
    EXPECT_EQ(scale_of_lamp(), scale) << intensity;
  }
}

}  // namespace
}  // namespace relook
