// One tile after an edit, under the path integrator: ray trees brought up to date, terms of light that no longer hold
// taken out of its sums, new ones added: base minus old plus new is the full render's, bit for bit. Tiles can be done
// at the same time.
#pragma once
#include <optional>

#include "base/pool.h"
#include "color/path/vertex_shader.h"
#include "image/tile_light.h"
#include "replay/path/path_change.h"
#include "replay/replay_parts.h"
#include "trace/tree/grow.h"
#include "trace/update/kept_rays.h"
#include "trace/update/kept_segments.h"

namespace relook {

/// What kept rays are good for in a step.
enum class RayUse : std::uint8_t {
  none,
  tests,   // stored segments are tested along them; trees that change are grown without
  colors,  // no tree changes
  lights   // with their weights: only lights change, of which each has its own terms
};

/// What all tiles of a step have in common.
struct PathPass {
  const PathChange& change;
  const Image& image;
  const TilePrograms& before;  // of the scene before the edit
  const TilePrograms& after;   // and after it
  const GrowScene& grow_before;
  const GrowScene& grow_after;
  Pool<PathShader>& shaders_before;  // of the programs above
  Pool<PathShader>& shaders_after;
  Pool<VertexShader>& vertex_shaders;  // of those after the edit
  Pool<TermMemory>& term_memory;
  std::vector<std::uint8_t> update_path{};  // by path: its trees may change, or must be packed anew
  std::vector<std::uint8_t> shade_path{};   // by path: its terms change though its tree does not
  std::vector<std::uint8_t>
      relight_path{};                      // by path: lights that are taken or given may reach it; empty: they may all
  std::vector<std::uint8_t> named_path{};  // by path: it names an object with a flag
  bool updates_all = false;                // every path is in update_path
  RayUse ray_use = RayUse::none;
  SegmentSelection selection{};                   // of a step that moves something and no light
  SegmentGrid segment_grid{};                     // in which such a step writes segments down; empty: it does not
  bool uses_vertices = false;                     // with RayUse::lights: may_use_vertices()
  std::optional<ParameterSet> term_parameters{};  // those of an edit for whose like terms are kept
};

/// What there is of a tile before an edit.
struct KeptOfTile {
  const PackedSums& sums;
  const TileRays& rays;                 // empty: not kept
  const TileSegments& segments;         // empty: not kept
  std::vector<std::uint8_t> touched{};  // by sample: may the selection touch its tree? Empty: not known
  bool makes_vertices = false;          // are vertices to be kept from now on, where they can be?
};

struct PathTileResult {
  NewSamples fresh;                // trees alone
  std::optional<TileRays> rays;    // to be kept from now on; none: as before
  std::optional<TileTerms> terms;  // likewise
  std::optional<TileSegments> segments;  // likewise; empty: they do not hold any more
  std::optional<TileVertices> vertices;  // likewise
  bool keeps_vertices = false;           // those that are kept still hold
  bool has_other_weights = false;  // than those that are kept with rays
  PackedSums sums;                 // of the tile as it is now
  bool has_changed = false;
  std::uint64_t samples = 0;  // whose terms have been worked out
  std::uint64_t reused = 0;   // of these, from terms that were kept
  GrowCounters counters;
};

/// Requires: the tile's hits are there.
[[nodiscard]] PathTileResult update_path_tile(const PathPass& pass, std::size_t tile, const KeptOfTile& kept);
/// The same of a tile in which all stays as it is; none: something may change. Asks for no piece but the segments.
[[nodiscard]] std::optional<PathTileResult> leave_path_tile(const PathPass& pass, std::size_t tile,
                                                            const TileSegments& segments,
                                                            std::span<const std::uint8_t> touched);
/// The same of a tile whose terms are kept for what the edit changes.
[[nodiscard]] PathTileResult recolor_path_tile(const PathPass& pass, std::size_t tile, const PackedSums& sums,
                                               const TileTerms& terms);
/// The same of a tile whose hits are not: all is traced again.
[[nodiscard]] PathTileResult trace_path_tile(const PathPass& pass, std::size_t tile);

}  // namespace relook
