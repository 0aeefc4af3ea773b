// What a report calls resident, evicted and rebuilt, against what is there and what must have been worked out again.
#include <gtest/gtest.h>

#include "stored_trees.h"

namespace relook {
namespace {

constexpr const char* kMatte = "/materials/Matte/pbrMetallicRoughness/baseColorFactor";

Json color(double red) { return {red, 0.3, 0.2, 1}; }

std::uint64_t bytes_of_colors(const Image& image) {
  std::uint64_t sum = 0;
  for (const auto& colors : image.sample_colors) sum += colors.capacity() * sizeof(Rgba);
  return sum;
}

TEST(Resident, names_each_kind_of_bytes_apart) {
  Replayer replayer = replayer_of(spheres_scene(150, 110), {1, 6}, {});
  const Resident first = replayer.resident();
  EXPECT_EQ(first.sample_colors, bytes_of_colors(replayer.image()));
  EXPECT_EQ(first.groups, replayer.regions().group_bytes());
  EXPECT_GT(first.groups, 0U);
  EXPECT_EQ(first.color_trees, 0U) << "none have been compressed";
  EXPECT_EQ(first.tunnels, 0U) << "no step has needed any";
  replayer.step(replace_edit(kMatte, color(0.9)), "c", ".");
  const Resident second = replayer.resident();
  EXPECT_GT(second.color_trees, 0U);
  EXPECT_EQ(second.total, first.total + second.color_trees);
  replayer.step(replace_edit("/nodes/Ball/translation", {0.1, 0.9, 0.1}), "g", ".");
  const Resident last = replayer.resident();
  EXPECT_EQ(last.sample_colors, first.sample_colors);
  EXPECT_EQ(last.tunnels, replayer.regions().tunnel_bytes());
  EXPECT_GT(last.tunnels, 0U);
  const std::uint64_t frame = replayer.image().frame.pixels.size() * sizeof(Rgba);
  EXPECT_EQ(last.total, last.ray_paths + last.ray_trees + last.sample_colors + last.light_sums + last.color_trees +
                            last.groups + last.tunnels + frame);
}

TEST(Rebuilt, color_trees_are_those_that_had_left) {
  RegionOptions options;
  options.color_trees = 0.3;
  Replayer replayer = replayer_of(spheres_scene(150, 110), {1, 5}, options);
  std::uint64_t left = 0, left_bytes = 0;
  for (int k = 0; k < 3; ++k) {
    const Counters step = replayer.step(replace_edit("/lights/Lamp/intensity", 21 + k), "l", ".").counters;
    EXPECT_EQ(step.rebuilt.color_trees, left) << "step " << k;
    EXPECT_EQ(step.rebuilt.bytes, left_bytes) << "step " << k;
    left = step.evicted.color_trees;
    left_bytes = step.evicted.bytes;
    EXPECT_GT(left, 0U);
  }
}

TEST(Rebuilt, color_trees_are_those_of_tiles_with_other_ray_trees) {
  Replayer replayer = replayer_of(spheres_scene(150, 110), {1, 6}, {});
  const Counters first = replayer.step(replace_edit(kMatte, color(0.9)), "c", ".").counters;
  EXPECT_EQ(first.rebuilt.color_trees, 0U) << "built, but not again";
  EXPECT_EQ(replayer.step(replace_edit(kMatte, color(0.8)), "c", ".").counters.rebuilt.color_trees, 0U);
  const Image before = replayer.image();
  const Edit move = replace_edit("/nodes/MirrorBall/translation", {-1.4, 0.9, 0.1});
  const Counters moved = replayer.step(move, "g", ".").counters;
  EXPECT_EQ(moved.rebuilt.color_trees, 0U);
  const Counters again = replayer.step(replace_edit(kMatte, color(0.7)), "c", ".").counters;
  // A new replay of the moved scene compresses all of them: those of tiles whose trees are the same were still there.
  std::uint64_t changed_tiles = 0, dependent = 0;
  const Scene& scene = replayer.state().scene();
  const MaterialId matte = [&] {
    for (const Object& object : scene.objects)
      if (object.node == "Ball") return object.material;
    return MaterialId::none();
  }();
  const auto names = [&](const TreeNode& node, const auto& self) -> bool {
    if (node.missed) return false;
    if (scene.objects[node.object].material == matte) return true;
    return std::ranges::any_of(node.children, [&](const auto& child) { return self(child.node, self); });
  };
  for (std::size_t tile = 0; tile < before.trees.size(); ++tile) {
    bool is_changed = false;
    std::uint64_t samples = 0;
    for (std::size_t sample = 0; sample < before.trees[tile].paths.size(); ++sample) {
      const TreeNode now = read_tree(replayer.image(), tile, sample, 1);
      is_changed = is_changed || !same_tree(read_tree(before, tile, sample, 1), scene, now, scene);
      samples += names(now, names) ? 1 : 0;
    }
    changed_tiles += is_changed ? 1 : 0;
    if (is_changed) dependent += samples;
  }
  EXPECT_GT(changed_tiles, 0U);
  EXPECT_LT(changed_tiles, before.trees.size()) << "or nothing is kept";
  EXPECT_EQ(again.rebuilt.color_trees, dependent);
}

TEST(Rebuilt, tunnels_are_those_of_tiles_that_missed_theirs) {
  const auto missing = [](const Replayer& replayer) {
    std::vector<bool> tiles;
    for (std::size_t tile = 0; tile < replayer.image().trees.size(); ++tile)
      tiles.push_back(replayer.regions().tunnels(tile).empty());
    return tiles;
  };
  std::uint64_t limit_bytes = 0;
  for (const bool is_limited : {false, true}) {
    SceneState state = spheres_scene(480, 360);
    Image image = preprocessed(state.scene(), {1, 5});
    ResidencyOptions limit;
    limit.process_bytes = nullptr;
    if (is_limited) limit.memory_bytes = limit_bytes;
    Replayer replayer(std::move(state), std::move(image), {}, std::make_unique<Residency>(limit));
    const auto move = [&](double x) {
      return replayer.step(replace_edit("/nodes/Ball/translation", {x, 0.9, 0.1}), "g", ".").counters;
    };
    const Counters first = move(0.1);
    EXPECT_LE(first.rebuilt.tunnels, first.evicted.tunnels) << "built for the first time is not again";
    std::uint64_t most = 0;
    for (const double x : {0.2, 0.3}) {
      const std::vector<bool> before = missing(replayer);
      const Image image_before = replayer.image();
      const Counters step = move(x);
      std::uint64_t missed = 0, needed = 0;
      for (std::size_t tile = 0; tile < before.size(); ++tile) {
        missed += before[tile] ? 1 : 0;
        needed += before[tile] && image_before.trees[tile].paths != replayer.image().trees[tile].paths ? 1 : 0;
      }
      EXPECT_GE(step.rebuilt.tunnels, needed);
      EXPECT_LE(step.rebuilt.tunnels, missed + step.evicted.tunnels);
      EXPECT_GE(step.rebuilt.bytes, step.rebuilt.tunnels * sizeof(TunnelSection));
      most = std::max(most, step.rebuilt.tunnels);
    }
    EXPECT_EQ(most > 0, is_limited);
    const Resident all = replayer.resident();
    if (!is_limited) limit_bytes = all.sample_colors + all.tunnels / 2;
  }
}

}  // namespace
}  // namespace relook
