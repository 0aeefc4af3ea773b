#include "color/expression/node_sums.h"

#include <algorithm>

#include "color/expression/evaluate.h"

namespace relook {

NodeSums::NodeSums(const BoundProgram& bound, const NodeBatch& nodes, SumMemory& memory, Scratch& scratch)
    : program_(*bound.program),
      parameters_{nodes.scene.scene(), bound.material},
      nodes_(nodes),
      memory_(memory),
      scratch_(scratch),
      lanes_(nodes.indices.size()),
      stride_(whole_vectors(lanes_)),
      sums_(memory.sums, program_.sums.size(), lanes_) {
  find_reached();
  const Kernel& constants = program_.pieces.constants;
  const std::size_t count = constants.outputs.size();
  memory_.columns.resize(std::max(memory_.columns.size(), count * stride_));
  KernelRun run(constants, parameters_, nodes_, lanes_, scratch_);
  for (std::size_t first = 0; first < lanes_; first += kLanes) {
    const std::size_t some = std::min(kLanes, lanes_ - first);
    run.run(first, some);
    for (std::size_t k = 0; k < count; ++k)
      std::copy_n(run.output(k), some, memory_.columns.data() + k * stride_ + first);
  }
}

void NodeSums::find_reached() {
  const std::size_t lamps = nodes_.scene.light_order().size();
  memory_.reached.resize(2 * lamps);
  for (auto& lanes : memory_.reached) lanes.clear();
  memory_.first_lights.resize(lanes_);
  for (std::uint32_t lane = 0; lane < lanes_; ++lane) {
    const std::uint32_t first = nodes_.block.nodes[nodes_.indices[lane]].first_light;
    memory_.first_lights[lane] = first;
    const LightLink* links = nodes_.block.lights.data() + first;
    for (std::size_t place = 0; place < lamps; ++place)
      if (const ShadowState state = links[place].state; reaches(state))
        memory_.reached[2 * place + (state == ShadowState::filtered ? 1 : 0)].push_back(lane);
  }
}

Parameters NodeSums::parameters_of(std::uint32_t place) const {
  Parameters parameters = parameters_;
  parameters.light = nodes_.scene.light_order()[place];
  return parameters;
}

void NodeSums::start(std::size_t sum) {
  run_stage(sum, [&](std::size_t first, std::size_t lanes, const auto& run) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      std::copy_n(run.output(channel), lanes, sums_.at(sum, channel) + first);
  });
}

void NodeSums::add(std::size_t sum, std::uint32_t place, bool filtered) {
  const std::span<const std::uint32_t> lanes = reached(place, filtered);
  if (lanes.empty()) return;
  const LightKind kind = nodes_.scene.scene().light(nodes_.scene.light_order()[place]).kind;
  run_term(program_.pieces.terms[sum][light_term(kind, filtered)], place, lanes,
           [&](std::size_t first, std::size_t some, const auto& run) {
             sums_.add(sum, lanes.subspan(first, some), run);
           });
}

void NodeSums::add_all(std::size_t sum) {
  for (std::uint32_t place = 0; place < memory_.reached.size() / 2; ++place)
    for (const bool filtered : {false, true}) add(sum, place, filtered);
}

void NodeSums::StageLanes::load(const Kernel::Step& step, std::size_t first, std::size_t, const Parameters&,
                                Scratch& scratch) const {
  const float* values =
      step.op == Op::column ? owner.column(step.payload.number()) : owner.sums_.at(step.payload);
  scratch.at[step.out] = values + first;
}

void NodeSums::TermLanes::load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&,
                               Scratch& scratch) const {
  const std::span<const std::uint32_t> some = chosen.subspan(first, lanes);
  float* out = scratch.own(step.out);
  if (step.op == Op::column) {
    const float* column = owner.column(step.payload.number());
    for (std::size_t k = 0; k < lanes; ++k) out[k] = column[some[k]];
    return;
  }
  const TreeBlock& block = owner.nodes_.block;
  const int channel = static_cast<int>(step.payload.axis());
  for (std::size_t k = 0; k < lanes; ++k)
    out[k] = tint(block.lights[owner.memory_.first_lights[some[k]] + place], channel, owner.nodes_.colors);
}

}  // namespace relook
