#include "color/shade.h"

#include "color/block_shading.h"
#include "color/compress/compress.h"

namespace relook {

struct Shader::Impl {
  const ColorScene& scene;
  NodePrograms programs;
  BlockShading shading;

  Impl(const ColorScene& s, ProgramTable& table) : scene(s), programs(s, table), shading(s) {}
};

Shader::Shader(const ColorScene& scene, ProgramTable& programs) : impl_(std::make_unique<Impl>(scene, programs)) {}
Shader::~Shader() = default;

void Shader::shade(const TreeBlock& block, std::span<const std::uint32_t> roots, std::span<Rgba> out) {
  impl_->shading.shade_filters(block, impl_->programs);
  impl_->shading.shade_nodes(block, impl_->programs);
  for (std::size_t k = 0; k < roots.size(); ++k) out[k] = impl_->shading.colors().nodes[roots[k]];
}

CompressedBlock Shader::compress(const TreeBlock& block, std::span<const std::uint32_t> roots,
                                 const ParameterSet& parameters, SplitTable& splits) {
  return compress_block(block, roots, parameters, {impl_->scene, impl_->programs, splits, impl_->shading.memory()});
}

}  // namespace relook
