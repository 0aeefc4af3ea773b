// What culls stored segments: each is tested or culled for one reason, as plain geometry over all trees says.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "reference_tracer.h"
#include "stored_trees.h"

namespace relook {
namespace {

constexpr double kUnclear = 5e-3;  // metres: how much closer to a box than this rounding may see a segment

struct WideBox {
  Vec low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};

  void add(const Vec& at) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  }
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  /// Does the segment meet the box, made larger by `more` on all sides?
  [[nodiscard]] bool meets(const Vec& from, const Vec& to, double more) const {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double slope = to[axis] - from[axis];
      const double a = (low[axis] - more - from[axis]) / slope, b = (high[axis] + more - from[axis]) / slope;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }
};

/// Numbers of segments; where rounding decides whether one comes near, it counts as unclear.
struct BruteCulled {
  std::uint64_t near = 0, unclear = 0, far = 0, by_class = 0, dropped = 0;
  [[nodiscard]] std::uint64_t sum() const { return near + unclear + far + by_class + dropped; }
};

struct Places {
  std::set<std::uint32_t> objects;  // of the selection, where they were
  WideBox before, after;
};

void add_place(const Scene& scene, const std::string& node, std::set<std::uint32_t>* objects, WideBox& box) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].node != node || !scene.objects[i].alive) continue;
    if (objects != nullptr) objects->insert(i);
    for (const WorldTriangle& t : world_triangles(scene, i))
      for (const Vec& corner : {t.a, t.b, t.c}) box.add(corner);
  }
}

/// Walks the trees before a geometric step with those after it.
struct GeometricCount {
  const Scene& scene;                                               // after the step
  const std::vector<std::vector<WorldTriangle>>& triangles_before;  // by object
  const Places& places;
  bool counts_blockers = false;
  BruteCulled culled;

  [[nodiscard]] Vec point_of(const TreeNode& node) const {
    const WorldTriangle& t = triangles_before[node.object][node.hit.primitive];
    return t.a * (1.0 - node.hit.u - node.hit.v) + t.b * double{node.hit.u} + t.c * double{node.hit.v};
  }
  void drop(const TreeSize& size) { culled.dropped += size.rays + size.shadows; }

  void add_segment(const Vec& from, const Vec& to, const WideBox* a, const WideBox* b) {
    const auto meets = [&](double more) {
      return (a != nullptr && a->meets(from, to, more)) || (b != nullptr && b->meets(from, to, more));
    };
    ++(meets(-kUnclear) ? culled.near : meets(kUnclear) ? culled.unclear : culled.far);
  }

  void visit(Vec from, const TreeNode& before, const TreeNode& after) {
    if (places.objects.contains(before.object)) {
      drop(size_of(before));
      return;
    }
    const Vec here = point_of(before);
    if (places.after.empty())
      ++culled.by_class;
    else
      add_segment(from, here, &places.after, nullptr);
    if (after.missed || before.object != after.object || before.hit != after.hit) {
      TreeSize below = size_of(before);
      --below.rays;
      drop(below);
      return;
    }
    for (std::size_t i = 0; i < before.lights.size(); ++i) {
      const ShadowState state = before.lights[i].state;
      if (state == ShadowState::facing_away) continue;
      const bool is_blocked = state == ShadowState::blocked;
      const WideBox* then = is_blocked && !places.before.empty() ? &places.before : nullptr;
      const WideBox* now = (!is_blocked || counts_blockers) && !places.after.empty() ? &places.after : nullptr;
      if (then == nullptr && now == nullptr)
        ++culled.by_class;
      else
        add_segment(here, Vec(scene.light(scene.light_order[i]).position), then, now);
    }
    ASSERT_EQ(before.children.size(), after.children.size());
    for (std::size_t i = 0; i < before.children.size(); ++i)
      visit(here, before.children[i].node, after.children[i].node);
  }
};

/// A step, and what brute force says of the trees before it.
struct CountedStep {
  Counters counters;
  BruteCulled brute;
  std::uint64_t segments = 0;
};

CountedStep counted_step(const std::string& node, const char* edit, std::size_t tunnels, std::uint32_t bits) {
  RegionOptions options;
  options.tunnels = tunnels;
  Replayer replayer = replayer_of(closed_room(), {1, 6, bits}, options);
  Places places;
  add_place(replayer.state().scene(), node, &places.objects, places.before);
  std::vector<std::vector<WorldTriangle>> triangles;
  for (std::uint32_t i = 0; i < replayer.state().scene().objects.size(); ++i)
    triangles.push_back(world_triangles(replayer.state().scene(), i));
  const std::vector<TreeNode> before = trees_by_pixel(replayer);
  CountedStep step;
  step.segments = replayer.segments();
  step.counters = replayer.step(parsed_edit(edit), "g", ".").counters;
  const Scene& scene = replayer.state().scene();
  add_place(scene, node, nullptr, places.after);
  GeometricCount count{scene, triangles, places, bits > 0, {}};
  const std::vector<TreeNode> after = trees_by_pixel(replayer);
  for (std::size_t pixel = 0; pixel < before.size(); ++pixel) count.visit(Vec(0, 0, 0), before[pixel], after[pixel]);
  step.brute = count.culled;
  return step;
}

void expect_brute_force(const std::string& node, const char* edit) {
  for (const std::uint32_t bits : {0U, 2U}) {
    SCOPED_TRACE(node + ", " + std::to_string(bits) + " bits");
    const CountedStep without = counted_step(node, edit, 0, bits), with = counted_step(node, edit, 1, bits);
    const BruteCulled& brute = without.brute;
    EXPECT_EQ(brute.sum(), without.segments);
    EXPECT_LT(brute.unclear, brute.near / 5 + 50);  // or the bounds would say little
    for (const CountedStep* step : {&without, &with}) {
      const Counters& counters = step->counters;
      EXPECT_EQ(counters.culled.dropped, brute.dropped);
      EXPECT_GE(counters.ray_tests, brute.near);
      EXPECT_LE(counters.ray_tests, brute.near + brute.unclear);
      EXPECT_EQ(counters.ray_tests_culled, counters.culled.sum());
      EXPECT_EQ(counters.ray_tests + counters.culled.sum(), step->segments);
    }
    const CulledSegments &none = without.counters.culled, &one = with.counters.culled;
    EXPECT_EQ(none.tunnels, 0U);
    EXPECT_EQ(none.by_class, brute.by_class);
    EXPECT_GE(none.boxes, brute.far);
    EXPECT_LE(none.boxes, brute.far + brute.unclear);
    // Of one object tunnels see the same box as the test of each segment: they only save the asking.
    EXPECT_EQ(with.counters.ray_tests, without.counters.ray_tests);
    EXPECT_GT(one.tunnels, one.boxes);
    EXPECT_EQ(one.tunnels + one.boxes + one.by_class, none.boxes + none.by_class);
    EXPECT_LE(one.by_class, none.by_class);
  }
}

TEST(CulledSegments, of_a_moved_opaque_object_are_those_of_brute_force) {
  expect_brute_force("Ball", R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.3, 0.8, -0.5]}])");
}
TEST(CulledSegments, of_a_moved_glass_ball_are_those_of_brute_force) {
  expect_brute_force("GlassBall",
                     R"([{"op": "replace", "path": "/nodes/GlassBall/translation", "value": [1.2, 0.7, 0.6]}])");
}
TEST(CulledSegments, of_a_hidden_object_are_those_of_brute_force) {
  expect_brute_force(
      "Ball", R"([{"op": "replace", "path": "/nodes/Ball/extensions/KHR_node_visibility/visible", "value": false}])");
}
TEST(CulledSegments, of_an_added_object_are_those_of_brute_force) {
  expect_brute_force("New", R"([{"op": "add", "path": "/nodes/New", "value": {"mesh": "MirrorBall",
                                "translation": [0.5, 0.4, 1.2], "scale": [0.4, 0.4, 0.4]}}])");
}

/// Segments below the nodes of a material whose refraction bends, before the step.
std::uint64_t below_refractions(const TreeNode& before, const Scene& scene, const std::string& material) {
  if (before.missed) return 0;
  const bool bends = scene.material(scene.objects[before.object].material).name == material;
  std::uint64_t dropped = 0;
  for (const auto& [branch, child] : before.children) {
    const TreeSize size = size_of(child);
    dropped +=
        bends && branch == Branch::refraction ? size.rays + size.shadows : below_refractions(child, scene, material);
  }
  return dropped;
}

TEST(CulledSegments, of_optical_and_colour_edits_are_dropped_or_of_the_wrong_class) {
  Replayer replayer = replayer_of(closed_room(), {1, 6}, {});
  std::uint64_t segments = replayer.segments(), dropped = 0;
  for (const TreeNode& tree : trees_by_pixel(replayer))
    dropped += below_refractions(tree, replayer.state().scene(), "Glass");
  const CulledSegments optical =
      replayer.step(replace_edit("/materials/Glass/extensions/KHR_materials_ior/ior", 1.8), "o", ".").counters.culled;
  EXPECT_GT(dropped, 0U);
  EXPECT_EQ(optical.dropped, dropped);
  EXPECT_EQ(optical.by_class, segments - dropped);
  EXPECT_EQ(optical.tunnels + optical.boxes, 0U);
  segments = replayer.segments();
  const CulledSegments color = replayer.step(replace_edit("/lights/Lamp/intensity", 20), "c", ".").counters.culled;
  EXPECT_EQ(color.by_class, segments);
  EXPECT_EQ(color.sum(), segments);
}

TEST(CulledSegments, of_a_light_that_moves_or_is_hidden_are_dropped) {
  Replayer replayer = replayer_of(closed_room(), {1, 6}, {});
  for (const Edit& edit : {replace_edit("/nodes/Lamp/translation", {1.5, 3.5, 2}),
                           replace_edit("/nodes/Lamp/extensions/KHR_node_visibility/visible", false)}) {
    const TreeSize before = size_of(replayer.image(), 1);
    const Counters counters = replayer.step(edit, "l", ".").counters;
    EXPECT_EQ(counters.ray_tests, 0U);
    EXPECT_EQ(counters.culled.dropped, before.shadows);
    EXPECT_EQ(counters.culled.by_class, before.rays);
    EXPECT_EQ(counters.culled.sum(), before.rays + before.shadows);
  }
}

}  // namespace
}  // namespace relook
