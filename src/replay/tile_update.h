// One pass over a tile after a change of the scene: the ray trees and colours of the samples that it may reach, worked
// out anew. Nothing is stored yet, so tiles can be done at the same time.
#pragma once
#include <span>
#include <vector>

#include "base/pool.h"
#include "color/shade.h"
#include "image/new_samples.h"
#include "image/stored_image.h"
#include "replay/change.h"
#include "replay/path_tasks.h"

namespace relook {

/// Where to look in a tile.
struct TileWork {
  Leaves leaves;   // with samples that the change may reach
  Leaves by_path;  // of these, what the paths tell
  TileGrid tunnel_grid = kLeafGrid;
  std::vector<CellTouches> touched;  // of these, what tunnels tell about their segments
  RegionCounters by_groups, by_tunnels;
  bool tests_all = false;       // nothing is known about its segments
  bool misses_tunnels = false;  // there should be some to tell
};

/// What became of the samples of one tile.
struct TileUpdate {
  NewSamples fresh;
  GrowCounters counters;
  std::uint64_t walked_segments = 0;  // of the samples whose stored segments have been counted one by one
};

/// What all tiles of a pass have in common.
struct UpdatePass {
  /// What has changed, and what that means for the paths.
  struct What {
    const StepChange& change;
    const PathTasks& tasks;
    const ColorScene& scene;  // after the change
    const GrowScene& grow;    // the same
    bool keeps_trees = true;  // false: an intermediate frame of a drag
  };
  /// Where to look for it.
  struct Where {
    const std::vector<Leaves>* known_leaves = nullptr;  // by tile, those that paths tell; null: to be found
    std::vector<bool> grouped_tiles{};                  // see tiles_with_tasks(); not read with `known_leaves`
    const TunnelTest* tunnel_test = nullptr;            // null: without tunnels, every segment is tested
    std::vector<bool> near_tiles{};                     // with tunnels: those that the change may touch
  };

  StoredImage& stored;
  ProgramTable& programs;
  What what;
  Where where;
};

/// What work on one tile after another needs; one per thread.
struct TileTools {
  TileTools(const ColorScene& scene, ProgramTable& programs) : shader(scene, programs) {}

  Shader shader;
  TreeBlock block;  // empty between tiles; keeps its memory
};

/// By tile: may it have a path with a task, as far as groups above the tiles tell? Empty if there is no task.
[[nodiscard]] std::vector<bool> tiles_with_tasks(const ImageRegions& regions, const PathTasks& tasks,
                                                 RegionCounters& counters);
[[nodiscard]] TileWork find_tile_work(const UpdatePass& pass, std::size_t tile);
/// Before a tile is worked on at some leaves: finds its hits again if it misses them, they are needed often enough, and
/// no path of it is to have its trees updated. Requires: the tile's ray trees are leased.
GrowCounters bring_back_hits(const UpdatePass& pass, std::size_t tile, const Leaves& leaves);
/// Requires: the tile's ray trees are leased.
[[nodiscard]] TileUpdate update_tile(const UpdatePass& pass, std::size_t tile, const TileWork& work,
                                     Pool<TileTools>& tools);

/// For the tiles with anything to do, in their order, what is to become of them. `works`: by tile.
[[nodiscard]] std::vector<TileUpdate> updates_to_do(const std::vector<TileWork>& works);
/// Indices of the updates, most work first, so that threads end together.
[[nodiscard]] std::vector<std::size_t> by_work(const std::vector<TileUpdate>& updates,
                                               const std::vector<TileWork>& works);
/// Those of a tile, if there are any. `fresh`: in the order of their tiles.
[[nodiscard]] const NewSamples* find_tile(std::span<const NewSamples> fresh, std::size_t tile);

}  // namespace relook
