// From ray trees to terms of light (PATH.md): every hit brings a term of unit-light transport for each light that reaches
// it, each ray one for what it meets or crosses on its way. Trees in; sums of a tile out, to which their terms are added,
// or from which they are taken. Called by render and preprocess (image/), and by replay/ for samples that an edit reaches.
#pragma once
#include <memory>
#include <span>

#include "color/path/kept_terms.h"
#include "color/path/path_programs.h"
#include "color/path/sum_places.h"
#include "color/path/tile_vertices.h"
#include "light/sums/tile_sums.h"

namespace relook {

enum class TermSign : std::uint8_t { add, subtract };

/// Keeps its working memory between calls; one per thread. All must outlive it.
class PathShader {
 public:
  PathShader(const ColorScene& scene, PathPrograms& programs, const SumPlaces& places);
  ~PathShader();
  /// Which terms are asked for: of `whole` samples all, of others those of `lights` and of the rest of `sums`.
  struct Wanted {
    std::span<const std::uint8_t> sums;    // by sum, of those that are no light's; empty: all of everything
    std::span<const std::uint8_t> lights;  // by place in the light order
    std::span<const std::uint8_t> whole;   // by sample of the tile; empty: none
    /// By node: as weights() was. Of surfaces' own terms and of emission none is then wanted. Empty: to be found.
    std::span<const Color> weights;
  };
  /// The terms of all trees of a block, whose nodes' samples count within the tile, `samples` a pixel.
  void shade(const TreeBlock& block, std::uint32_t samples, TermSign sign, TileSums& sums, const Wanted& wanted = {});
  /// Adds terms of lights, and appends the block's vertices to `vertices`. Requires: weights are known, all vertices
  /// have their lobes.
  void shade_keeping(const TreeBlock& block, std::uint32_t samples, TileSums& sums, const Wanted& wanted,
                     TileVertices& vertices);
  /// Fills `kept`, which is empty, with the terms of a block that an edit of some parameters changes, in place of
  /// adding any. Requires: the parameters are of materials, no fields of kMappingMask among them.
  void keep(const TreeBlock& block, std::uint32_t samples, const ParameterSet& parameters, KeptTerms& kept);
  /// By node of the block that was shaded, or kept, last: what of unit light there comes to the eye.
  [[nodiscard]] std::span<const Color> weights() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relook
