// Ray trees read back from their stored form, by the rules written in trace/tree/ray_path.h and trace/tree/ray_tree.h
// alone: the tests' own eyes on paths and hits.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "frame/image.h"
#include "scene/scene.h"

namespace relook {

struct TreeCrossing {
  std::uint32_t object = 0;
  Hit hit;
};

struct TreeLight {
  ShadowState state = ShadowState::facing_away;
  std::vector<TreeCrossing> filters;
  std::vector<std::uint32_t> transparent, counters;  // of a blocked light, where shadows are counted
};

struct TreeChild;

struct TreeNode {
  bool missed = false;
  std::uint32_t object = 0, flags = 0;
  Hit hit;
  std::vector<TreeLight> lights;    // in light order
  std::vector<TreeChild> children;  // in the order of Branch
};

struct TreeChild {
  Branch branch = Branch::reflection;
  TreeNode node;
};

/// The tree of one sample. `lights`: living lights of the scene.
[[nodiscard]] TreeNode read_tree(const Image& image, std::size_t tile, std::size_t sample, std::size_t lights);

struct TreeSize {
  std::uint64_t rays = 0;     // nodes, misses and the primary ray included
  std::uint64_t shadows = 0;  // segments to lights that the surface faces
  TreeSize& operator+=(const TreeSize& other);
};
[[nodiscard]] TreeSize size_of(const TreeNode& node);
/// Rays and shadow segments of all trees.
[[nodiscard]] TreeSize size_of(const Image& image, std::size_t lights);

/// Same objects (by key), branches, shadow states, counters and hits, bit for bit.
[[nodiscard]] bool same_tree(const TreeNode& a, const Scene& scene_a, const TreeNode& b, const Scene& scene_b);
/// Number of samples whose trees differ; both images have the same size and view.
[[nodiscard]] std::size_t different_trees(const Image& a, const Scene& scene_a, const Image& b, const Scene& scene_b);

}  // namespace relook
