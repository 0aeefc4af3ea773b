// The image quadtree with what its regions know: groups of paths, and tunnels around ray trees (paper 3). Kept equal to
// what would be built afresh from the image, whatever journal has been replayed.
#pragma once
#include <vector>

#include "cache/residency.h"
#include "engine/image.h"
#include "region/path_groups.h"
#include "region/tile_tunnels.h"
#include "region/tunnel_pyramid.h"
#include "trace/grow.h"

namespace relook {

/// Which structures are kept beside ray paths and ray trees.
struct RegionOptions {
  std::size_t groups = 4;   // most paths of a group; 0: none
  std::size_t tunnels = 1;  // a region's; 0: none
  double ray_trees = 1;     // share of the samples whose ray trees are kept
  double color_trees = 1;   // share of the samples whose colour trees are kept, over all sets of parameters
  std::uint32_t atoms = 0;  // depth of the node hierarchy from which nodes count as one object; 0: none
};

class ImageRegions {
 public:
  /// `residency`: where the tunnels and ray trees of tiles are pieces; outlives this, which then stays where it is.
  /// Null: everything is resident.
  explicit ImageRegions(const RegionOptions& options, Residency* residency = nullptr)
      : options_(options), residency_(residency) {}
  [[nodiscard]] const RegionOptions& options() const { return options_; }

  /// Groups of all tiles, afresh. `class_of`: see PathGroups.
  void build_groups(const Image& image, const ClassOf& class_of);
  /// Tunnels of all tiles, afresh. `grow`: the scene in which the image's trees hold.
  void build_tunnels(const Image& image, const GrowScene& grow, const ClassOf& class_of);
  [[nodiscard]] bool has_groups() const { return !groups_.empty(); }
  [[nodiscard]] bool has_tunnels() const { return !tunnels_.empty(); }

  /// After the trees of some leaves of a tile have changed: its groups and, if tunnels have been built, its tunnels,
  /// all of them if they are missing. Tiles may be updated at the same time; update_image() with all of them follows.
  void update(const Image& image, const GrowScene& grow, std::size_t tile, const Leaves& changed,
              const ClassOf& class_of);

  void update_image(const std::vector<std::size_t>& tiles);

  /// By tile: may the change touch its tunnels? Requires has_tunnels().
  [[nodiscard]] std::vector<bool> find_tiles(const TunnelTest& test, RegionCounters& counters) const {
    return image_tunnels_.find(test, counters);
  }
  [[nodiscard]] const TunnelPyramid& image_tunnels() const { return image_tunnels_; }
  [[nodiscard]] const PathGroups& groups(std::size_t tile) const { return groups_[tile]; }
  /// Empty if they are missing. Requires: they are leased.
  [[nodiscard]] const TileTunnels& tunnels(std::size_t tile) const { return tunnels_[tile]; }
  [[nodiscard]] std::size_t group_bytes() const;
  [[nodiscard]] std::size_t tunnel_bytes() const;

 private:
  void add_pieces(std::size_t tiles);
  [[nodiscard]] Residency::Lease lease(PieceKind kind, std::size_t tile) {
    return residency_ != nullptr ? residency_->use(kind, tile) : Residency::Lease();
  }
  /// Takes over the tunnels of a tile. `seconds`: that all of them took; none: some were there before.
  void keep(std::size_t tile, TileTunnels tunnels, std::optional<double> seconds);
  void enclose_tile(std::size_t tile, Sections& tunnel) const;
  [[nodiscard]] PathGroups groups_of(const Image& image, std::size_t tile, const ClassOf& class_of) const;
  RegionOptions options_;
  Residency* residency_;
  std::vector<PathGroups> groups_;
  std::vector<TileTunnels> tunnels_;
  std::vector<Sections> tile_sections_;  // around all of a tile's tunnels: always resident
  TunnelPyramid image_tunnels_;
};

}  // namespace relook
