// Parts of the colours of ray trees, for the layers of a frame: by what lit them, or by what the first hit does with
// the light. Colours are linear in their sources, so that the parts sum to the whole but for rounding. Called tile by
// tile for frames with layers (image/layer_tile.h).
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "color/shade.h"

namespace relook {

/// A part of a colour, and at which nodes nothing else counts.
struct LayerPart {
  ColorPart part;
  bool at_first_hit = false;  // only the first hit is restricted to the part, nodes below it are whole; false: all are
};

/// Evaluates parts of blocks of ray trees; as a Shader, one per thread.
class PartShader {
 public:
  PartShader(const ColorScene& scene, ProgramTable& programs, std::span<const LayerPart> parts);
  ~PartShader();
  /// out[p][k] is part p of the sample whose tree is rooted at roots[k].
  void shade(const TreeBlock& block, std::span<const std::uint32_t> roots, std::vector<std::vector<Rgba>>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relook
