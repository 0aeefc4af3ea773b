// Shadow counters (paper 4.2) in paths, against a loop over all triangles of all objects; in updates, where they save
// shadow segments.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "image/sampling.h"
#include "reference_tracer.h"
#include "replay/replay.h"
#include "test_scenes.h"
#include "trace/shadow/shadow_counter.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/grow.h"
#include "tree_reader.h"
#include "unbounded_counter.h"

namespace relook {
namespace {

/// A floor under a lamp and a sun. Between them, on four levels, opaque slabs that overlap each other, and panes and a
/// ball that let light through. The camera looks from below the lowest slab, so that it sees little but the floor.
SceneState levels_scene(bool with_glass) {
  SceneBuilder scene;
  Json plastic = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"doubleSided", true}};
  const int dull = scene.material("Dull", plastic);
  plastic["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  const int glass = scene.material("Glass", plastic);
  const int slab = scene.mesh("Slab", box_mesh(Point(0.8F, 0.05F, 0.7F)), dull);
  const int pane = scene.mesh("Pane", box_mesh(Point(0.9F, 0.04F, 0.9F)), glass);
  const int ball = scene.mesh("Ball", sphere_mesh(0.4F, 12, 8), glass);
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(4, 3), dull)}});
  for (int level = 0; level < 4; ++level)
    for (int i = 0; i < 3; ++i) {
      const std::string name = "Slab" + std::to_string(level) + std::to_string(i);
      scene.node(name, {{"mesh", slab},
                        {"translation", {-1.3 + 1.1 * i + 0.23 * level, 1.5 + 0.5 * level, 0.4 * i - 0.31 * level}}});
    }
  if (with_glass) {
    scene.node("LowPane", {{"mesh", pane}, {"translation", {-0.4, 1.77, 0.3}}});
    scene.node("HighPane", {{"mesh", pane}, {"translation", {0.5, 2.77, -0.2}}});
    scene.node("Ball", {{"mesh", ball}, {"translation", {0.9, 2.2, 0.4}}, {"scale", {1, 0.5, 1}}});
  }
  scene.light("Lamp", {{"type", "point"}, {"intensity", 60}}, {{"translation", {0.3, 6, 0.5}}});
  scene.light("Sun", {{"type", "directional"}}, {{"rotation", {-0.6427876, 0, 0, 0.7660444}}});
  scene.look_at(Point(0.1F, 1.2F, 4), Point(0, -0.2F, 0), 50, 64, 48);
  return scene.state();
}

/// Where a segment crosses an object, by brute force.
struct BruteCrossing {
  double t;
  std::uint32_t object;
};

/// All crossings in order; false when rounding might decide: at an edge, or where two surfaces lie close together.
bool cross_all(const std::vector<WorldTriangle>& triangles, const ShadowSegment& segment,
               std::vector<BruteCrossing>& crossings) {
  constexpr double kNear = 1e-4;
  crossings.clear();
  const Vec origin(segment.origin), direction(segment.direction);
  for (const WorldTriangle& triangle : triangles) {
    const LineHit hit = intersect(triangle, origin, direction);
    const bool on_segment = hit.t > 0 && hit.t < double{segment.t_max};
    if (on_segment &&
        intersect(triangle, origin, direction, kNear).inside != intersect(triangle, origin, direction, -kNear).inside)
      return false;
    if (hit.inside && on_segment) crossings.push_back({hit.t, triangle.object});
  }
  std::ranges::sort(crossings, {}, &BruteCrossing::t);
  for (std::size_t i = 1; i < crossings.size(); ++i)
    if (crossings[i].t - crossings[i - 1].t < kNear) return false;
  return true;
}

/// The entry of a blocked light, or nothing if no opaque object is in the way.
std::vector<std::uint32_t> expected_entry(const Scene& scene, const std::vector<BruteCrossing>& crossings,
                                          std::uint32_t bits) {
  std::vector<std::uint32_t> entry = {0};
  std::vector<std::set<std::uint32_t>> intervals(1);
  bool is_blocked = false;
  for (const BruteCrossing& crossing : crossings) {
    if (scene.material(scene.objects[crossing.object].material).name == "Glass") {
      ++entry[0];
      entry.push_back(crossing.object);
      intervals.emplace_back();
    } else {
      intervals.back().insert(crossing.object);
      is_blocked = true;
    }
  }
  if (!is_blocked) return {};
  for (const auto& objects : intervals) entry.push_back(word_of(objects.size(), bits));
  return entry;
}

struct OracleCounts {
  std::uint64_t compared = 0, unclear = 0, blocked = 0, behind_glass = 0, overflows = 0;
  std::set<std::vector<std::uint32_t>> entries;
};

void compare_links(const Scene& scene, const TreeBlock& block, const std::vector<WorldTriangle>& triangles,
                   std::uint32_t bits, OracleCounts& counts) {
  std::vector<BruteCrossing> crossings;
  for (const RayNode& node : block.nodes) {
    for (std::size_t light = 0; !node.object.is_none() && light < scene.light_order.size(); ++light) {
      const LightLink& link = block.lights[node.first_light + light];
      if (link.state == ShadowState::facing_away) continue;
      const ShadowSegment segment = shadow_segment(node, scene.light(scene.light_order[light]));
      if (!cross_all(triangles, segment, crossings)) {
        ++counts.unclear;
        continue;
      }
      ++counts.compared;
      const std::vector<std::uint32_t> expected = expected_entry(scene, crossings, bits);
      ASSERT_EQ(link.state == ShadowState::blocked, !expected.empty());
      if (expected.empty()) {
        ASSERT_EQ(link.filters, crossings.size());
        continue;
      }
      ASSERT_TRUE(std::ranges::equal(block.blocker_entry(link), expected));
      ++counts.blocked;
      counts.behind_glass += expected[0] > 0 ? 1 : 0;
      counts.overflows += std::ranges::count(std::span(expected).subspan(1 + expected[0]), 1U << bits) > 0 ? 1 : 0;
      counts.entries.insert(expected);
    }
  }
}

TEST(ShadowCounter, stored_counters_are_those_of_a_loop_over_all_objects) {
  const SceneState state = levels_scene(true);
  const RayScene rays(state.scene());
  std::vector<WorldTriangle> triangles;
  for (std::uint32_t i = 0; i < state.scene().objects.size(); ++i)
    for (const WorldTriangle& triangle : world_triangles(state.scene(), i)) triangles.push_back(triangle);
  for (std::uint32_t bits = 1; bits <= ShadowCounter::kMostBits; ++bits) {
    const ViewOptions view{1, 4, bits};
    const Image image = preprocessed(state.scene(), view);
    const GrowScene grow{rays, nullptr, view.max_depth, bits};
    const PrimaryRays primaries(state.scene().camera, view);
    const TileRect rect = tile_rect(0, image.frame.width, image.frame.height);
    OracleCounts counts;
    for (std::uint32_t sample = 0; sample < sample_count(rect, view.samples); ++sample) {
      const StoredTree stored{PathCursor(image.paths.words(image.trees[0].paths[sample]), grow.layout()),
                              image.trees[0].hits_of(sample)};
      GrowCounters counters;
      TreeBlock block;
      expand_tree(grow, primaries.ray(rect, sample), sample, stored, block, counters);
      compare_links(state.scene(), block, triangles, bits, counts);
      if (HasFatalFailure()) return;
    }
    EXPECT_LT(counts.unclear, counts.compared / 10);
    EXPECT_GT(counts.blocked, counts.compared / 4);
    EXPECT_GT(counts.behind_glass, counts.compared / 20);
    EXPECT_EQ(counts.overflows > 0, bits < 3) << bits;
    EXPECT_GT(counts.entries.size(), 10U);
  }
}

/// Triangles of all living objects; and of the objects of some nodes.
std::vector<WorldTriangle> triangles_of(const Scene& scene) {
  std::vector<WorldTriangle> all;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    for (const WorldTriangle& triangle : world_triangles(scene, i)) all.push_back(triangle);
  return all;
}

/// Distinct opaque objects by interval between transparent surfaces; without counters all are one interval.
std::vector<std::set<std::uint32_t>> blockers_of(const Scene& scene, const std::vector<BruteCrossing>& crossings,
                                                 bool has_intervals) {
  std::vector<std::set<std::uint32_t>> intervals(1);
  for (const BruteCrossing& crossing : crossings) {
    if (scene.material(scene.objects[crossing.object].material).name != "Glass")
      intervals.back().insert(crossing.object);
    else if (has_intervals)
      intervals.emplace_back();
  }
  return intervals;
}

/// How many segments a step must trace that moves opaque objects alone: those where fewer of them stand in an interval
/// whose counter has overflowed. Where rounding may decide, a segment is unclear.
struct BruteShadowUpdates {
  std::uint64_t least = 0, unclear = 0;
};

BruteShadowUpdates shadow_updates_between(const Scene& before, const Scene& after, const std::set<std::uint32_t>& moved,
                                          const std::vector<ShadowSegment>& segments, std::uint32_t bits) {
  const std::vector<WorldTriangle> triangles_before = triangles_of(before), triangles_after = triangles_of(after);
  BruteShadowUpdates updates;
  std::vector<BruteCrossing> crossings;
  for (const ShadowSegment& segment : segments) {
    if (!cross_all(triangles_before, segment, crossings)) {
      ++updates.unclear;
      continue;
    }
    const auto then = blockers_of(before, crossings, bits > 0);
    if (!cross_all(triangles_after, segment, crossings)) {
      ++updates.unclear;
      continue;
    }
    const auto now = blockers_of(after, crossings, bits > 0);
    bool is_shot = false;
    for (std::size_t i = 0; i < then.size(); ++i) {
      const auto is_moved = [&](std::uint32_t object) { return moved.contains(object); };
      const auto gone = std::ranges::count_if(then[i], is_moved), come = std::ranges::count_if(now[i], is_moved);
      const bool is_fewer = bits > 0 ? gone > come : gone > 0 && come == 0;
      is_shot = is_shot || (then[i].size() > ShadowCounter::most(bits) && is_fewer);
    }
    updates.least += is_shot ? 1 : 0;
  }
  return updates;
}

/// Of all trees as they are stored.
std::vector<ShadowSegment> shadow_segments(const Replayer& replayer) {
  const Image& image = replayer.image();
  const Scene& scene = replayer.state().scene();
  const RayScene rays(scene);
  const GrowScene grow{rays, nullptr, image.view.max_depth, image.view.shadow_bits};
  const PrimaryRays primaries(scene.camera, image.view);
  const TileRect rect = tile_rect(0, image.frame.width, image.frame.height);
  std::vector<ShadowSegment> segments;
  for (std::uint32_t sample = 0; sample < sample_count(rect, image.view.samples); ++sample) {
    const StoredTree stored{PathCursor(image.paths.words(image.trees[0].paths[sample]), grow.layout()),
                            image.trees[0].hits_of(sample)};
    GrowCounters counters;
    TreeBlock block;
    expand_tree(grow, primaries.ray(rect, sample), sample, stored, block, counters);
    for (const RayNode& node : block.nodes)
      for (std::size_t light = 0; !node.object.is_none() && light < scene.light_order.size(); ++light)
        if (block.lights[node.first_light + light].state != ShadowState::facing_away)
          segments.push_back(shadow_segment(node, scene.light(scene.light_order[light])));
  }
  return segments;
}

void expect_full(const Replayer& replayer) {
  const ViewOptions& view = replayer.image().view;
  const SceneState again = compiled_again(replayer.state());
  EXPECT_EQ(
      different_trees(replayer.image(), replayer.state().scene(), preprocessed(again.scene(), view), again.scene()),
      0U);
  EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), view)).size(), 0U);
}

Replayer levels_replayer(bool with_glass, std::uint32_t bits) {
  const ViewOptions view{1, 4, bits};
  SceneState state = levels_scene(with_glass);
  Image image = preprocessed(state.scene(), view);
  return {std::move(state), std::move(image)};
}

/// Shadow updates of steps that move and hide slabs, each checked against a preprocess of its result.
std::uint64_t shadow_updates(bool with_glass, std::uint32_t bits) {
  Replayer replayer = levels_replayer(with_glass, bits);
  std::uint64_t updates = 0, pixels = 0;
  for (const auto& [node, edit] :
       {std::pair{"Slab21", replace_edit("/nodes/Slab21/translation", {0.6, 2.4, 0.2})},
        std::pair{"Slab31", replace_edit("/nodes/Slab31/extensions/KHR_node_visibility/visible", false)},
        std::pair{"Slab21", replace_edit("/nodes/Slab21/translation", {-0.6, 2.4, 0.5})},
        std::pair{"Slab31", replace_edit("/nodes/Slab31/extensions/KHR_node_visibility/visible", true)}}) {
    SCOPED_TRACE(std::string(node) + (with_glass ? " and glass, " : ", ") + std::to_string(bits) + " bits");
    const SceneState before = compiled_again(replayer.state());
    const std::vector<ShadowSegment> segments = shadow_segments(replayer);
    const StepResult step = replayer.step(edit, "counters", ".");
    const SceneState after = compiled_again(replayer.state());
    std::set<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < after.scene().objects.size(); ++i)
      if (after.scene().objects[i].node == node) moved.insert(i);
    const BruteShadowUpdates brute = shadow_updates_between(before.scene(), after.scene(), moved, segments, bits);
    EXPECT_EQ(step.counters.ray_updates, 0U);  // the slabs are not seen
    EXPECT_GE(step.counters.shadow_updates, brute.least);
    EXPECT_LE(step.counters.shadow_updates, brute.least + brute.unclear);
    EXPECT_LT(brute.unclear, segments.size() / 8);
    pixels += step.changed_pixels.size();
    updates += step.counters.shadow_updates;
    expect_full(replayer);
  }
  EXPECT_GT(pixels, 0U);
  return updates;
}

TEST(ShadowCounter, moved_opaque_blockers_are_counted_without_shooting) {
  for (const bool with_glass : {false, true}) {
    EXPECT_GT(shadow_updates(with_glass, 0), 0U);
    EXPECT_EQ(shadow_updates(with_glass, 4), 0U);
    EXPECT_EQ(shadow_updates(with_glass, 3), 0U);
    EXPECT_GT(shadow_updates(with_glass, 1), 0U);  // two slabs overflow it
  }
}

TEST(ShadowCounter, moved_glass_is_shot_again_only_among_blockers) {
  for (const std::uint32_t bits : {0U, 1U, 3U}) {
    Replayer replayer = levels_replayer(true, bits);
    std::uint64_t among_blockers = 0, updates = 0;
    for (const Edit& edit : {replace_edit("/nodes/HighPane/translation", {0.2, 2.77, -0.4}),
                             replace_edit("/nodes/Ball/translation", {0.7, 2.2, 0.5}),
                             replace_edit("/nodes/Ball/extensions/KHR_node_visibility/visible", false)}) {
      std::vector<BruteCrossing> crossings;
      const std::vector<WorldTriangle> triangles = triangles_of(replayer.state().scene());
      for (const ShadowSegment& segment : shadow_segments(replayer))
        among_blockers += !cross_all(triangles, segment, crossings) ||
                                  !blockers_of(replayer.state().scene(), crossings, false)[0].empty()
                              ? 1
                              : 0;
      updates += replayer.step(edit, "counters", ".").counters.shadow_updates;
      expect_full(replayer);
    }
    EXPECT_LE(updates, bits == 0 ? 0 : among_blockers / 2) << bits;
  }
}

/// Where a light stays blocked, another number of blockers is no other colour.
TEST(ShadowCounter, another_number_of_blockers_evaluates_no_colour) {
  std::vector<std::uint64_t> affected[2];
  std::size_t pixels = 0;
  for (const std::uint32_t bits : {0U, 3U}) {
    Replayer replayer = levels_replayer(false, bits);
    for (const char* slab : {"Slab01", "Slab12", "Slab21", "Slab31"}) {
      const std::string visible = std::string("/nodes/") + slab + "/extensions/KHR_node_visibility/visible";
      const StepResult step = replayer.step(replace_edit(visible, false), "counters", ".");
      pixels += step.changed_pixels.size();
      affected[bits / 3].push_back(step.counters.samples_affected);
      expect_full(replayer);
    }
  }
  EXPECT_GT(pixels, 0U);
  EXPECT_EQ(affected[1], affected[0]);
}

}  // namespace
}  // namespace relook
