// Parts of the colours of ray trees, for the layers of a frame: by what lit them, or by what the first hit does with
// the light. Colours are linear in their sources, so that the parts sum to the whole but for rounding.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "color/shade.h"

namespace relook {

/// A part, and where it is a part.
struct LayerPart {
  ColorPart part;
  bool at_first_hit = false;  // what lies below is whole; otherwise every node is restricted
};

/// Evaluates parts of blocks of ray trees. One per thread; as a Shader.
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
