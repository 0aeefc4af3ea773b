// Stored ray trees by pixel, for counts by brute force over all of them, and a room in which every ray has an end.
#pragma once
#include <vector>

#include "replay/replay.h"
#include "test_scenes.h"
#include "tree_reader.h"

namespace relook {

/// The spheres inside a large ball that has an inside, so that every ray ends on a surface and its segment is known.
[[nodiscard]] inline SceneState closed_room() {
  SceneState state = spheres_scene(80, 60);
  Json edit = Json::array();
  edit.push_back({{"op", "add"}, {"path", "/nodes/Room"}, {"value", {{"mesh", "Ball"}, {"scale", {20, 20, 20}}}}});
  for (const auto& material : state.document().look.at("materials").items())
    edit.push_back(
        {{"op", "replace"}, {"path", "/materials/" + escape_token(material.key()) + "/doubleSided"}, {"value", true}});
  apply_edit(state, parsed_edit(edit.dump().c_str()), "room", ".");
  return state;
}

[[nodiscard]] inline Replayer replayer_of(SceneState state, const ViewOptions& view, const RegionOptions& options) {
  Image image = preprocessed(state.scene(), view);
  return Replayer(std::move(state), std::move(image), options);
}

/// Calls visit(pixel, tree) for the only sample of every pixel.
template <class Visit>
void for_each_tree(const Image& image, std::size_t lights, Visit visit) {
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    for (std::uint32_t i = 0; i < rect.pixels(); ++i) {
      const std::uint32_t x = rect.x0 + i % (rect.x1 - rect.x0), y = rect.y0 + i / (rect.x1 - rect.x0);
      visit(y * image.frame.width + x, read_tree(image, tile, i, lights));
    }
  }
}

[[nodiscard]] inline std::vector<TreeNode> trees_by_pixel(const Replayer& replayer) {
  const Image& image = replayer.image();
  std::vector<TreeNode> trees(image.frame.pixels.size());
  for_each_tree(image, replayer.state().scene().light_order.size(),
                [&](std::uint32_t pixel, TreeNode tree) { trees[pixel] = std::move(tree); });
  return trees;
}

}  // namespace relook
