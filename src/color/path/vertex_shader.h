// Terms of lights at vertices that are kept (tile_vertices.h), without ray trees: samples of lights in, terms into the
// sums of a tile. Gives the bits of PathShader. Called by replay/path.
#pragma once
#include <span>
#include <vector>

#include "color/path/met_lights.h"
#include "color/path/path_runner.h"
#include "color/path/sum_places.h"
#include "color/path/tile_vertices.h"
#include "light/sums/tile_sums.h"

namespace relook {

/// A term of a light at a vertex that it reaches.
struct LitTerm {
  LightTerm term;  // with the vertex's columns
  Color weight;
  float scale = 1;
  std::uint32_t pixel = 0;
  std::uint32_t first_filter = 0, filters = 0;  // on its segment
};

/// Keeps its working memory between calls; one per thread. All must outlive it.
class VertexShader {
 public:
  VertexShader(const ColorScene& scene, PathPrograms& programs, const SumPlaces& places);

  /// `batch`: of the terms' vertices. `block`: has the filters of their segments alone.
  void add_lit(const TileVertices::Batch& batch, const TreeBlock& block, std::span<const LitTerm> terms,
               TileSums& sums);

  /// What is asked for of rays.
  struct Wanted {
    std::span<const std::uint8_t> sums;    // by sum, of those that are no light's
    std::span<const std::uint8_t> lights;  // by place in the light order
  };
  /// Of lights that rays meet and, if they leave the scene, of what surrounds it.
  void add_met(std::span<const MetRay> rays, bool leave, const Wanted& wanted, TileSums& sums);

 private:
  const ColorScene& scene_;
  const SumPlaces& places_;
  MetLights met_;
  PathRunner runner_;
  std::vector<Color> tints_;  // by filter
  std::vector<const LightTerm*> terms_;
};

/// The share of light that passes each filter of a block.
void shade_filters(const TreeBlock& block, PathRunner& runner, std::vector<Color>& tints);

}  // namespace relook
