#include "image/tree_encloser.h"

#include <algorithm>
#include <utility>

namespace relook {

TreeEncloser::TreeEncloser(const Image& image, const GrowScene& grow, std::size_t tile, std::size_t most,
                           const ClassOf& class_of, Residency::Lease trees_lease)
    : lease_(std::move(trees_lease)),
      image_(image),
      grow_(grow),
      trees_(image.trees[tile]),
      rect_(tile_rect(tile, image.frame.width, image.frame.height)),
      primaries_(grow.scene.camera(), image.view),
      class_of_(class_of),
      set_(most) {}

std::span<const Tunnel> TreeEncloser::of(const RegionSquare& square) {
  set_.clear();
  const std::uint32_t width = rect_.width(), samples = image_.view.samples;
  for (std::uint32_t y = square.y; y < std::min(square.y + square.size, rect_.height()); ++y)
    for (std::uint32_t x = square.x; x < std::min(square.x + square.size, width); ++x)
      for (std::uint32_t k = 0; k < samples; ++k) add((y * width + x) * samples + k);
  return set_.tunnels();
}

Sections TreeEncloser::around() {
  Sections all;
  for (const Tunnel& tunnel : of({0, 0, kTileSize})) enclose(all, tunnel.sections);
  return all;
}

void TreeEncloser::add(std::uint32_t sample) {
  const PathId path = trees_.paths[sample];
  block_.clear();
  const StoredTree stored{PathCursor(image_.paths.words(path), grow_.layout()), trees_.kept_hits_of(sample)};
  const std::uint32_t root = expand_tree(grow_, primaries_.ray(rect_, sample), sample, stored, block_, counters_);
  enclose(set_.of(class_of_(path)), grow_.scene, block_, root, histories_);
}

}  // namespace relook
