// Runs a program in pieces (pieces.h) over a batch of nodes: the columns of all nodes, and for each sum the light of one
// lamp after the other, over the lanes that it reaches. A lane's additions are those of a program for the lamps that
// reach its node, in the same order. Called by evaluate() and, for what an edit does not change, by compressing.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "color/expression/lanes.h"
#include "color/expression/program.h"

namespace relook {

struct NodeBatch;
struct BoundProgram;

/// Working memory, reused between calls.
struct SumMemory {
  std::vector<float> columns;  // of nodes, one after the other
  std::vector<float> sums;     // R, G, B of each sum
  std::vector<std::uint32_t> first_lights;         // [nodes] RayNode::first_light
  std::vector<std::vector<std::uint32_t>> reached; // [2 * lamps] lanes that a lamp reaches, unfiltered and filtered
};

/// Sums of the nodes of a batch, with room for whole vectors: R, G, B of one sum after the other.
class SumColumns {
 public:
  SumColumns(std::vector<float>& memory, std::size_t sums, std::size_t lanes)
      : stride_(whole_vectors(lanes)), values_(memory) {
    values_.resize(std::max(values_.size(), sums * 3 * stride_));
  }
  [[nodiscard]] float* at(std::size_t sum, std::size_t channel) { return values_.data() + (3 * sum + channel) * stride_; }
  [[nodiscard]] const float* at(std::size_t sum, std::size_t channel) const {
    return values_.data() + (3 * sum + channel) * stride_;
  }
  [[nodiscard]] const float* at(Payload input) const { return at(input.which(), input.axis()); }
  /// Adds R, G, B of a kernel that has run over some of `lanes`, from `first` on.
  template <class Run>
  void add(std::size_t sum, std::span<const std::uint32_t> lanes, const Run& run) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      float* to = at(sum, channel);
      const float* added = run.output(channel);
      for (std::size_t k = 0; k < lanes.size(); ++k) to[lanes[k]] += added[k];
    }
  }

 private:
  std::size_t stride_;
  std::vector<float>& values_;
};

class NodeSums {
 public:
  /// Evaluates the columns of the nodes. Requires: the program has sums. All arguments outlive it.
  NodeSums(const BoundProgram& bound, const NodeBatch& nodes, SumMemory& memory, Scratch& scratch);

  /// The three, in this order: a sum before any lamp, with the light of a lamp, and with that of all.
  void start(std::size_t sum);
  void add(std::size_t sum, std::uint32_t place, bool filtered);
  void add_all(std::size_t sum);
  /// Calls take(first, lanes, run) with R, G, B, A of the nodes, a few at a time. Requires: all sums are there.
  template <class Take>
  void finish(const Take& take) {
    run_stage(program_.sums.size(), take);
  }

  [[nodiscard]] const SumColumns& sums() const { return sums_; }
  /// Lanes that a lamp reaches, increasing. `place`: in the light order.
  [[nodiscard]] std::span<const std::uint32_t> reached(std::uint32_t place, bool filtered) const {
    return memory_.reached[2 * place + (filtered ? 1 : 0)];
  }
  [[nodiscard]] std::uint32_t first_light(std::uint32_t lane) const { return memory_.first_lights[lane]; }
  /// Runs a kernel that reads the pieces' columns, and a lamp at hand, over some lanes: take(first, lanes, run).
  template <class Take>
  void run_term(const Kernel& kernel, std::uint32_t place, std::span<const std::uint32_t> lanes, const Take& take) {
    KernelRun run(kernel, parameters_of(place), TermLanes{*this, place, lanes}, lanes.size(), scratch_);
    for (std::size_t first = 0; first < lanes.size(); first += kLanes) {
      const std::size_t some = std::min(kLanes, lanes.size() - first);
      run.run(first, some);
      take(first, some, run);
    }
  }

 private:
  struct StageLanes {
    const NodeSums& owner;
    void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const;
  };
  struct TermLanes {
    const NodeSums& owner;
    std::uint32_t place;
    std::span<const std::uint32_t> chosen;
    void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const;
  };

  [[nodiscard]] Parameters parameters_of(std::uint32_t place) const;
  void find_reached();
  [[nodiscard]] const float* column(std::uint32_t k) const { return memory_.columns.data() + k * stride_; }
  template <class Take>
  void run_stage(std::size_t stage, const Take& take) {
    const StageLanes source{*this};
    KernelRun run(program_.pieces.stages[stage], parameters_, source, lanes_, scratch_);
    for (std::size_t first = 0; first < lanes_; first += kLanes) {
      const std::size_t some = std::min(kLanes, lanes_ - first);
      run.run(first, some);
      take(first, some, run);
    }
  }

  const ColorProgram& program_;
  Parameters parameters_;
  const NodeBatch& nodes_;
  SumMemory& memory_;
  Scratch& scratch_;
  std::size_t lanes_, stride_;
  SumColumns sums_;
};

}  // namespace relook
