#include "color/expression/evaluate.h"

#include <algorithm>

#include "color/expression/gather.h"

namespace relook {

void NodeBatch::load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
                     Scratch& scratch) const {
  const Gathering from{scene, block, are_filters, indices.subspan(first, lanes)};
  switch (step.op) {
    case Op::input:
      return gather(step.payload, from, colors, scratch.own(step.out));
    case Op::coordinates:
      if (Column* out = scratch.share(step.out, mapping_key(parameters.slot(step))))
        gather_coordinates(parameters.slot(step), from, out);
      return;
    case Op::tangent_frame:
      return gather_tangent_frames(parameters.slot(step), from, scratch.own(step.out, 6));
    default:
      return;
  }
}

namespace {

/// Nodes that go through the pieces of a program at a time: long runs of lanes for each lamp, columns in the cache.
constexpr std::size_t kSumNodes = 1024;

/// Takes the outputs of a run over lanes from `first` on.
template <class Run>
void store(const Run& run, std::span<const std::uint32_t> indices, std::vector<Rgba>& out) {
  const float *red = run.output(0), *green = run.output(1), *blue = run.output(2), *alpha = run.output(3);
  for (std::size_t lane = 0; lane < indices.size(); ++lane)
    out[indices[lane]] = Rgba(red[lane], green[lane], blue[lane], alpha[lane]);
}

void evaluate_sums(const BoundProgram& bound, const NodeBatch& batch, ColorMemory& memory) {
  NodeSums sums(bound, batch, memory.sums, memory.scratch);
  for (std::size_t sum = 0; sum < bound.program->sums.size(); ++sum) {
    sums.start(sum);
    sums.add_all(sum);
  }
  sums.finish([&](std::size_t first, std::size_t lanes, const auto& run) {
    store(run, batch.indices.subspan(first, lanes), memory.colors.nodes);
  });
}

}  // namespace

void evaluate(const BoundProgram& bound, const ColorScene& scene, const TreeBlock& block, bool are_filters,
              std::span<const std::uint32_t> indices, ColorMemory& memory) {
  if (!bound.program->sums.empty()) {
    for (std::size_t first = 0; first < indices.size(); first += kSumNodes) {
      const std::size_t some = std::min(kSumNodes, indices.size() - first);
      evaluate_sums(bound, {scene, block, memory.colors, are_filters, indices.subspan(first, some)}, memory);
    }
    return;
  }
  const Parameters parameters{scene.scene(), bound.material};
  const NodeBatch batch{scene, block, memory.colors, are_filters, indices};
  KernelRun run(bound.program->kernel, parameters, batch, indices.size(), memory.scratch);
  std::vector<Rgba>& out = are_filters ? memory.colors.filters : memory.colors.nodes;
  for (std::size_t first = 0; first < indices.size(); first += kLanes) {
    const std::size_t lanes = std::min(kLanes, indices.size() - first);
    run.run(first, lanes);
    store(run, indices.subspan(first, lanes), out);
  }
}

}  // namespace relook
