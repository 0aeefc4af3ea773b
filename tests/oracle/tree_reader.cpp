#include "tree_reader.h"

namespace relook {
namespace {

struct Reader {
  std::span<const std::uint32_t> words;
  std::span<const Hit> hits;
  std::size_t lights;
  std::uint32_t shadow_bits;
  std::size_t word = 0, hit = 0;

  TreeNode node() {
    TreeNode node;
    node.object = words[word++];
    if (node.object == 0xFFFFFFFFU) {
      node.missed = true;
      return node;
    }
    node.flags = words[word++];
    node.hit = hits[hit++];
    for (std::size_t i = 0; i < lights; ++i)
      node.lights.push_back({static_cast<ShadowState>((words[word + i / 16] >> (2 * (i % 16))) & 3U), {}, {}, {}});
    word += (lights + 15) / 16;
    for (TreeLight& light : node.lights) {
      if (light.state == ShadowState::blocked && shadow_bits > 0) {
        const std::uint32_t count = words[word++];
        for (std::uint32_t i = 0; i < count; ++i) light.transparent.push_back(words[word++]);
        for (std::uint32_t i = 0; i < count + 1; ++i) light.counters.push_back(words[word++]);
      }
      if (light.state != ShadowState::filtered) continue;
      for (std::uint32_t count = words[word++]; count > 0; --count)
        light.filters.push_back({words[word++], hits[hit++]});
    }
    for (std::uint32_t branch = 0; branch < kBranches; ++branch)
      if ((node.flags >> (branch < 4 ? branch : branch < 7 ? branch + 1 : 16) & 1U) != 0)
        node.children.push_back({static_cast<Branch>(branch), this->node()});
    return node;
  }
};

}  // namespace

TreeNode read_tree(const Image& image, std::size_t tile, std::size_t sample, std::size_t lights) {
  const TileTrees& trees = image.trees[tile];
  Reader reader{image.paths.words(trees.paths[sample]), trees.hits_of(sample), lights, image.view.shadow_bits};
  return reader.node();
}

TreeSize& TreeSize::operator+=(const TreeSize& other) {
  rays += other.rays;
  shadows += other.shadows;
  return *this;
}

TreeSize size_of(const TreeNode& node) {
  TreeSize size{1, 0};
  for (const TreeLight& light : node.lights) size.shadows += light.state != ShadowState::facing_away ? 1 : 0;
  for (const auto& [branch, child] : node.children) size += size_of(child);
  return size;
}

TreeSize size_of(const Image& image, std::size_t lights) {
  TreeSize size;
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile)
    for (std::size_t sample = 0; sample < image.trees[tile].paths.size(); ++sample)
      size += size_of(read_tree(image, tile, sample, lights));
  return size;
}

bool same_tree(const TreeNode& a, const Scene& scene_a, const TreeNode& b, const Scene& scene_b) {
  if (a.missed || b.missed) return a.missed == b.missed;
  const auto same_object = [&](std::uint32_t i, std::uint32_t j) {
    return scene_a.objects[i].key == scene_b.objects[j].key;
  };
  if (!same_object(a.object, b.object) || a.flags != b.flags || a.hit != b.hit) return false;
  if (a.lights.size() != b.lights.size() || a.children.size() != b.children.size()) return false;
  for (std::size_t i = 0; i < a.lights.size(); ++i) {
    const TreeLight &light_a = a.lights[i], &light_b = b.lights[i];
    if (light_a.state != light_b.state || light_a.filters.size() != light_b.filters.size()) return false;
    if (light_a.counters != light_b.counters || light_a.transparent.size() != light_b.transparent.size()) return false;
    for (std::size_t k = 0; k < light_a.transparent.size(); ++k)
      if (!same_object(light_a.transparent[k], light_b.transparent[k])) return false;
    for (std::size_t k = 0; k < light_a.filters.size(); ++k)
      if (!same_object(light_a.filters[k].object, light_b.filters[k].object) ||
          light_a.filters[k].hit != light_b.filters[k].hit)
        return false;
  }
  for (std::size_t i = 0; i < a.children.size(); ++i)
    if (!same_tree(a.children[i].node, scene_a, b.children[i].node, scene_b)) return false;
  return true;
}

std::size_t different_trees(const Image& a, const Scene& scene_a, const Image& b, const Scene& scene_b) {
  std::size_t different = 0;
  for (std::size_t tile = 0; tile < a.trees.size(); ++tile)
    for (std::size_t sample = 0; sample < a.trees[tile].paths.size(); ++sample)
      if (!same_tree(read_tree(a, tile, sample, scene_a.light_order.size()), scene_a,
                     read_tree(b, tile, sample, scene_b.light_order.size()), scene_b))
        ++different;
  return different;
}

}  // namespace relook
