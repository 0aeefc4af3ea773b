#include "image/cached_tunnels.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "image/path_classes.h"
#include "image/regions.h"
#include "image/tree_encloser.h"
#include "trace/object_levels.h"

namespace relook {
namespace {

/// What enclosing the trees of an image takes.
class Enclosing {
 public:
  Enclosing(const SceneState& state, const Image& image, std::uint32_t atoms)
      : image_(image), rays_(state.scene()), objects_(rays_), classes_(atoms > 0) {
    classes_.extend(image.paths, grow().layout(), atoms > 0 ? atoms_of(state, atoms) : std::vector<ObjectId>());
  }
  [[nodiscard]] GrowScene grow() const {
    return {rays_, nullptr, image_.view.max_depth, image_.view.shadow_bits, &objects_};
  }
  [[nodiscard]] ClassOf class_of() const {
    return [this](PathId path) { return classes_.of(path); };
  }

 private:
  const Image& image_;
  RayScene rays_;
  ObjectLevels objects_;
  PathClasses classes_;
};

/// One cell in so many is looked at, from a place on that differs from tile to tile.
constexpr std::uint32_t kCellStride = 11;

bool are_tunnels(std::span<const Tunnel> built, const TileTunnels& stored, std::uint32_t region) {
  if (built.size() != stored.count(region)) return false;
  for (std::size_t k = 0; k < built.size(); ++k) {
    const TileTunnels::View view = stored.tunnel(region, k);
    if (built[k].path != view.path || !std::ranges::equal(built[k].sections, view.sections)) return false;
  }
  return true;
}

}  // namespace

void build_tunnels_again(const SceneState& state, std::span<const std::size_t> tiles, CacheContent& content) {
  if (tiles.empty()) return;
  const Image& image = content.image;
  const StorageOptions& storage = content.storage;
  const Enclosing enclosing(state, image, storage.atoms);
  ImageRegions regions({.tunnels = storage.tunnels.of_region,
                        .atoms = storage.atoms,
                        .tunnel_levels = storage.tunnels.dropped_levels,
                        .most_tunnels = storage.tunnels.of_image});
  static_cast<void>(regions.build_tunnels(image, enclosing.grow(), enclosing.class_of()));
  for (const std::size_t tile : tiles) {
    content.around_tiles[tile] = regions.around(tile);
    content.tunnels[tile] = regions.tunnels(tile);
  }
}

std::size_t count_wrong_tunnels(const SceneState& state, const Image& image, StoredTunnels& stored) {
  const StorageOptions& storage = stored.shape();
  const Enclosing enclosing(state, image, storage.atoms);
  const GrowScene grow = enclosing.grow();
  const ClassOf class_of = enclosing.class_of();
  std::atomic<std::size_t> wrong = 0;
  parallel_for(image.trees.size(), [&](std::size_t tile) {
    const std::optional<Sections> around = stored.around(tile);
    if (!around) return;  // damaged and said elsewhere
    const std::optional<TileTunnels> tunnels = stored.read(tile);
    TreeEncloser trees(image, grow, tile, storage.tunnels.of_region, class_of);
    const TileGrid grid = tunnels ? tunnels->grid() : TileGrid(kTileLevel + 1);
    bool is_right = grid.regions() > 0 || trees.around() == *around;  // otherwise it follows from the cells
    for (auto cell = static_cast<std::uint32_t>(tile % kCellStride); is_right && cell < grid.cells();
         cell += kCellStride)
      is_right = are_tunnels(trees.of(grid.square_of(cell)), *tunnels, cell);
    wrong += is_right ? 0 : 1;
  });
  return wrong;
}

}  // namespace relook
