// One pass over a tile after a change of the scene: the ray trees and colours of the samples that it may reach, worked
// out anew. Nothing is stored yet, so tiles can be done at the same time.
#pragma once
#include <vector>

#include "base/pool.h"
#include "color/shade.h"
#include "image/regions.h"
#include "replay/change.h"
#include "replay/path_tasks.h"

namespace relook {

class Residency;

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
  std::size_t tile = 0;
  std::vector<std::uint32_t> shaded;  // samples with new colours
  std::vector<Rgba> colors;           // of `shaded`
  std::vector<std::uint32_t> packed;  // samples with new trees, increasing
  PathTable paths;                    // of `packed`, numbered within the tile
  std::vector<PathId> packed_paths;
  std::vector<Hit> hits;
  std::vector<std::uint32_t> first_hit{0};
  GrowCounters counters;
  std::uint64_t walked_segments = 0;  // of the samples whose stored segments have been counted one by one
  bool missed_tunnels = false;        // there should have been some to tell what to test
};

/// What all tiles of a pass have in common.
struct UpdatePass {
  const Image& image;
  const std::vector<LightId>& lights;  // light order of the image's paths
  const ColorScene& scene;             // after the change
  const GrowScene& grow;               // the same
  const StepChange& change;
  const PathTasks& tasks;
  const PathClasses& classes;
  const PathIndex& index;
  const ImageRegions& regions;
  const TunnelTest* tunnel_test = nullptr;            // null: without tunnels, every segment is tested
  const std::vector<bool>& near_tiles;                // with tunnels: those that the change may touch
  const std::vector<bool>& grouped_tiles;             // see tiles_with_tasks(); not read if `known_leaves` is there
  const std::vector<Leaves>* known_leaves = nullptr;  // by tile, those that paths tell; null: to be found
  ProgramTable& programs;
  Residency& residency;
  bool keeps_trees = true;  // false: an intermediate frame of a drag
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
/// Requires: the tile's ray trees are leased.
[[nodiscard]] TileUpdate update_tile(const UpdatePass& pass, std::size_t tile, const TileWork& work,
                                     Pool<TileTools>& tools);

/// For the tiles with anything to do, in their order, what is to become of them. `works`: by tile.
[[nodiscard]] std::vector<TileUpdate> updates_to_do(const std::vector<TileWork>& works);
/// Indices of the updates, most work first, so that threads end together.
[[nodiscard]] std::vector<std::size_t> by_work(const std::vector<TileUpdate>& updates,
                                               const std::vector<TileWork>& works);
/// The update of a tile, if there is one. `updates`: in the order of their tiles.
[[nodiscard]] const TileUpdate* find_update(const std::vector<TileUpdate>& updates, std::size_t tile);

}  // namespace relook
