#include "color/shade.h"

#include <algorithm>

#include "color/compress.h"
#include "color/node_programs.h"

namespace relook {

struct Shader::Impl {
  const RayScene& scene;
  NodePrograms programs;
  ColorMemory memory;
  Batches batches;
  std::vector<std::uint32_t> batch_of;

  Impl(const RayScene& s, ProgramTable& table) : scene(s), programs(s, table) {}

  void run(const TreeBlock& block, bool are_filters, std::size_t batch, std::span<const std::uint32_t> indices) {
    const auto number = static_cast<std::uint32_t>(batch % programs.size());
    evaluate(programs.program(number), scene, block, are_filters, indices, memory.colors, memory.scratch);
  }

  void shade_filters(const TreeBlock& block) {
    memory.colors.filters.resize(block.filters.size());
    batch_of.clear();
    for (const FilterNode& filter : block.filters) batch_of.push_back(programs.number(block, filter));
    batches.for_each(batch_of, programs.size(), [&](std::size_t batch, std::span<const std::uint32_t> indices) {
      run(block, true, batch, indices);
    });
  }

  /// Deepest generation first.
  void shade_nodes(const TreeBlock& block) {
    memory.colors.nodes.resize(block.nodes.size());
    batch_of.clear();
    std::uint32_t generations = 0;
    for (const RayNode& node : block.nodes) {
      batch_of.push_back(programs.number(block, node));
      generations = std::max<std::uint32_t>(generations, node.ray.generation);
    }
    const auto count = static_cast<std::uint32_t>(programs.size());
    for (std::size_t i = 0; i < batch_of.size(); ++i)
      batch_of[i] += (generations - block.nodes[i].ray.generation) * count;
    batches.for_each(
        batch_of, std::size_t{generations} * count,
        [&](std::size_t batch, std::span<const std::uint32_t> indices) { run(block, false, batch, indices); });
  }
};

Shader::Shader(const RayScene& scene, ProgramTable& programs) : impl_(std::make_unique<Impl>(scene, programs)) {}
Shader::~Shader() = default;

void Shader::shade(const TreeBlock& block, std::span<const std::uint32_t> roots, std::span<Rgba> out) {
  if (!block.filters.empty()) impl_->shade_filters(block);
  impl_->shade_nodes(block);
  for (std::size_t k = 0; k < roots.size(); ++k) out[k] = impl_->memory.colors.nodes[roots[k]];
}

CompressedBlock Shader::compress(const TreeBlock& block, std::span<const std::uint32_t> roots,
                                 const ParameterSet& parameters, SplitTable& splits) {
  return compress_block(block, roots, parameters, {impl_->scene, impl_->programs, splits, impl_->memory});
}

}  // namespace relook
