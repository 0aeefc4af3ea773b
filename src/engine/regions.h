// The image quadtree with what its regions know: groups of paths, and tunnels around ray trees (paper 3). Kept equal to
// what would be built afresh from the image, whatever journal has been replayed.
#pragma once
#include <vector>

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
  double color_trees = 1;   // share of the samples whose colour trees are kept, over all sets of parameters
  std::uint32_t atoms = 0;  // depth of the node hierarchy from which nodes count as one object; 0: none
};

class ImageRegions {
 public:
  explicit ImageRegions(const RegionOptions& options) : options_(options) {}
  [[nodiscard]] const RegionOptions& options() const { return options_; }

  /// Groups of all tiles, afresh. `class_of`: see PathGroups.
  void build_groups(const Image& image, const ClassOf& class_of);
  /// Tunnels of all tiles, afresh. `grow`: the scene in which the image's trees hold.
  void build_tunnels(const Image& image, const GrowScene& grow, const ClassOf& class_of);
  [[nodiscard]] bool has_groups() const { return !groups_.empty(); }
  [[nodiscard]] bool has_tunnels() const { return !tunnels_.empty(); }

  /// After the trees of some leaves of a tile have changed: its groups and, if there are any, its tunnels. Tiles may be
  /// updated at the same time; update_image() with all of them follows.
  void update(const Image& image, const GrowScene& grow, std::size_t tile, const Leaves& changed,
              const ClassOf& class_of);

  void update_image(const std::vector<std::size_t>& tiles);

  /// By tile: may the change touch its tunnels? Requires has_tunnels().
  [[nodiscard]] std::vector<bool> find_tiles(const TunnelTest& test, RegionCounters& counters) const {
    return image_tunnels_.find(test, counters);
  }
  [[nodiscard]] const TunnelPyramid& image_tunnels() const { return image_tunnels_; }
  [[nodiscard]] const PathGroups& groups(std::size_t tile) const { return groups_[tile]; }
  [[nodiscard]] const TileTunnels& tunnels(std::size_t tile) const { return tunnels_[tile]; }
  [[nodiscard]] std::size_t group_bytes() const;
  [[nodiscard]] std::size_t tunnel_bytes() const;

 private:
  void enclose_tile(std::size_t tile, Sections& tunnel) const;
  [[nodiscard]] PathGroups groups_of(const Image& image, std::size_t tile, const ClassOf& class_of) const;
  RegionOptions options_;
  std::vector<PathGroups> groups_;
  std::vector<TileTunnels> tunnels_;
  TunnelPyramid image_tunnels_;
};

}  // namespace relook
