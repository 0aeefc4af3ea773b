#include "engine/regions.h"

#include <chrono>

#include "base/memory.h"
#include "base/parallel.h"
#include "engine/sampling.h"

namespace relook {
namespace {

/// Encloses the ray trees of a tile's leaves, expanded from their stored form.
class LeafTunnels {
 public:
  LeafTunnels(const Image& image, const GrowScene& grow, std::size_t tile, std::size_t most, const ClassOf& class_of,
              Residency::Lease trees_lease)
      : lease_(std::move(trees_lease)),
        image_(image),
        grow_(grow),
        trees_(image.trees[tile]),
        rect_(tile_rect(tile, image.frame.width, image.frame.height)),
        primaries_(grow.scene.scene().camera, image.view),
        class_of_(class_of),
        set_(most) {}

  std::span<const Tunnel> of(std::uint32_t leaf) {
    set_.clear();
    const RegionSquare square = square_of(leaf);
    const std::uint32_t width = rect_.x1 - rect_.x0, samples = image_.view.samples;
    for (std::uint32_t y = square.y; y < std::min(square.y + square.size, rect_.y1 - rect_.y0); ++y)
      for (std::uint32_t x = square.x; x < std::min(square.x + square.size, width); ++x)
        for (std::uint32_t k = 0; k < samples; ++k) add((y * width + x) * samples + k);
    return set_.tunnels();
  }

 private:
  void add(std::uint32_t sample) {
    const PathId path = trees_.paths[sample];
    block_.clear();
    const StoredTree stored{PathCursor(image_.paths.words(path), grow_.layout()), trees_.kept_hits_of(sample)};
    const std::uint32_t root = expand_tree(grow_, primaries_.ray(rect_, sample), sample, stored, block_, counters_);
    enclose(set_.of(class_of_(path)), grow_.scene, block_, root, histories_);
  }

  Residency::Lease lease_;
  const Image& image_;
  const GrowScene& grow_;
  const TileTrees& trees_;
  TileRect rect_;
  PrimaryRays primaries_;
  const ClassOf& class_of_;
  GrowCounters counters_;
  TunnelSet set_;
  TreeBlock block_;
  std::vector<History> histories_;
};

Leaves all_leaves() { return Leaves().set(); }

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

PathGroups ImageRegions::groups_of(const Image& image, std::size_t tile, const ClassOf& class_of) const {
  const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
  return {image.trees[tile], rect.x1 - rect.x0, image.view.samples, options_.groups, class_of};
}

void ImageRegions::build_groups(const Image& image, const ClassOf& class_of) {
  if (options_.groups == 0) return;
  groups_.resize(image.trees.size());
  parallel_for(groups_.size(), [&](std::size_t tile) { groups_[tile] = groups_of(image, tile, class_of); });
}

void ImageRegions::build_tunnels(const Image& image, const GrowScene& grow, const ClassOf& class_of) {
  if (options_.tunnels == 0) return;
  add_pieces(image.trees.size());
  parallel_for(tunnels_.size(), [&](std::size_t tile) {
    const auto start = Clock::now();
    LeafTunnels leaves(image, grow, tile, options_.tunnels, class_of, lease(PieceKind::ray_trees, tile));
    TileTunnels built =
        TileTunnels().rebuilt(all_leaves(), options_.tunnels, [&](std::uint32_t leaf) { return leaves.of(leaf); });
    const double seconds = seconds_since(start);
    keep(tile, std::move(built), seconds);
  });
  const auto columns = std::size_t{image.frame.width + kTileSize - 1} / kTileSize;
  image_tunnels_ = TunnelPyramid(columns, tunnels_.size() / columns,
                                 [this](std::size_t tile, Sections& tunnel) { enclose_tile(tile, tunnel); });
}

void ImageRegions::add_pieces(std::size_t tiles) {
  tunnels_.assign(tiles, {});
  tile_sections_.assign(tiles, {});
  if (residency_ == nullptr) return;
  PieceHandler handler;
  handler.pack = [this](std::size_t tile) { return tunnels_[tile].packed(); };
  handler.unpack = [this](std::size_t tile, BytesView bytes) { tunnels_[tile] = TileTunnels::unpacked(bytes); };
  handler.drop = [this](std::size_t tile) { tunnels_[tile] = {}; };
  handler.may_be_missing = true;
  residency_->add_kind(PieceKind::tunnels, tiles, std::move(handler));
}

void ImageRegions::keep(std::size_t tile, TileTunnels tunnels, std::optional<double> seconds) {
  give_back(tile_sections_[tile]);
  for (std::size_t k = 0; k < tunnels.count(kRoot); ++k)
    enclose(tile_sections_[tile], tunnels.tunnel(kRoot, k).sections);
  tunnels_[tile] = std::move(tunnels);
  if (residency_ != nullptr) residency_->set(PieceKind::tunnels, tile, tunnels_[tile].bytes(), seconds);
}

void ImageRegions::enclose_tile(std::size_t tile, Sections& tunnel) const { enclose(tunnel, tile_sections_[tile]); }

void ImageRegions::update_image(const std::vector<std::size_t>& tiles) {
  if (!has_tunnels()) return;
  image_tunnels_.update(tiles, [this](std::size_t tile, Sections& tunnel) { enclose_tile(tile, tunnel); });
}

void ImageRegions::update(const Image& image, const GrowScene& grow, std::size_t tile, const Leaves& changed,
                          const ClassOf& class_of) {
  if (has_groups()) groups_[tile] = groups_of(image, tile, class_of);
  if (!has_tunnels()) return;
  const Residency::Lease tunnels_lease = lease(PieceKind::tunnels, tile);
  const auto start = Clock::now();
  LeafTunnels leaves(image, grow, tile, options_.tunnels, class_of, lease(PieceKind::ray_trees, tile));
  const bool is_new = tunnels_[tile].empty();
  TileTunnels rebuilt = tunnels_[tile].rebuilt(is_new ? all_leaves() : changed, options_.tunnels,
                                               [&](std::uint32_t leaf) { return leaves.of(leaf); });
  const double seconds = seconds_since(start);
  keep(tile, std::move(rebuilt), is_new ? std::optional(seconds) : std::nullopt);
}

std::size_t ImageRegions::group_bytes() const {
  std::size_t sum = 0;
  for (const PathGroups& groups : groups_) sum += groups.bytes();
  return sum;
}

std::size_t ImageRegions::tunnel_bytes() const {
  std::size_t sum = image_tunnels_.bytes();
  for (const TileTunnels& tunnels : tunnels_) sum += tunnels.bytes();
  return sum;
}

}  // namespace relook
