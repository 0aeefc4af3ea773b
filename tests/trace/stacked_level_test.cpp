// Stacked top levels: after any sequence of edits a base with hidden objects and an overlay answers every ray and
// shadow segment with the same bits as a top level built afresh over the objects as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "test_scenes.h"
#include "trace/tracer.h"

namespace relook {
namespace {

/// Many overlapping objects of few meshes, opaque, transparent and cut out; every third one coincides with another.
SceneState heap_scene(std::mt19937& engine) {
  SceneBuilder scene;
  const int holes =
      scene.texture("Holes", scene.image("Holes", single_level_image(16, [](std::uint32_t x, std::uint32_t y) {
                                           return Rgba(1, 1, 1, (x / 4 + y / 4) % 2 == 0 ? 1.0F : 0.0F);
                                         })));
  const int dull = scene.material("Dull", Json::object());
  const int veil = scene.material(
      "Veil",
      {{"alphaMode", "BLEND"}, {"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}});
  const int net = scene.material("Net", {{"alphaMode", "MASK"},
                                         {"doubleSided", true},
                                         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", holes}}}}}});
  const std::vector<int> meshes = {
      scene.mesh("Box", box_mesh(Point(0.5F, 0.6F, 0.5F)), dull), scene.mesh("Ball", sphere_mesh(0.6F, 12, 8), dull),
      scene.mesh("VeilBox", box_mesh(Point(0.7F, 0.4F, 0.5F)), veil), scene.mesh("Card", card_mesh(0.9F, 0.9F), net),
      scene.mesh("NetBall", sphere_mesh(0.8F, 10, 6), net)};
  const auto coordinate = [&] { return static_cast<double>(engine() % 4096) / 1024 - 2; };
  Json place;
  for (int i = 0; i < 60; ++i) {
    const bool is_twin = i % 3 == 2;
    if (!is_twin) {
      place = {{"mesh", meshes[engine() % meshes.size()]}, {"translation", {coordinate(), coordinate(), coordinate()}}};
      if (i % 4 == 0) place["scale"] = {1, -0.75, 1.25};
      if (i % 4 == 1) place["rotation"] = {0.36, 0.48, 0, 0.8};
    }
    scene.node("Thing" + std::to_string(i), place);
  }
  scene.light("Lamp", {{"type", "point"}}, Json::object());
  return scene.state();
}

/// A scene whose objects are edited one by one, in place.
class Stage {
 public:
  Stage(const SceneState& state, std::mt19937& engine)
      : scene_(state.scene()), rays_(scene_), engine_(engine), objects_(scene_.objects) {
    for (std::uint32_t i = 0; i < objects_.size(); ++i) entries_.push_back(std::make_unique<RayObject>(entry(i)));
  }

  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  [[nodiscard]] Tracer::Placed placed(std::size_t i) const {
    return {ObjectId(static_cast<std::uint32_t>(i)), entries_[i].get()};
  }
  [[nodiscard]] std::vector<Tracer::Placed> all() const {
    std::vector<Tracer::Placed> list;
    for (std::size_t i = 0; i < size(); ++i) list.push_back(placed(i));
    return list;
  }

  /// Hides, shows, moves, doubles or gives another material to one object, or adds one.
  std::size_t edit() {
    std::size_t i = pick(size());
    const std::size_t other = pick(size());
    switch (pick(6)) {
      case 0:
        objects_[i].alive = false;
        break;
      case 1:
        objects_[i].alive = true;
        break;
      case 2:
        objects_[i].to_world[3][pick(3)] += coordinate(0.5F);
        break;
      case 3:
        objects_[i].to_world = objects_[other].to_world;
        break;
      case 4:
        objects_[i].material = MaterialId(static_cast<std::uint32_t>(pick(scene_.materials.size())));
        break;
      default:
        i = size();
        objects_.push_back(objects_[other]);
        objects_.back().key = objects_[other].key ^ engine_();
        entries_.push_back(std::make_unique<RayObject>());
    }
    *entries_[i] = entry(i);
    return i;
  }

  /// From anywhere to a vertex of an object, or past it.
  Ray ray() {
    Ray ray;
    ray.origin = Point(coordinate(4), coordinate(4), coordinate(4));
    const RayObject& object = *entries_[pick(size())];
    Point target = object.mesh->positions[pick(object.mesh->positions.size())] * object.to_world;
    if (pick(3) != 0) target += Point(coordinate(0.4F), coordinate(0.4F), coordinate(0.4F));
    if (pick(8) == 0) ray.origin = Point(target.x, target.y, ray.origin.z);  // grazing boxes
    ray.direction = target - ray.origin;
    return ray;
  }
  std::size_t pick(std::size_t count) { return engine_() % count; }

 private:
  [[nodiscard]] RayObject entry(std::size_t i) const {
    return rays_.make_object(scene_, objects_[i], scene_.material(objects_[i].material));
  }
  float coordinate(float scale) {
    return scale * (static_cast<float>(engine_() >> 8) / static_cast<float>(1 << 23) - 1);
  }

  const Scene& scene_;
  RayScene rays_;
  std::mt19937& engine_;
  std::vector<Object> objects_;
  std::vector<std::unique_ptr<RayObject>> entries_;
};

struct Answers {
  std::size_t hits = 0, blocked = 0, filtered = 0;
};

void expect_same_answers(const Tracer::TopLevel& stacked, const Tracer::TopLevel& fresh, const Ray& ray,
                         Answers& answers) {
  const Meeting a = Tracer::intersect(stacked, ray), b = Tracer::intersect(fresh, ray);
  ASSERT_EQ(a.object, b.object);
  ASSERT_EQ(a.t, b.t);
  ASSERT_EQ(a.key, b.key);
  ASSERT_EQ(a.hit, b.hit);
  answers.hits += a.object.is_none() ? 0 : 1;
  std::vector<Crossing> crossings_a, crossings_b;
  const bool passes = Tracer::passes(fresh, ray, crossings_b);
  ASSERT_EQ(Tracer::passes(stacked, ray, crossings_a), passes);
  if (!passes) crossings_a = crossings_b;  // says nothing then
  ASSERT_EQ(crossings_a, crossings_b);
  answers.blocked += passes ? 0 : 1;
  answers.filtered += passes && !crossings_b.empty() ? 1 : 0;
}

void expect_same_blockers(const Tracer::TopLevel& stacked, const Tracer::TopLevel& fresh, const Ray& ray) {
  std::vector<Crossing> a, b;
  Tracer::blockers(stacked, ray, a);
  Tracer::blockers(fresh, ray, b);
  ASSERT_EQ(a, b);
}

/// Rounds of edits on one base; each replaces the layers of the round before.
void check_rounds(Stage& stage, bool count_blockers, Answers& answers) {
  Tracer tracer(count_blockers);
  Tracer::TopLevel stacked = tracer.build(stage.all());
  std::vector<std::size_t> changed;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    for (std::size_t edits = 1 + stage.pick(3); edits > 0; --edits) {
      const std::size_t i = stage.edit();
      if (std::ranges::find(changed, i) == changed.end()) changed.push_back(i);
    }
    std::vector<ObjectId> hidden;
    std::vector<Tracer::Placed> added;
    for (const std::size_t i : changed) {
      hidden.push_back(stage.placed(i).id);
      added.push_back(stage.placed(i));
    }
    tracer.replace(stacked, hidden, added);
    const Tracer::TopLevel fresh = tracer.build(stage.all());
    ASSERT_EQ(stacked.empty(), fresh.empty());
    for (int i = 0; i < 3000; ++i) {
      Ray ray = stage.ray();
      if (i % 2 == 0) ray.t_max = 1;
      ASSERT_NO_FATAL_FAILURE(expect_same_answers(stacked, fresh, ray, answers)) << "ray " << i;
      if (!count_blockers) continue;
      ASSERT_NO_FATAL_FAILURE(expect_same_blockers(stacked, fresh, ray)) << "ray " << i;
    }
  }
}

TEST(StackedLevel, EqualsALevelBuiltAfreshOnTheTestScenes) {
  std::mt19937 engine(1996);
  Answers answers;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const bool count_blockers : {false, true}) {
      SCOPED_TRACE(test_scene_name(scene));
      const SceneState state = test_scene(scene, 8, 8);
      Stage stage(state, engine);
      ASSERT_NO_FATAL_FAILURE(check_rounds(stage, count_blockers, answers));
    }
  EXPECT_GT(answers.hits, 50000U);
  EXPECT_GT(answers.blocked, 20000U);
  EXPECT_GT(answers.filtered, 5000U);
}

TEST(StackedLevel, EqualsALevelBuiltAfreshOnHeaps) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 engine(seed);
    Answers answers;
    const SceneState state = heap_scene(engine);
    Stage stage(state, engine);
    ASSERT_NO_FATAL_FAILURE(check_rounds(stage, seed % 2 == 0, answers));
    EXPECT_GT(answers.hits, 15000U);
    EXPECT_GT(answers.blocked, 5000U);
    EXPECT_GT(answers.filtered, 500U);
  }
}

class StackedLevelEnds : public testing::Test {
 protected:
  void expect_equal(const Tracer::TopLevel& stacked, const std::vector<Tracer::Placed>& objects) {
    const Tracer::TopLevel fresh = tracer_.build(objects);
    EXPECT_EQ(stacked.empty(), fresh.empty());
    Answers answers;
    for (int i = 0; i < 5000; ++i) {
      const Ray ray = stage_.ray();
      ASSERT_NO_FATAL_FAILURE(expect_same_answers(stacked, fresh, ray, answers)) << "ray " << i;
      ASSERT_NO_FATAL_FAILURE(expect_same_blockers(stacked, fresh, ray)) << "ray " << i;
    }
    EXPECT_EQ(answers.hits == 0, fresh.empty());
  }
  [[nodiscard]] std::vector<ObjectId> ids() const {
    std::vector<ObjectId> list;
    for (const Tracer::Placed& placed : stage_.all()) list.push_back(placed.id);
    return list;
  }

  std::mt19937 engine_{3};
  SceneState state_ = heap_scene(engine_);
  Stage stage_{state_, engine_};
  Tracer tracer_{true};
};

TEST_F(StackedLevelEnds, EverythingHidden) {
  Tracer::TopLevel level = tracer_.build(stage_.all());
  tracer_.replace(level, ids(), {});
  EXPECT_TRUE(level.empty());
  expect_equal(level, {});
  const std::vector<Tracer::Placed> one = {stage_.placed(1)};
  tracer_.replace(level, ids(), one);
  EXPECT_FALSE(level.empty());
  expect_equal(level, one);
}

TEST_F(StackedLevelEnds, EachReplaceStartsFromTheBase) {
  Tracer::TopLevel level = tracer_.build(stage_.all());
  const std::vector<Tracer::Placed> one = {stage_.placed(1)};
  tracer_.replace(level, ids(), one);
  const std::vector<ObjectId> twice = {stage_.placed(7).id, stage_.placed(7).id, ObjectId(100000)};
  tracer_.replace(level, twice, {});
  std::vector<Tracer::Placed> rest = stage_.all();
  rest.erase(rest.begin() + 7);
  expect_equal(level, rest);
  tracer_.replace(level, {}, {});
  expect_equal(level, stage_.all());
}

TEST_F(StackedLevelEnds, BaseEmpty) {
  Tracer::TopLevel never_built, built = tracer_.build(std::vector<Tracer::Placed>());
  for (Tracer::TopLevel* level : {&never_built, &built}) {
    EXPECT_TRUE(level->empty());
    tracer_.replace(*level, ids(), {});
    EXPECT_TRUE(level->empty());
    tracer_.replace(*level, ids(), stage_.all());
    expect_equal(*level, stage_.all());
  }
}

TEST_F(StackedLevelEnds, BaseOfOneObject) {
  const std::vector<Tracer::Placed> one = {stage_.placed(1)}, other = {stage_.placed(2)};
  Tracer::TopLevel level = tracer_.build(one);
  expect_equal(level, one);
  const std::vector<ObjectId> id = {stage_.placed(1).id};
  tracer_.replace(level, id, {});
  EXPECT_TRUE(level.empty());
  expect_equal(level, {});
  tracer_.replace(level, id, other);
  expect_equal(level, other);
}

TEST_F(StackedLevelEnds, ObjectsThatDoNotLiveAreNotAdded) {
  Tracer::TopLevel level = tracer_.build(stage_.all());
  RayObject dead = *stage_.placed(1).object;
  dead.alive = false;
  const std::vector<Tracer::Placed> added = {{ObjectId(1000), &dead}};
  tracer_.replace(level, ids(), added);
  EXPECT_TRUE(level.empty());
}

TEST_F(StackedLevelEnds, BlockersAreThoseOfEveryObjectAlone) {
  const Tracer::TopLevel level = tracer_.build(stage_.all());
  std::vector<Tracer::TopLevel> alone;
  for (const Tracer::Placed& placed : stage_.all()) alone.push_back(tracer_.build(std::vector<Tracer::Placed>{placed}));
  std::size_t opaque_segments = 0;
  std::vector<Crossing> found, crossings, part;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = stage_.ray();
    Tracer::blockers(level, ray, found);
    std::vector<Crossing> expected;
    for (const Tracer::TopLevel& object : alone) {
      Tracer::blockers(object, ray, part);
      expected.insert(expected.end(), part.begin(), part.end());
    }
    std::ranges::sort(expected, {}, [](const Crossing& c) { return std::tuple(c.t, c.key, c.hit.primitive); });
    ASSERT_EQ(found, expected) << "ray " << i;
    const bool any_opaque = std::ranges::any_of(
        found, [&](const Crossing& c) { return !stage_.placed(c.object.index()).object->optics.passes_light; });
    const bool passes = Tracer::passes(level, ray, crossings);
    ASSERT_EQ(passes, !any_opaque) << "ray " << i;
    opaque_segments += any_opaque ? 1 : 0;
    if (!passes) continue;
    ASSERT_EQ(crossings, found) << "ray " << i;
  }
  EXPECT_GT(opaque_segments, 1000U);
}

// A box that rounding puts just behind the end of the segment was opened only if something else had been met there.
TEST(StackedLevel, TheEndOfASegmentDoesNotDependOnOtherObjects) {
  SceneBuilder scene;
  const int dull = scene.material("Dull", Json::object());
  scene.node("Box", {{"mesh", scene.mesh("Box", box_mesh(Point(0.3F, 0.4F, 0.7F)), dull)}});
  const int slope = scene.mesh("Slope", plane_mesh(3, 4), dull);
  scene.node("Slope", {{"mesh", slope}, {"translation", {0.3, 0.4, 0.7}}, {"rotation", {0.48, 0, -0.36, 0.8}}});
  scene.light("Lamp", {{"type", "point"}}, Json::object());
  const SceneState state = scene.state();
  const RayScene rays(state.scene());
  Tracer tracer;
  const std::vector<Tracer::Placed> first = {{ObjectId(0), &rays.object(ObjectId(0))}};
  const std::vector<Tracer::Placed> second = {{ObjectId(1), &rays.object(ObjectId(1))}};
  const Tracer::TopLevel both = tracer.build(rays), one = tracer.build(first), other = tracer.build(second);
  std::mt19937 engine(7);
  const auto coordinate = [&] { return 0.5F + static_cast<float>(engine() >> 8) / static_cast<float>(1 << 22); };
  for (int i = 0; i < 100000; ++i) {
    Ray ray;
    ray.origin = Point(coordinate(), coordinate(), coordinate());
    ray.direction = Point(0.3F, 0.4F, 0.7F) - ray.origin;  // the corner of the box that lies in the slope
    ray.t_max = 1;
    Meeting nearest = Tracer::intersect(one, ray);
    const Meeting candidate = Tracer::intersect(other, ray), meeting = Tracer::intersect(both, ray);
    if (candidate.nearer_than(nearest)) nearest = candidate;
    ASSERT_EQ(meeting.object, nearest.object) << "ray " << i;
    ASSERT_EQ(meeting.t, nearest.t) << "ray " << i;
    ASSERT_EQ(meeting.hit, nearest.hit) << "ray " << i;
  }
}

}  // namespace
}  // namespace relook
