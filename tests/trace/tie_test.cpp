// Coincident surfaces: the nearest hit does not depend on the order in which objects were added or built.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "test_scenes.h"
#include "trace/tracer.h"

namespace relook {
namespace {

SceneState twins(bool reversed) {
  SceneBuilder scene;
  const int box = scene.mesh("Box", box_mesh(Point(0.5F, 0.6F, 0.5F)), scene.material("Dull", Json::object()));
  std::vector<std::string> names = {"First", "Second", "Third"};
  if (reversed) std::reverse(names.begin(), names.end());
  for (const std::string& name : names)
    scene.node(name, {{"mesh", box}, {"translation", {0.9, 0.5, 1.2}}, {"scale", {0.5, 0.5, 0.5}}});
  scene.light("Lamp", {{"type", "point"}}, Json::object());
  return scene.state();
}

TEST(Ties, NearestHitDoesNotDependOnTheOrderOfObjects) {
  const SceneState one = twins(false), other = twins(true);
  const RayScene rays_one(one.scene()), rays_other(other.scene());
  Tracer tracer;
  const Tracer::TopLevel level_one = tracer.build(rays_one), level_other = tracer.build(rays_other);
  std::mt19937 engine(1996);
  const auto coordinate = [&](float scale) {
    return scale * (static_cast<float>(engine() >> 8) / static_cast<float>(1 << 23) - 1);
  };
  std::size_t hits = 0;
  for (int i = 0; i < 300000; ++i) {
    const float reach = i % 3 == 0 ? 100.0F : 4.0F;
    Ray ray;
    ray.origin = Point(coordinate(reach), coordinate(reach), coordinate(reach));
    ray.direction = Point(0.9F + coordinate(0.25F), 0.5F + coordinate(0.3F), 1.2F + coordinate(0.25F)) - ray.origin;
    ray.origin -= Point(one.scene().camera.eye);
    if (i % 2 == 0) ray.direction.normalize();
    const Meeting a = Tracer::intersect(level_one, ray), b = Tracer::intersect(level_other, ray);
    ASSERT_EQ(a.object.is_none(), b.object.is_none());
    if (a.object.is_none()) continue;
    ++hits;
    ASSERT_EQ(one.scene().object(a.object).node, other.scene().object(b.object).node) << "ray " << i;
    ASSERT_EQ(a.hit, b.hit) << "ray " << i;
    ASSERT_EQ(a.t, b.t) << "ray " << i;
  }
  EXPECT_GT(hits, 200000U);
}

}  // namespace
}  // namespace relook
