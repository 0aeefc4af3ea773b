// count_pieces() of cache.h: how many paths, groups, ray trees and tunnels a cache has (Table 2 of the paper).
#include "base/parallel.h"
#include "cache/cache.h"
#include "region/path_groups.h"

namespace relook {
namespace {

std::uint64_t tunnels_of(const TileTunnels& tunnels) {
  const bool has_one_alone = !tunnels.empty() && tunnels.grid().regions() == 0;
  return tunnels.tunnels() + (has_one_alone ? 1 : 0);
}

std::uint64_t groups_of(const Image& image, std::size_t tile) {
  const std::uint32_t width = tile_rect(tile, image.frame.width, image.frame.height).width();
  const ClassOf own_class = [](PathId path) { return path; };
  const PathGroups groups(image.trees[tile], width, image.view.samples, 1, own_class);
  return count_groups(groups, image.trees[tile], width, image.view.samples, own_class);
}

}  // namespace

PieceNumbers count_pieces(const CacheContent& content) {
  const Image& image = content.image;
  PieceNumbers pieces;
  pieces.ray_paths = image.paths.size();
  std::vector<std::uint64_t> groups(image.trees.size());
  parallel_for(groups.size(), [&](std::size_t tile) { groups[tile] = groups_of(image, tile); });
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    pieces.groups += groups[tile];
    if (has_hits(image.trees[tile])) pieces.ray_trees += image.trees[tile].paths.size();
  }
  for (const TileTunnels& tunnels : content.tunnels) pieces.tunnels += tunnels_of(tunnels);
  if (!content.tunnels.empty()) pieces.tunnels += regions_above_tiles(content.camera.width, content.camera.height);
  return pieces;
}

}  // namespace relook
