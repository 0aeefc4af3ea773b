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
      return gather_coordinates(parameters.slot(step), from, scratch.own(step.out, 4));
    case Op::tangent_frame:
      return gather_tangent_frames(parameters.slot(step), from, scratch.own(step.out, 6));
    default:
      return;
  }
}

void evaluate(const BoundProgram& bound, const ColorScene& scene, const TreeBlock& block, bool are_filters,
              std::span<const std::uint32_t> indices, BlockColors& colors, Scratch& scratch) {
  const Parameters parameters{scene.scene(), bound.material};
  const NodeBatch batch{scene, block, colors, are_filters, indices};
  KernelRun run(bound.program->kernel, parameters, batch, indices.size(), scratch);
  std::vector<Rgba>& out = are_filters ? colors.filters : colors.nodes;
  for (std::size_t first = 0; first < indices.size(); first += kLanes) {
    const std::size_t lanes = std::min(kLanes, indices.size() - first);
    run.run(first, lanes);
    const float *red = run.output(0), *green = run.output(1), *blue = run.output(2), *alpha = run.output(3);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      out[indices[first + lane]] = Rgba(red[lane], green[lane], blue[lane], alpha[lane]);
  }
}

}  // namespace relook
