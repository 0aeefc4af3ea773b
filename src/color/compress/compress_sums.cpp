#include "color/compress/compress_sums.h"

#include <algorithm>

namespace relook {
namespace {

/// Nodes and the sums of them that do not change.
struct SummedNodes {
  const NodeBatch& nodes;
  const NodeSums& sums;

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
            Scratch& scratch) const {
    if (step.op == Op::input && step.payload.input() == Input::sum)
      scratch.at[step.out] = sums.sums().at(step.payload) + first;
    else
      nodes.load(step, first, lanes, parameters, scratch);
  }
};

class SumCompressor {
 public:
  SumCompressor(CompressedBatch& batch, const BoundProgram& bound, const NodeBatch& nodes,
                const ChangingLight& changing, ColorMemory& memory, Baked& baked)
      : batch_(batch),
        split_(*batch.program),
        nodes_(nodes),
        changing_(changing),
        memory_(memory),
        baked_(baked),
        sums_(bound, nodes, memory.sums, memory.scratch) {}

  void compress() {
    batch_.sums.resize(split_.sums.size());
    for (std::size_t sum = 0; sum < split_.sums.size(); ++sum)
      if (split_.sums[sum].changes) {
        compress(sum);
      } else {
        sums_.start(sum);
        sums_.add_all(sum);
      }
    const Parameters parameters{nodes_.scene.scene(), batch_.material};
    batch_.columns =
        stored_columns(split_.constants, parameters, SummedNodes{nodes_, sums_}, batch_.lanes(), memory_.scratch);
    baked_.add(batch_.material, split_.baked.lamps ? with_lamps(split_.baked, nodes_.scene, nodes_.block, nodes_.indices)
                                                   : split_.baked);
  }

 private:
  void compress(std::size_t sum) {
    const SplitSum& split = split_.sums[sum];
    bool is_known = !split.changes_at_first;  // so far
    if (is_known) {
      sums_.start(sum);
      baked_.add(batch_.material, split.read);
    }
    const std::vector<LightId>& order = nodes_.scene.light_order();
    for (std::uint32_t place = 0; place < order.size(); ++place)
      for (const bool filtered : {false, true}) {
        const std::span<const std::uint32_t> lanes = sums_.reached(place, filtered);
        if (lanes.empty()) continue;
        still_.clear();
        tinted_.clear();
        for (const std::uint32_t lane : lanes) (filtered && is_tinted(place, lane) ? tinted_ : still_).push_back(lane);
        const SplitTerm& term = term_of(split, place, filtered, false);
        if (is_known && tinted_.empty() && !term.changes) {
          sums_.add(sum, place, filtered);
          note(term.read, order[place]);
          continue;
        }
        if (is_known) keep_start(sum);
        is_known = false;
        keep_lanes(sum, term, place, still_, false);
        if (!tinted_.empty()) keep_lanes(sum, term_of(split, place, filtered, true), place, tinted_, true);
      }
    if (is_known) keep_start(sum);
  }

  [[nodiscard]] const LightLink& link(std::uint32_t place, std::uint32_t lane) const {
    return nodes_.block.lights[sums_.first_light(lane) + place];
  }
  [[nodiscard]] bool is_tinted(std::uint32_t place, std::uint32_t lane) const {
    const LightLink& light = link(place, lane);
    for (std::uint32_t f = light.first; f < light.first + light.filters; ++f)
      if (changing_.filters[f]) return true;
    return false;
  }
  [[nodiscard]] const SplitTerm& term_of(const SplitSum& split, std::uint32_t place, bool filtered, bool tinted) const {
    const LightId light = nodes_.scene.light_order()[place];
    const std::size_t term = light_term(nodes_.scene.scene().light(light).kind, filtered);
    return split.terms[SplitSum::term(term, changing_.parameters.has(light), tinted)];
  }
  /// Notes what was evaluated with the lamp's parameters.
  void note(Dependencies read, LightId light) {
    if (read.lamps) read.lights = {light};
    baked_.add(batch_.material, read);
  }

  void keep_start(std::size_t sum) {
    StoredColumns start(3, batch_.lanes());
    for (std::size_t channel = 0; channel < 3; ++channel)
      std::copy_n(sums_.sums().at(sum, channel), batch_.lanes(), start.values(channel));
    start.pack();
    batch_.sums[sum].start = std::move(start);
  }
  void keep_lanes(std::size_t sum, const SplitTerm& term, std::uint32_t place, const std::vector<std::uint32_t>& lanes,
                  bool tinted) {
    if (lanes.empty()) return;
    LitLanes& lit = batch_.sums[sum].lit.emplace_back();
    lit.light = nodes_.scene.light_order()[place];
    lit.term = &term;
    lit.lanes = lanes;
    if (tinted)
      for (const std::uint32_t lane : lanes) {
        LightLink slots = link(place, lane);
        slots.first = changing_.filter_slots[slots.first];
        lit.links.push_back(slots);
      }
    lit.columns = StoredColumns(term.constants.outputs.size(), lanes.size());
    if (lit.columns.size() != 0) {
      sums_.run_term(term.constants, place, lanes, [&](std::size_t first, std::size_t some, const auto& run) {
        for (std::size_t k = 0; k < lit.columns.size(); ++k)
          std::copy_n(run.output(k), some, lit.columns.values(k) + first);
      });
      lit.columns.pack();
    }
    note(term.baked, lit.light);
  }

  CompressedBatch& batch_;
  const SplitProgram& split_;
  const NodeBatch& nodes_;
  const ChangingLight& changing_;
  ColorMemory& memory_;
  Baked& baked_;
  NodeSums sums_;
  std::vector<std::uint32_t> still_, tinted_;  // lanes that a lamp reaches
};

}  // namespace

Dependencies with_lamps(Dependencies read, const ColorScene& scene, const TreeBlock& block,
                        std::span<const std::uint32_t> nodes) {
  const std::vector<LightId>& order = scene.light_order();
  for (std::uint32_t place = 0; place < order.size(); ++place)
    if (std::ranges::any_of(nodes, [&](std::uint32_t n) {
          return reaches(block.lights[block.nodes[n].first_light + place].state);
        }))
      read.lights.push_back(order[place]);
  std::ranges::sort(read.lights);
  return read;
}

void compress_sums(CompressedBatch& batch, const BoundProgram& bound, const NodeBatch& nodes,
                   const ChangingLight& changing, ColorMemory& memory, Baked& baked) {
  SumCompressor(batch, bound, nodes, changing, memory, baked).compress();
}

}  // namespace relook
