// Where segments of stored trees run, kept between steps of the path integrator: a scan over them names every sample
// that a ray test would look at, and few others; and after whatever moves, comes, goes or hides in turn, the image is
// that of a fresh preprocess.
#include "trace/update/kept_segments.h"

#include <gtest/gtest.h>

#include <iostream>

#include "image/sampling.h"
#include "image/tile_light.h"
#include "path_checks.h"
#include "random_lights.h"
#include "trace/box_range.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/segment_tests.h"

namespace relook {
namespace {

/// A selection of boxes, the same for all kinds of segments.
SegmentSelection selection_of(const std::vector<Box>& boxes, float condition = 1) {
  SelectionBoxes all;
  for (const Box& box : boxes) all.all.extendBy(box);
  if (boxes.size() > 1) all.parts = boxes;
  return {{all, all, all}, condition};
}

bool is_near(const SegmentSelection& selection, const Ray& ray) {
  const SelectionBoxes& boxes = selection.of[0];
  const auto meets = [&](const Box& box) {
    return may_meet(box, selection.condition, ray.origin, ray.direction, ray.t_min, ray.t_max);
  };
  return boxes.parts.empty() ? meets(boxes.all) : std::ranges::any_of(boxes.parts, meets);
}

Box wider(const Box& box, float by) {
  const Point around(by, by, by);
  return {box.min - around, box.max + around};
}

class SegmentScan : public testing::Test {
 protected:
  /// Somewhere in a cube around the origin, on a plane of a grid perhaps.
  Point random_point(double half) {
    const auto at = [&] {
      const double there = dice_.between(-half, half) + dice_.between(-half, half) / 64;
      return static_cast<float>(dice_.chance(0.1) ? std::round(there) : there);
    };
    return {at(), at(), at()};
  }
  Box random_box(double half, double size) {
    Box box(random_point(half));
    box.extendBy(box.min + (random_point(size) + Point(1, 1, 1) * static_cast<float>(size)) * 0.5F);
    return box;
  }
  SpawnedRay random_ray() {
    SpawnedRay ray;
    ray.origin = random_point(dice_.chance(0.1) ? 300 : 12);
    ray.direction = random_point(1);
    if (dice_.chance(0.2)) ray.direction[static_cast<int>(dice_.below(3))] = 0;
    if (dice_.chance(0.05)) ray.direction = {0, dice_.chance(0.5) ? 1.0F : -1.0F, 0};
    if (dice_.chance(0.7)) ray.end = static_cast<float>(dice_.between(0, 20));
    if (dice_.chance(0.3)) ray.start = static_cast<float>(dice_.between(0, 4));
    return ray;
  }
  /// One segment a sample.
  void add(const SpawnedRay& ray) {
    block_.nodes.emplace_back(kNoNode, static_cast<std::uint32_t>(block_.nodes.size()), ray);
    segments_.append(scene_, block_, static_cast<std::uint32_t>(block_.nodes.size() - 1));
  }
  [[nodiscard]] std::vector<std::uint8_t> touched(const SegmentSelection& selection) const {
    std::vector<std::uint8_t> touched(segments_.samples());
    segments_.find_touched(selection, touched);
    return touched;
  }

  Dice dice_{seed_of_run()};
  SceneState state_ = with_integrator(test_scene(TestScene::spheres, 8, 8), Integrator::path);
  ColorScene scene_{state_.scene()};
  TreeBlock block_;
  TileSegments segments_;
};

TEST_F(SegmentScan, misses_nothing_that_ray_tests_look_at) {
  std::cout << "RELOOK_SEED=" << seed_of_run() << "\n";
  std::size_t near = 0, told = 0;
  for (int round = 0; round < 200; ++round) {
    const std::size_t count = 1 + dice_.below(6);
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < count; ++k) boxes.push_back(random_box(8, dice_.chance(0.3) ? 0.05 : 5));
    const SegmentSelection selection = selection_of(boxes, dice_.chance(0.5) ? 1.0F : 8.0F);
    block_.clear();
    const Box scene(Point(-12, -12, -12), Point(12, 12, 12));
    segments_ = TileSegments(SegmentGrid(scene, wider(selection.of[0].all, 0.5F)));
    for (int k = 0; k < 700; ++k) add(random_ray());
    ASSERT_TRUE(segments_.can_tell(selection));
    const std::vector<std::uint8_t> found = touched(selection);
    for (std::size_t sample = 0; sample < found.size(); ++sample) {
      const bool is_tested = is_near(selection, stored_segment(block_.nodes[sample].ray));
      near += is_tested ? 1 : 0;
      told += found[sample];
      EXPECT_TRUE(found[sample] != 0 || !is_tested) << "round " << round << ", segment " << sample;
    }
  }
  EXPECT_GT(near, 800U);
  EXPECT_LT(told, near + near / 4) << "and hardly more than these";
}

TEST_F(SegmentScan, tells_small_things_in_large_scenes) {
  const Box thing(Point(3, 3, 3), Point(3.01F, 3.02F, 3.01F));
  segments_ = TileSegments(SegmentGrid(Box(Point(-5000, -5000, -5000), Point(5000, 5000, 5000)), thing));
  SpawnedRay ray;
  ray.origin = {0, 3.01F, 3.005F};
  ray.direction = {1, 0, 0};
  add(ray);
  ray.end = 2.99F;  // ends before it
  add(ray);
  ray.end = 4;
  ray.origin.y = 3.03F;  // passes by
  add(ray);
  ray.origin = {0, 40, 0};  // outside of the grid
  add(ray);
  ASSERT_TRUE(segments_.can_tell(selection_of({thing})));
  EXPECT_EQ(touched(selection_of({thing})), (std::vector<std::uint8_t>{1, 0, 0, 0}));
}

TEST_F(SegmentScan, says_what_it_cannot_tell) {
  const Box thing(Point(0, 0, 0), Point(1, 1, 1)), scene(Point(-9, -9, -9), Point(9, 9, 9));
  segments_ = TileSegments(SegmentGrid(scene, thing));
  add({});
  EXPECT_TRUE(segments_.can_tell(selection_of({thing})));
  EXPECT_FALSE(segments_.can_tell(selection_of({Box(Point(0, 0, 0), Point(200, 1, 1))}))) << "it is not in the grid";
  EXPECT_FALSE(segments_.can_tell(selection_of({Box(Point(0, 0, 0), Point(1e-5F, 1e-5F, 1e-5F))}))) << "too small";
  EXPECT_FALSE(TileSegments(SegmentGrid(scene, Box())).can_tell(selection_of({thing}))) << "no grid at all";
}

TEST_F(SegmentScan, goes_by_sample_whatever_was_put_together) {
  const Box thing(Point(0, 0, 0), Point(1, 1, 1)), scene(Point(-9, -9, -9), Point(9, 9, 9));
  const SegmentGrid grid(scene, thing);
  segments_ = TileSegments(grid);
  SpawnedRay away, through;
  away.origin = {5, 5, 5};
  through.origin = {0.5F, 0.5F, 5};
  for (int k = 0; k < 400; ++k) add(k % 7 == 3 ? through : away);
  TileSegments again(grid);
  again.append(segments_, 0, 100);
  again.append(segments_, 3, 4);
  again.append(segments_, 100, 400);
  ASSERT_EQ(again.samples(), 401U);
  std::vector<std::uint8_t> found(again.samples());
  again.find_touched(selection_of({thing}), found);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t old = k < 100 ? k : k - 1;
    EXPECT_EQ(found[k] != 0, k == 100 || old % 7 == 3) << k;
  }
}

class KeptSegments : public testing::TestWithParam<TestScene> {
 protected:
  static ViewOptions view() {
    ViewOptions view = path_view(4);
    view.diffuse_depth = 2;
    return view;
  }
};

/// All segments of a tree, as ray tests know them.
std::vector<Ray> segments_of(const ColorScene& scene, const TreeBlock& block, std::uint32_t root) {
  std::vector<Ray> segments;
  for (std::size_t i = root; i < block.nodes.size() && block.nodes[i].sample == block.nodes[root].sample; ++i) {
    const RayNode& node = block.nodes[i];
    if (node.object.is_none()) {
      segments.push_back(stored_segment(node.ray));
      continue;
    }
    segments.push_back(stored_segment(node, distance_slack(node, scene.object(node.object))));
    for (std::size_t light = 0; light < scene.light_order().size(); ++light)
      if (block.lights[node.first_light + light].state != ShadowState::facing_away)
        segments.push_back(shadow_segment(node, scene.light(light)).ray());
  }
  return segments;
}

TEST_P(KeptSegments, name_every_sample_that_an_object_may_touch) {
  const SceneState state = with_integrator(test_scene(GetParam(), 24, 18), Integrator::path);
  const Image image = preprocessed(state.scene(), view());
  const ColorScene scene(state.scene());
  Tracer tracer;
  const Tracer::TopLevel level = tracer.build(scene);
  const GrowScene grow = grow_scene(scene, &level, view(), 0);
  const PrimaryRays primaries(scene.camera(), view());
  const TileRect rect = tile_rect(0, image.frame.width, image.frame.height);
  const auto count = static_cast<std::uint32_t>(image.trees[0].paths.size());
  std::vector<SpawnedRay> rays;
  primaries.append(rect, 0, count, rays);
  TreeBlock block;
  block.keeps_lines = true;
  std::vector<std::uint32_t> roots;
  GrowCounters counters;
  trace_trees(grow, rays, 0, block, roots, counters);
  Box all;
  for (std::uint32_t object = 0; object < scene.size(); ++object)
    if (scene.object(ObjectId(object)).alive) all.extendBy(world_bounds(scene.object(ObjectId(object))));
  std::size_t left_alone = 0;
  for (std::uint32_t object = 0; object < scene.size(); ++object) {
    if (!scene.object(ObjectId(object)).alive) continue;
    const Box box = world_bounds(scene.object(ObjectId(object)));
    const SegmentSelection selection = selection_of({box}, scene.object(ObjectId(object)).condition);
    TileSegments kept{SegmentGrid(all, wider(box, 0.01F))};
    for (const std::uint32_t root : roots) kept.append(scene, block, root);
    ASSERT_TRUE(kept.can_tell(selection));
    std::vector<std::uint8_t> touched(kept.samples());
    kept.find_touched(selection, touched);
    for (std::uint32_t sample = 0; sample < count; ++sample) {
      const std::vector<Ray> segments = segments_of(scene, block, roots[sample]);
      std::uint32_t number = 0;
      for (std::size_t kind = 0; kind < kSegmentKinds; ++kind)
        number += kept.count(static_cast<SegmentKind>(kind), sample);
      EXPECT_EQ(number, segments.size());
      const bool is_tested = std::ranges::any_of(segments, [&](const Ray& ray) { return is_near(selection, ray); });
      EXPECT_TRUE(touched[sample] != 0 || !is_tested) << "object " << object << ", sample " << sample;
      left_alone += touched[sample] != 0 ? 0 : 1;
    }
  }
  EXPECT_GT(left_alone, count / 2) << "some objects are small";
}

INSTANTIATE_TEST_SUITE_P(Scenes, KeptSegments,
                         testing::Values(TestScene::lights, TestScene::spheres, TestScene::cards, TestScene::study));

struct MovesCase {
  TestScene scene;
  std::uint32_t samples;
  bool is_limited = false;
  double ray_trees = 1;
};
void PrintTo(const MovesCase& c, std::ostream* out) { *out << test_scene_name(c.scene) << ", " << c.samples; }

class PathMoves : public testing::TestWithParam<MovesCase> {
 protected:
  static constexpr std::size_t kSteps = 36;

  static Replayer start(const MovesCase& c) {
    const SceneState state = test_scene(c.scene, 70, 20);  // two tiles
    RegionOptions regions;
    regions.ray_trees = c.ray_trees;
    ResidencyOptions options;
    options.process_bytes = nullptr;
    if (c.is_limited) {
      const Resident all = path_replayer(state, path_view(c.samples)).resident();
      options.memory_bytes = (all.ray_trees + all.light_sums) * 2;
      options.spill_folder = testing::TempDir();
    }
    return path_replayer(state, path_view(c.samples), options, regions);
  }
  /// Mostly of objects, now and then of anything.
  static Change random_step(const Json& look, Dice& dice) {
    const double kind = dice.between(0, 1);
    if (kind < 0.15) return random_path_change(look, dice);
    if (kind < 0.3) {
      Change change;
      const std::string extra = "/nodes/Extra" + std::to_string(dice.below(2));
      if (look.contains(Json::json_pointer(extra)))
        change.remove(look, extra);
      else
        change.set(look, extra,
                   {{"mesh", "GlassBall"},
                    {"translation", {dice.between(-1, 1), dice.between(0.3, 2), dice.between(-1, 1)}},
                    {"scale", {0.3, 0.3, 0.3}}});
      return change;
    }
    return random_movement(look, dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall"}), dice);
  }
};

TEST_P(PathMoves, GiveAFreshImage) {
  const MovesCase c = GetParam();
  std::cout << "RELOOK_SEED=" << seed_of_run() << "\n";
  Dice dice(seed_of_run() + 17 * static_cast<std::uint64_t>(c.scene) + c.samples);
  Replayer replayer = start(c);
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const Change change = random_step(replayer.state().document().look, dice);
    const std::string what =
        "seed " + std::to_string(seed_of_run()) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
    const bool has_trees = !c.is_limited && c.ray_trees == 1;
    expect_path_step(replayer, edit_of_list(change.forward), what, {has_trees, false}, dice.chance(0.2));
    ASSERT_FALSE(HasFailure()) << "no further steps after " << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeded, PathMoves,
                         testing::Values(MovesCase{TestScene::lights, 1}, MovesCase{TestScene::lights, 4},
                                         MovesCase{TestScene::spheres, 2}, MovesCase{TestScene::cards, 2},
                                         MovesCase{TestScene::study, 2}, MovesCase{TestScene::lights, 3, true},
                                         MovesCase{TestScene::spheres, 3, true},
                                         MovesCase{TestScene::lights, 2, false, 0.5},
                                         MovesCase{TestScene::cards, 3, false, 0}));

TEST(PathMovesCounters, tell_what_is_left_alone) {
  Replayer replayer = path_replayer(test_scene(TestScene::lights, 60, 40), path_view(2));
  const auto move = [&](double x) {
    return replayer.step(replace_edit("/nodes/Ball/translation", {x, 0.6, 0.2}), "path", ".").counters;
  };
  const auto lamp = [&](double y) {  // its segments are others: none are kept then
    return replayer.step(replace_edit("/nodes/Lamp/translation", {2.0, y, 3.0}), "path", ".").counters;
  };
  static_cast<void>(move(-0.55));
  static_cast<void>(lamp(3.5));
  static_cast<void>(lamp(4.0));
  const Counters first = move(-0.5);
  static_cast<void>(move(-0.55));
  const Counters again = move(-0.5);
  EXPECT_EQ(again.samples_affected, first.samples_affected);
  EXPECT_EQ(again.ray_tests, first.ray_tests);
  EXPECT_EQ(again.culled.boxes, first.culled.boxes);
  EXPECT_EQ(again.culled.by_class, first.culled.by_class);
  EXPECT_EQ(again.culled.dropped, first.culled.dropped);
  EXPECT_GT(again.culled.boxes, again.ray_tests);
}

}  // namespace
}  // namespace relook
