// Long journals of mixed edits from a printed seed (RELOOK_SEED=<number> repeats or varies them): after every step the
// frame has the bits of a full render, and edits followed by their inverses give earlier frames back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <random>

#include "base/parallel.h"
#include "engine/render.h"
#include "engine/replay.h"
#include "region_checks.h"
#include "test_scenes.h"
#include "tree_reader.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 200;

std::uint64_t seed_of_run() {
  const char* given = std::getenv("RELOOK_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : 1996;
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  /// [0, count)
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  bool chance(double share) { return between(0, 1) < share; }
  /// On a grid of 1/64, so that JSON and float agree.
  double between(double low, double high) {
    const double t = static_cast<double>(below(65)) / 64;
    return low + (high - low) * t;
  }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }
  Json color() { return {between(0, 1), between(0, 1), between(0, 1)}; }

 private:
  std::mt19937_64 engine_;
};

/// An edit and what undoes it.
struct Change {
  std::vector<Json> forward, backward;  // operations, in order

  /// Sets a member that may or may not exist.
  void set(const Json& look, const std::string& pointer, Json value) {
    const Json::json_pointer at(pointer);
    if (look.contains(at))
      undo_first({{"op", "add"}, {"path", pointer}, {"value", look.at(at)}});
    else
      undo_first({{"op", "remove"}, {"path", pointer}});
    forward.push_back({{"op", "add"}, {"path", pointer}, {"value", std::move(value)}});
  }
  void remove(const Json& look, const std::string& pointer) {
    undo_first({{"op", "add"}, {"path", pointer}, {"value", look.at(Json::json_pointer(pointer))}});
    forward.push_back({{"op", "remove"}, {"path", pointer}});
  }

 private:
  void undo_first(Json operation) { backward.insert(backward.begin(), std::move(operation)); }
};

const std::vector<std::string> kMaterials = {"Matte", "Mirror", "Glass", "Ground"};
const std::vector<std::string> kImages = {"PictureImage", "SecondImage", "BumpImage", "LeafImage", "VeilImage"};

void change_color(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  switch (dice.below(12)) {
    case 0: {
      Json color = dice.color();
      color.push_back(dice.between(0.2, 1));
      return change.set(look, material + "/pbrMetallicRoughness/baseColorFactor", color);
    }
    case 1:
      return change.set(look, material + "/pbrMetallicRoughness/metallicFactor", dice.between(0, 1));
    case 2:
      return change.set(look, material + "/emissiveFactor", dice.color());
    case 3:
      return change.set(look, material + "/extensions/KHR_materials_sheen/sheenColorFactor", dice.color());
    case 4:
      return change.set(look, "/lights/Lamp/intensity", dice.between(0, 80));
    case 5:
      return change.set(look, "/lights/Lamp/color", dice.color());
    case 6:
      return change.set(look, "/scene/extras/relook/ambient", dice.color());
    case 7:
      return change.set(look, "/scene/extras/relook/environment/color", dice.color());
    case 8:
      return change.set(look, "/textures/Marble/extras/relook/procedural/kind",
                        dice.one_of(std::vector<std::string>{"marble", "wood", "checker", "noise"}));
    case 9:
      return change.set(look, "/textures/Marble/extras/relook/procedural/scale", dice.between(0.5, 4));
    case 10:
      return change.set(look, "/textures/Picture/source", dice.one_of(kImages));
    default:
      return change.set(look, material + "/extras/relook/diffuse", dice.color());
  }
}

void change_optics(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  const auto weight = [&] { return dice.chance(0.4) ? 0.0 : dice.between(0, 1); };
  const Json bumps = {{"index", "Bumps"}, {"scale", dice.between(0, 1)}};
  switch (dice.below(11)) {
    case 0:
      return change.set(look, material + "/pbrMetallicRoughness/roughnessFactor", dice.between(0, 0.5));
    case 1:
      return change.set(look, material + "/extensions/KHR_materials_transmission/transmissionFactor", weight());
    case 2:
      return change.set(look, material + "/extensions/KHR_materials_volume/thicknessFactor", weight());
    case 3:
      return change.set(look, material + "/extensions/KHR_materials_ior/ior", dice.between(1, 2.5));
    case 4:
      return change.set(look, material + "/extensions/KHR_materials_clearcoat/clearcoatFactor", weight());
    case 5:
      return change.set(look, material + "/normalTexture", bumps);
    case 6:
      return change.set(look, material + "/extras/relook/model",
                        dice.one_of(std::vector<std::string>{"metallic-roughness", "blinn-phong", "unlit"}));
    case 7:
      return change.set(look, material + "/extras/relook/reflection", weight());
    case 8:
      return change.set(look, material + "/extras/relook/refraction", weight());
    case 9:
      return change.set(look, material + "/extras/relook/transparency", weight());
    default:
      return change.set(look, material + "/extensions/KHR_materials_specular/specularFactor", weight());
  }
}

void change_geometry(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  const std::string ball = dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall"});
  const std::string extra = "/nodes/Extra" + std::to_string(dice.below(4));
  const Json place = {dice.between(-1.5, 1.5), dice.between(0.3, 1.2), dice.between(-1, 1.5)};
  switch (dice.below(9)) {
    case 0:
      return change.set(look, "/nodes/" + ball + "/translation", place);
    case 1:
      return change.set(look, "/nodes/" + ball + "/scale", {dice.between(0.5, 1.3), dice.between(-1, -0.5), 1});
    case 2:
      return change.set(look, "/nodes/" + ball + "/extensions/KHR_node_visibility/visible", dice.chance(0.6));
    case 3:
      return change.set(look, "/nodes/Lamp/translation", {dice.between(-3, 3), dice.between(2, 5), dice.between(0, 4)});
    case 4: {
      if (look.contains(Json::json_pointer(extra))) return change.remove(look, extra);
      if (dice.chance(0.3))
        return change.set(look, extra,
                          {{"translation", place}, {"extensions", {{"KHR_lights_punctual", {{"light", "Lamp"}}}}}});
      if (dice.chance(0.4)) {  // the same surface in the same place: ties
        const Json& twin = look.at(Json::json_pointer("/nodes/" + ball));
        return change.set(look, extra,
                          {{"mesh", ball},
                           {"translation", twin.at("translation")},
                           {"rotation", twin.at("rotation")},
                           {"scale", twin.at("scale")}});
      }
      return change.set(look, extra, {{"mesh", ball}, {"translation", place}, {"scale", {0.5, 0.5, 0.5}}});
    }
    case 5: {
      const std::string displacement = "/nodes/Ball/extras/relook/displacement";
      if (look.contains(Json::json_pointer(displacement)) && dice.chance(0.5)) return change.remove(look, displacement);
      if (!look.contains(Json::json_pointer("/nodes/Ball/extras/relook")))
        change.set(look, "/nodes/Ball/extras", {{"relook", Json::object()}});
      return change.set(look, displacement, {{"texture", "Picture"}, {"scale", dice.between(-0.2, 0.2)}});
    }
    case 6:
      return change.set(look, "/meshes/" + ball + "/primitives/0/material", dice.one_of(kMaterials));
    case 7:
      return change.set(look, material + "/alphaMode",
                        dice.one_of(std::vector<std::string>{"OPAQUE", "MASK", "BLEND"}));
    default:
      return change.set(look, material + "/pbrMetallicRoughness/baseColorTexture",
                        {{"index", dice.one_of(std::vector<std::string>{"Picture", "Leaves", "Veil", "Marble"})}});
  }
}

/// One to three changes of any kind in one edit; no two of the same place.
Change random_change(const Json& look, Dice& dice) {
  Change change;
  const std::size_t count = dice.chance(0.7) ? 1 : 2 + dice.below(2);
  for (std::size_t i = 0; i < count; ++i) {
    Change next;
    const double kind = dice.between(0, 1);
    if (kind < 0.35)
      change_color(next, look, dice);
    else if (kind < 0.6)
      change_optics(next, look, dice);
    else
      change_geometry(next, look, dice);
    const auto touches = [&](const Json& other) { return other["path"] == next.forward.front()["path"]; };
    if (std::any_of(change.forward.begin(), change.forward.end(), touches)) continue;
    change.forward.insert(change.forward.end(), next.forward.begin(), next.forward.end());
    change.backward.insert(change.backward.begin(), next.backward.begin(), next.backward.end());
  }
  return change;
}

Edit edit_of_list(const std::vector<Json>& operations) { return edit_of(Json(operations)); }

struct RandomCase {
  TestScene scene;
  std::uint32_t samples;
  std::size_t threads;
  std::uint32_t shadow_bits = 0;
};

void PrintTo(const RandomCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << c.samples << " samples, " << c.threads << " threads, " << c.shadow_bits
       << " shadow bits";
}

class RandomJournal : public testing::TestWithParam<RandomCase> {
 protected:
  ~RandomJournal() override { set_thread_count(0); }
};

std::string random_case_name(const testing::TestParamInfo<RandomCase>& info) {
  return std::string(test_scene_name(info.param.scene)) + "_" + std::to_string(info.param.samples) + "_samples_" +
         std::to_string(info.param.threads) + "_threads_" + std::to_string(info.param.shadow_bits) + "_bits";
}

Replayer replayer_of(TestScene scene, ViewOptions view, const RegionOptions& regions) {
  SceneState state = view.samples == 1 ? test_scene(scene, 80, 60) : test_scene(scene, 36, 27);
  Image image = preprocessed(state.scene(), view);
  return Replayer(std::move(state), std::move(image), regions);
}

RegionOptions random_regions(Dice& dice) {
  RegionOptions regions;
  regions.groups = dice.one_of(std::vector<std::size_t>{0, 1, 4});
  regions.tunnels = dice.below(3);
  regions.atoms = static_cast<std::uint32_t>(dice.below(3));
  regions.color_trees = dice.one_of(std::vector<double>{0, 0.01, 0.1, 1});
  std::cout << "groups " << regions.groups << ", tunnels " << regions.tunnels << ", atoms " << regions.atoms
            << ", color trees " << regions.color_trees << "\n";
  return regions;
}

void expect_full_render(const Replayer& replayer, const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  ASSERT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).size(), 0U)
      << what;
}

void expect_fresh_structures(const Replayer& replayer, const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  const Image fresh = preprocessed(again.scene(), replayer.image().view);
  ASSERT_EQ(different_trees(replayer.image(), replayer.state().scene(), fresh, again.scene()), 0U) << what;
  ASSERT_EQ(stale_tiles(replayer), 0U) << what;
}

/// The same places with other values, where that is possible: consecutive edits of one selection.
std::vector<Json> with_other_values(const std::vector<Json>& operations, Dice& dice) {
  std::vector<Json> others;
  for (Json operation : operations) {
    if (!operation.contains("value")) return {};
    Json& value = operation["value"];
    const std::string path = operation["path"];
    if (value.is_number())
      value = path.ends_with("/ior") ? dice.between(1, 2.5) : dice.between(0, 1);
    else if (value.is_array() && value.size() == 3)
      value = dice.color();
    else
      return {};
    others.push_back(std::move(operation));
  }
  return others;
}

/// One frame of a drag: something that a node's selection can do, now and then to its light.
Change random_movement(const Json& look, const std::string& node, Dice& dice) {
  Change change;
  const std::string pointer = "/nodes/" + node;
  if (dice.chance(0.15))
    change.set(look, pointer + "/extensions/KHR_node_visibility/visible", dice.chance(0.5));
  else if (dice.chance(0.3))
    change.set(look, pointer + "/scale", {dice.between(0.5, 1.3), dice.between(0.5, 1), 1});
  else
    change.set(look, pointer + "/translation", {dice.between(-1.5, 1.5), dice.between(0.3, 3), dice.between(-1, 1.5)});
  return change;
}

/// A drag of several frames, of one node after the other; then the release.
void drag_at_random(Replayer& replayer, Dice& dice, const std::string& what) {
  const std::size_t frames = 1 + dice.below(4);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const std::string node = dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall", "Ball", "Lamp"});
    const Change change = random_movement(replayer.state().document().look, node, dice);
    const Frame before = replayer.image().frame;
    const StepResult step = replayer.drag(edit_of_list(change.forward), "random", ".");
    const std::string where = what + " drag " + Json(change.forward).dump();
    expect_full_render(replayer, where);
    ASSERT_EQ(step.changed_pixels.indices(before.width), different_pixels(before, replayer.image().frame)) << where;
    if (testing::Test::HasFatalFailure()) return;
  }
  const Frame before = replayer.image().frame;
  const StepResult step = replayer.release();
  ASSERT_TRUE(step.changed_pixels.empty()) << what;
  ASSERT_EQ(different_pixels(before, replayer.image().frame).size(), 0U) << what;
  expect_fresh_structures(replayer, what);
}

TEST_P(RandomJournal, EveryFrameIsAFullRender) {
  const auto [scene, samples, threads, shadow_bits] = GetParam();
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  set_thread_count(threads);
  Dice dice(seed + 7919 * samples + static_cast<std::uint64_t>(scene));
  const ViewOptions view{samples, 5, shadow_bits};
  Replayer replayer = replayer_of(scene, view, random_regions(dice));
  std::size_t steps_that_changed = 0;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const Change change = random_change(replayer.state().document().look, dice);
    const Frame before = replayer.image().frame;
    const std::uint64_t segments = replayer.segments();
    const StepResult step = replayer.step(edit_of_list(change.forward), "random", ".");
    const SceneState again = compiled_again(replayer.state());
    const Frame full = rendered(again.scene(), view);
    const std::string what =
        "seed " + std::to_string(seed) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
    ASSERT_EQ(different_pixels(replayer.image().frame, full).size(), 0U) << what;
    ASSERT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full)) << what;
    ASSERT_EQ(step.counters.ray_tests + step.counters.ray_tests_culled, segments) << what;
    steps_that_changed += step.changed_pixels.empty() ? 0 : 1;
    if (k % 10 == 0) {
      ASSERT_NO_FATAL_FAILURE(expect_fresh_structures(replayer, what));
    }
    if (const auto others = with_other_values(change.forward, dice); !others.empty() && dice.chance(0.5)) {
      replayer.step(edit_of_list(others), "random", ".");
      ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, what + " then " + Json(others).dump()));
      replayer.step(edit_of_list(change.forward), "random", ".");
      ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, what + " and again"));
    }
    if (dice.chance(0.1)) {
      ASSERT_NO_FATAL_FAILURE(drag_at_random(replayer, dice, what));
    }
    if (!dice.chance(0.2)) continue;
    const Change next = random_change(replayer.state().document().look, dice);
    const Frame there = replayer.image().frame;
    replayer.step(edit_of_list(next.forward), "random", ".");
    replayer.step(edit_of_list(next.backward), "random", ".");
    ASSERT_EQ(different_pixels(replayer.image().frame, there).size(), 0U) << "undone after: " << what;
  }
  EXPECT_GT(steps_that_changed, kSteps / 3);
}

TEST_P(RandomJournal, UndoneToTheStartGivesTheFirstFrameBack) {
  const auto [scene, samples, threads, shadow_bits] = GetParam();
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  set_thread_count(threads);
  Dice dice(seed + 104729 * samples + static_cast<std::uint64_t>(scene));
  Replayer replayer = replayer_of(scene, {samples, 5, shadow_bits}, random_regions(dice));
  const Json first_look = replayer.state().document().look;
  std::vector<Frame> frames = {replayer.image().frame};
  std::vector<Change> changes;
  for (std::size_t k = 0; k < 30; ++k) {
    changes.push_back(random_change(replayer.state().document().look, dice));
    replayer.step(edit_of_list(changes.back().forward), "random", ".");
    frames.push_back(replayer.image().frame);
    ASSERT_EQ(different_pixels(frames.back(), rendered(compiled_again(replayer.state()).scene(), {samples, 5})).size(),
              0U)
        << "seed " << seed << " " << Json(changes.back().forward).dump();
  }
  for (std::size_t k = changes.size(); k-- > 0;) {
    replayer.step(edit_of_list(changes[k].backward), "random", ".");
    ASSERT_EQ(different_pixels(replayer.image().frame, frames[k]).size(), 0U)
        << "seed " << seed << " undoing " << Json(changes[k].forward).dump();
  }
  EXPECT_EQ(replayer.state().document().look, first_look);
}

INSTANTIATE_TEST_SUITE_P(Seeded, RandomJournal,
                         testing::Values(RandomCase{TestScene::spheres, 1, 1}, RandomCase{TestScene::cards, 1, 2},
                                         RandomCase{TestScene::study, 1, 2}, RandomCase{TestScene::spheres, 4, 2},
                                         RandomCase{TestScene::cards, 4, 1}, RandomCase{TestScene::study, 4, 1},
                                         RandomCase{TestScene::spheres, 1, 2, 1}, RandomCase{TestScene::cards, 1, 2, 2},
                                         RandomCase{TestScene::study, 1, 1, 3}, RandomCase{TestScene::cards, 4, 2, 4}),
                         random_case_name);

}  // namespace
}  // namespace relook
