#include "color/block_shading.h"

#include <algorithm>

namespace relook {

void BlockShading::shade_filters(const TreeBlock& block, NodePrograms& programs) {
  if (block.filters.empty()) return;
  memory_.colors.filters.resize(block.filters.size());
  batch_of_.clear();
  for (const FilterNode& filter : block.filters) batch_of_.push_back(programs.number(block, filter));
  batches_.for_each(batch_of_, programs.size(), [&](std::size_t batch, std::span<const std::uint32_t> indices) {
    const BoundProgram& program = programs.program(static_cast<std::uint32_t>(batch));
    evaluate(program, scene_, block, true, indices, memory_);
  });
}

void BlockShading::shade_nodes(const TreeBlock& block, NodePrograms& programs) {
  memory_.colors.nodes.resize(block.nodes.size());
  batch_of_.clear();
  std::uint32_t generations = 0;
  for (const RayNode& node : block.nodes) {
    batch_of_.push_back(programs.number(block, node));
    generations = std::max<std::uint32_t>(generations, node.ray.generation);
  }
  const auto count = static_cast<std::uint32_t>(programs.size());
  for (std::size_t i = 0; i < batch_of_.size(); ++i)
    batch_of_[i] += (generations - block.nodes[i].ray.generation) * count;
  batches_.for_each(batch_of_, std::size_t{generations} * count,
                    [&](std::size_t batch, std::span<const std::uint32_t> indices) {
                      const BoundProgram& program = programs.program(static_cast<std::uint32_t>(batch % count));
                      evaluate(program, scene_, block, false, indices, memory_);
                    });
}

void BlockShading::shade_nodes(const TreeBlock& block, NodePrograms& programs, std::span<const std::uint32_t> nodes) {
  batch_of_.clear();
  for (const std::uint32_t node : nodes) batch_of_.push_back(programs.number(block, block.nodes[node]));
  batches_.for_each(batch_of_, programs.size(), [&](std::size_t batch, std::span<const std::uint32_t> places) {
    chosen_.clear();
    for (const std::uint32_t place : places) chosen_.push_back(nodes[place]);
    const BoundProgram& program = programs.program(static_cast<std::uint32_t>(batch));
    evaluate(program, scene_, block, false, chosen_, memory_);
  });
}

}  // namespace relook
