// The image quadtree with what its regions know: groups of paths, and tunnels around ray trees (paper 3). Kept equal to
// what would be built afresh from the image, whatever journal has been replayed.
#pragma once
#include <memory>
#include <vector>

#include "cache/residency/residency.h"
#include "cache/stored_tunnels.h"
#include "frame/image.h"
#include "region/path_groups.h"
#include "region/tile_tunnels.h"
#include "region/tunnel_pyramid.h"
#include "region/tunnel_shape.h"
#include "trace/tree/grow.h"

namespace relook {

/// Which structures are kept beside ray paths, and how much of them.
struct RegionOptions {
  std::size_t groups = 4;           // most paths of a group; 0: none
  std::size_t tunnels = 1;          // most of a region; 0: none
  double ray_trees = 1;             // share of the samples whose ray trees are kept
  double color_trees = 1;           // share of the samples whose colour trees are kept, over all sets of parameters
  std::uint32_t atoms = 0;          // depth of the node hierarchy from which nodes count as one object; 0: none
  std::uint32_t tunnel_levels = 2;  // the lowest levels of the quadtree without tunnels
  std::optional<std::uint64_t> most_tunnels = std::nullopt;  // of the image; none: no limit

  [[nodiscard]] TunnelShape shape() const { return {tunnels, tunnel_levels, most_tunnels}; }
  /// Are these tunnels those of a cache?
  [[nodiscard]] bool has_tunnels_of(const StorageOptions& storage) const {
    return storage.has_tunnels_like(shape(), atoms);
  }
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
  /// Tunnels of all tiles: those that are stored and still hold are there when they are first used, the others are
  /// built afresh. `grow`: the scene in which the image's trees hold. Returns the tiles whose tunnels were stored and
  /// cannot be read.
  std::vector<std::size_t> build_tunnels(const Image& image, const GrowScene& grow, const ClassOf& class_of);
  /// Tunnels of the image as it is now, in a cache. Comes before build_tunnels().
  void offer(std::shared_ptr<StoredTunnels> stored, std::size_t tiles);
  /// The stored ones do not hold any more: paths have other ids, or lights have changed.
  void forget_stored();
  /// Do the options allow any in an image of this size?
  [[nodiscard]] bool may_have_tunnels(const Image& image) const;
  [[nodiscard]] bool has_groups() const { return !groups_.empty(); }
  [[nodiscard]] bool has_tunnels() const { return !tunnels_.empty(); }

  /// After the trees of some leaves of a tile have changed: its groups and, if tunnels have been built, its tunnels,
  /// all of them if they are missing. Tiles may be updated at the same time; update_image() with all of them follows.
  /// Returns true if the tile's tunnels had been there before and were missing.
  bool update(const Image& image, const GrowScene& grow, std::size_t tile, const Leaves& changed,
              const ClassOf& class_of);

  /// After update() of these tiles: what the regions above them know.
  void update_image(const std::vector<std::size_t>& tiles);

  /// By tile: may it have a path class that is flagged? Requires has_groups().
  [[nodiscard]] std::vector<bool> find_tiles(std::span<const std::uint8_t> flagged, RegionCounters& counters) const {
    return image_groups_.find(flagged, counters);
  }
  [[nodiscard]] const GroupPyramid& image_groups() const { return image_groups_; }

  /// By tile: may the change touch its tunnels? Requires has_tunnels().
  [[nodiscard]] std::vector<bool> find_tiles(const TunnelTest& test, RegionCounters& counters) const {
    return image_tunnels_.find(test, counters);
  }
  [[nodiscard]] const TunnelPyramid& image_tunnels() const { return image_tunnels_; }
  [[nodiscard]] const PathGroups& groups(std::size_t tile) const { return groups_[tile]; }
  /// Empty if they are missing. Requires: they are leased.
  [[nodiscard]] const TileTunnels& tunnels(std::size_t tile) const { return tunnels_[tile]; }
  /// Around all tunnels of a tile. Requires has_tunnels().
  [[nodiscard]] const Sections& around(std::size_t tile) const { return around_[tile]; }
  [[nodiscard]] std::size_t group_bytes() const;
  [[nodiscard]] std::size_t tunnel_bytes() const;

 private:
  void add_pieces(std::size_t tiles);
  [[nodiscard]] Residency::Lease lease(PieceKind kind, std::size_t tile) {
    return residency_ != nullptr ? residency_->use(kind, tile) : Residency::Lease();
  }
  /// Those of a tile that are stored. False: there are none.
  bool take_stored(std::size_t tile);
  void build(const Image& image, const GrowScene& grow, std::size_t tile, const ClassOf& class_of);
  /// Takes over the tunnels of a tile. `seconds`: that all of them took; none: some were there before.
  void keep(std::size_t tile, TileTunnels tunnels, Sections around, std::optional<double> seconds);
  void measure_areas();
  [[nodiscard]] double relative_to_mean(double area) const;
  void enclose_tile(std::size_t tile, Sections& tunnel) const;
  [[nodiscard]] PathGroups groups_of(const Image& image, std::size_t tile, const ClassOf& class_of) const;
  RegionOptions options_;
  Residency* residency_;
  std::vector<PathGroups> groups_;
  GroupPyramid image_groups_;
  std::vector<std::uint8_t> cell_levels_;  // by tile
  std::vector<TileTunnels> tunnels_;
  std::vector<Sections> around_;  // by tile: around all of its trees, always resident
  TunnelPyramid image_tunnels_;
  std::vector<LightEnd> lights_;         // when tunnels were built
  double mean_area_ = 1;                 // of a tile's tunnels then, square metres
  std::vector<std::uint8_t> was_there_;  // by tile: has it ever had tunnels, or are they stored?
  std::shared_ptr<StoredTunnels> stored_;
  std::vector<Leaves> stale_;  // by tile, before tunnels are built: leaves whose stored ones do not hold any more
};

}  // namespace relook
