#include "image/regions.h"

#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "base/system/memory.h"
#include "image/sampling.h"
#include "image/tree_encloser.h"
#include "region/cell_tunnels.h"

namespace relook {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

PathGroups ImageRegions::groups_of(const Image& image, std::size_t tile, const ClassOf& class_of) const {
  const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
  return {image.trees[tile], rect.width(), image.view.samples, options_.groups, class_of};
}

void ImageRegions::build_groups(const Image& image, const ClassOf& class_of) {
  if (options_.groups == 0) return;
  groups_.resize(image.trees.size());
  parallel_for(groups_.size(), [&](std::size_t tile) { groups_[tile] = groups_of(image, tile, class_of); });
  image_groups_ = GroupPyramid(groups_, tiles_along(image.frame.width), options_.groups);
}

void ImageRegions::offer(std::shared_ptr<StoredTunnels> stored, std::size_t tiles) {
  stored_ = std::move(stored);
  stale_.assign(stored_ ? tiles : 0, {});
}

void ImageRegions::forget_stored() {
  if (has_tunnels()) return;  // what is used of them is kept up to date
  offer(nullptr, 0);
}

bool ImageRegions::may_have_tunnels(const Image& image) const {
  return !relook::cell_levels(options_.shape(), image.frame.width, image.frame.height).empty();
}

std::vector<std::size_t> ImageRegions::build_tunnels(const Image& image, const GrowScene& grow,
                                                     const ClassOf& class_of) {
  cell_levels_ = cell_levels(options_.shape(), image.frame.width, image.frame.height);
  if (cell_levels_.empty()) return {};
  if (has_tunnels()) offer(nullptr, 0);  // these have been used up
  add_pieces(image.trees.size());
  lights_ = light_ends(grow.scene);
  mean_area_ = 0;
  std::vector<std::uint8_t> is_lost(tunnels_.size(), 0);
  parallel_for(tunnels_.size(), [&](std::size_t tile) {
    if (take_stored(tile)) return;
    is_lost[tile] = stored_ && !stale_[tile].all() ? 1 : 0;
    build(image, grow, tile, class_of);
    if (stored_) stale_[tile].reset();
  });
  measure_areas();
  parallel_for(stale_.size(), [&](std::size_t tile) {
    if (stale_[tile].any() && update(image, grow, tile, stale_[tile], class_of)) is_lost[tile] = 1;
  });
  stale_.clear();
  const auto columns = std::size_t{tiles_along(image.frame.width)};
  image_tunnels_ = TunnelPyramid(columns, tunnels_.size() / columns,
                                 [this](std::size_t tile, Sections& tunnel) { enclose_tile(tile, tunnel); });
  std::vector<std::size_t> lost;
  for (std::size_t tile = 0; tile < is_lost.size(); ++tile)
    if (is_lost[tile] != 0) lost.push_back(tile);
  return lost;
}

bool ImageRegions::take_stored(std::size_t tile) {
  if (!stored_ || residency_ == nullptr || stale_[tile].all()) return false;
  std::optional<Sections> around = stored_->around(tile);
  if (!around) return false;
  around_[tile] = std::move(*around);
  const std::optional<std::uint64_t> bytes = stored_->bytes(tile);
  if (!bytes) return true;  // left out
  was_there_[tile] = 1;
  // About one section a hit, in leaves and above.
  const double seconds = kTunnelSeconds * static_cast<double>(*bytes) / sizeof(TunnelSection);
  residency_->set_stored(PieceKind::tunnels, tile, *bytes, seconds, 1);
  return true;
}

void ImageRegions::add_pieces(std::size_t tiles) {
  tunnels_.assign(tiles, {});
  around_.assign(tiles, {});
  was_there_.resize(tiles, 0);
  if (residency_ == nullptr) return;
  PieceHandler handler;
  handler.pack = [this](std::size_t tile) { return tunnels_[tile].packed(); };
  handler.unpack = [this](std::size_t tile, BytesView bytes) { tunnels_[tile] = TileTunnels::unpacked(bytes); };
  handler.drop = [this](std::size_t tile) { tunnels_[tile] = {}; };
  handler.fetch = [this](std::size_t tile) -> std::optional<std::uint64_t> {
    std::optional<TileTunnels> read = stored_->read(tile);
    if (!read) return std::nullopt;
    tunnels_[tile] = std::move(*read);
    return tunnels_[tile].bytes();
  };
  handler.may_be_missing = true;
  residency_->add_kind(PieceKind::tunnels, tiles, std::move(handler));
}

void ImageRegions::build(const Image& image, const GrowScene& grow, std::size_t tile, const ClassOf& class_of) {
  const auto start = Clock::now();
  const TileGrid grid(cell_levels_[tile]);
  TreeEncloser trees(image, grow, tile, options_.tunnels, class_of, lease(PieceKind::ray_trees, tile));
  TileTunnels built =
      TileTunnels::built(grid, options_.tunnels, [&](std::uint32_t cell) { return trees.of(grid.square_of(cell)); });
  Sections around = grid.regions() > 0 ? relook::around(built) : trees.around();
  const double seconds = seconds_since(start);
  keep(tile, std::move(built), std::move(around), seconds);
}

void ImageRegions::keep(std::size_t tile, TileTunnels tunnels, Sections around, std::optional<double> seconds) {
  around_[tile] = std::move(around);
  tunnels_[tile] = std::move(tunnels);
  was_there_[tile] = 1;
  if (residency_ == nullptr || !residency_->is_watched()) return;
  // While tunnels are first built there is no mean yet: measure_areas() follows.
  const double area = mean_area_ > 0 ? surface_area(around_[tile], lights_) : 1;
  residency_->set(PieceKind::tunnels, tile, tunnels_[tile].bytes(), seconds, relative_to_mean(area));
}

void ImageRegions::measure_areas() {
  if (residency_ == nullptr || !residency_->is_watched()) return;
  std::vector<double> areas;
  double sum = 0;
  for (const Sections& tunnel : around_) sum += areas.emplace_back(surface_area(tunnel, lights_));
  mean_area_ = sum / static_cast<double>(around_.size());
  for (std::size_t tile = 0; tile < around_.size(); ++tile)
    residency_->set_surface_area(PieceKind::tunnels, tile, relative_to_mean(areas[tile]));
}

double ImageRegions::relative_to_mean(double area) const {
  const double relative = mean_area_ > 0 ? area / mean_area_ : 1;
  return std::isfinite(relative) ? relative : 1;
}

void ImageRegions::enclose_tile(std::size_t tile, Sections& tunnel) const { enclose(tunnel, around_[tile]); }

void ImageRegions::update_image(const std::vector<std::size_t>& tiles) {
  if (has_groups()) image_groups_.update(groups_, tiles);
  if (!has_tunnels()) return;
  image_tunnels_.update(tiles, [this](std::size_t tile, Sections& tunnel) { enclose_tile(tile, tunnel); });
}

bool ImageRegions::update(const Image& image, const GrowScene& grow, std::size_t tile, const Leaves& changed,
                          const ClassOf& class_of) {
  if (has_groups()) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    groups_[tile].update(image.trees[tile], rect.width(), image.view.samples, changed, class_of);
  }
  if (!has_tunnels()) {
    if (stored_) stale_[tile] |= changed;
    return false;
  }
  const Residency::Lease tunnels_lease = lease(PieceKind::tunnels, tile);
  const bool is_missing = tunnels_[tile].empty(), was_there = was_there_[tile] != 0;
  const TileGrid grid(cell_levels_[tile]);
  if (is_missing || grid.regions() == 0) {
    build(image, grow, tile, class_of);
    return is_missing && was_there;
  }
  TreeEncloser trees(image, grow, tile, options_.tunnels, class_of, lease(PieceKind::ray_trees, tile));
  TileTunnels rebuilt = tunnels_[tile].rebuilt(changed, options_.tunnels,
                                               [&](std::uint32_t cell) { return trees.of(grid.square_of(cell)); });
  Sections around = relook::around(rebuilt);
  keep(tile, std::move(rebuilt), std::move(around), std::nullopt);
  return false;
}

std::size_t ImageRegions::group_bytes() const {
  std::size_t sum = image_groups_.bytes();
  for (const PathGroups& groups : groups_) sum += groups.bytes();
  return sum;
}

std::size_t ImageRegions::tunnel_bytes() const {
  std::size_t sum = image_tunnels_.bytes();
  for (const TileTunnels& tunnels : tunnels_) sum += tunnels.bytes();
  return sum;
}

}  // namespace relook
