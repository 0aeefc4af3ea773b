// Want of memory while acceleration structures are built: our own error afterwards, nothing thrown through Embree, and
// nothing half built is used by whoever builds next.
#include <gtest/gtest.h>

#include <atomic>

#include "base/error.h"
#include "test_scenes.h"
#include "trace/object_levels.h"

namespace relook {
namespace {

/// Throws when it is asked for the n-th time.
struct Shortage {
  std::atomic<int> left = -1;  // calls before it throws; negative: never
  std::atomic<int> thrown = 0;

  MemoryMonitor monitor() {
    return [this](std::int64_t bytes) {
      if (bytes <= 0 || left < 0 || left-- > 0) return;
      ++thrown;
      throw ResourceError("--memory", "no more");
    };
  }
};

/// From high above the scene.
Ray down(const SceneState& state) {
  return {Point(WidePoint(0, 20, 0) - state.scene().camera.eye), Direction(0, -1, 0)};
}

TEST(TracerMemory, a_shortage_at_any_point_of_a_build_is_an_error_and_the_next_build_is_whole) {
  const SceneState state = spheres_scene(8, 8);
  const RayScene rays(state.scene());
  Tracer plain;
  const Meeting expected = Tracer::intersect(plain.build(rays), down(state));
  ASSERT_FALSE(expected.object.is_none());
  int shortages = 0;
  for (int n = 0;; ++n) {
    Shortage shortage;
    Tracer tracer(false, shortage.monitor());
    shortage.left = n;
    bool failed = false;
    try {
      (void)tracer.build(rays);
    } catch (const ResourceError&) {
      failed = true;
    }
    EXPECT_EQ(failed, shortage.thrown > 0) << n;
    shortage.left = -1;
    const Tracer::TopLevel level = tracer.build(rays);
    const Meeting meeting = Tracer::intersect(level, down(state));
    EXPECT_EQ(meeting.object, expected.object) << n;
    EXPECT_EQ(meeting.t, expected.t) << n;
    if (!failed) break;
    ++shortages;
  }
  EXPECT_GT(shortages, 3);
}

TEST(TracerMemory, a_level_stays_what_it_was_when_its_overlay_cannot_be_built) {
  const SceneState state = spheres_scene(8, 8);
  const RayScene rays(state.scene());
  Shortage shortage;
  Tracer tracer(false, shortage.monitor());
  Tracer::TopLevel level = tracer.build(rays);
  const Meeting before = Tracer::intersect(level, down(state));
  RayObject moved = rays.object(before.object);
  moved.mesh = std::make_shared<const Mesh>(*moved.mesh);  // not built yet
  const Tracer::Placed placed{before.object, &moved};
  shortage.left = 0;
  EXPECT_THROW(tracer.replace(level, std::span(&before.object, 1), std::span(&placed, 1)), ResourceError);
  const Meeting after = Tracer::intersect(level, down(state));
  EXPECT_EQ(after.object, before.object);
  EXPECT_EQ(after.t, before.t);
}

TEST(TracerMemory, an_objects_level_is_built_again_after_a_shortage) {
  const SceneState state = spheres_scene(8, 8);
  const RayScene rays(state.scene());
  const ObjectId id = Tracer::intersect(Tracer().build(rays), down(state)).object;
  Shortage shortage;
  ObjectLevels levels(rays, shortage.monitor());
  for (int n = 0; n < 3; ++n) {
    shortage.left = n;
    shortage.thrown = 0;
    try {
      (void)levels.of(id);
    } catch (const ResourceError&) {
    }
  }
  shortage.left = -1;
  EXPECT_EQ(Tracer::intersect(levels.of(id), down(state)).object, id);
}

}  // namespace
}  // namespace relook
