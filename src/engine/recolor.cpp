#include "engine/recolor.h"

#include <algorithm>
#include <chrono>

#include "engine/sampling.h"

namespace relook {
namespace {

/// Trees are compressed in blocks of about this many: long runs for evaluation, few enough to stay in the cache.
constexpr std::size_t kBlockSamples = 4096;

class TileCompressor {
 public:
  TileCompressor(const UpdatePass& pass, std::size_t tile, CompressedImage& image, Shader& shader)
      : p_(pass),
        trees_(pass.image.trees[tile]),
        rect_(tile_rect(tile, pass.image.frame.width, pass.image.frame.height)),
        primaries_(pass.grow.scene.scene().camera, pass.image.view),
        image_(image),
        shader_(shader) {}

  CompressedTile compress(const Leaves& leaves) {
    const auto start = std::chrono::steady_clock::now();
    for_each_sample(rect_, p_.image.view, leaves, [&](std::uint32_t sample, std::uint32_t) {
      const PathId path = trees_.paths[sample];
      if ((p_.tasks.of_path[path.index()] & kShade) == 0) return;
      const StoredTree stored{PathCursor(p_.image.paths.words(path), {p_.lights.size(), p_.grow.shadow_bits}),
                              trees_.hits_of(sample).data()};
      roots_.push_back(expand_tree(p_.grow, primaries_.ray(rect_, sample), sample, stored, block_));
      if (roots_.size() == kBlockSamples) flush();
    });
    flush();
    for (const std::uint32_t sample : tile_.samples)
      tile_.leaves.set(leaf_of(sample / p_.image.view.samples, rect_.x1 - rect_.x0));
    tile_.is_valid = true;
    tile_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(tile_);
  }

 private:
  void flush() {
    if (roots_.empty()) return;
    CompressedBlock block = shader_.compress(block_, roots_, image_.parameters, image_.splits);
    for (const std::uint32_t root : block.roots) tile_.samples.push_back(block_.nodes[roots_[root]].sample);
    tile_.bytes += block.bytes();
    if (!block.roots.empty()) tile_.blocks.push_back(std::move(block));
    block_.clear();
    roots_.clear();
  }

  const UpdatePass& p_;
  const TileTrees& trees_;
  TileRect rect_;
  PrimaryRays primaries_;
  CompressedImage& image_;
  Shader& shader_;
  TreeBlock block_;
  std::vector<std::uint32_t> roots_;
  CompressedTile tile_;
};

}  // namespace

bool is_compressible(const ColorChange& change) {
  return change.reassigned.empty() && std::ranges::none_of(change.parameters.materials, [](const auto& material) {
           return (material.second & kMappingMask) != 0;
         });
}

CompressedTile compress_tile(const UpdatePass& pass, std::size_t tile, const TileWork& work, CompressedImage& image,
                             Shader& shader) {
  return TileCompressor(pass, tile, image, shader).compress(work.leaves);
}

TileMask recolor_tile(const CompressedTile& compressed, std::size_t tile, const Scene& scene, StoredImage& stored,
                      ColorMemory& memory) {
  std::span<const std::uint32_t> samples(compressed.samples);
  for (const CompressedBlock& block : compressed.blocks) {
    stored.keep_colors(tile, samples.first(block.roots.size()), block.evaluate(scene, memory));
    samples = samples.subspan(block.roots.size());
  }
  TileMask changed{};
  stored.refresh_pixels(tile, compressed.samples, nullptr, changed);
  return changed;
}

}  // namespace relook
