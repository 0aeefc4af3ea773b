// Partial evaluation of colour programs (paper 3.3): what a set of changing leaves cannot alter becomes stored columns,
// one value a sample; a residual program keeps the chain from these leaves to the result. No operation is
// re-associated, so the residual yields the program's bits. A program with sums is split piece by piece: columns of a
// node, and columns of what a lamp adds to it. Called by SplitTable (compressed_block.h).
#pragma once
#include <vector>

#include "color/expression/program.h"
#include "trace/tree/branch.h"
#include "trace/tree/light_set.h"

namespace relook {

/// Leaves whose values may differ from one evaluation to the next.
struct ChangingLeaves {
  FieldMask fields = 0;         // of the node's material, none of kMappingMask: where textures are looked up is fixed
  std::vector<LightId> lights;  // their colour parameters
  bool lamps = false;           // those of some of the lamps that reach the node
  bool ambient = false, environment = false;
  BranchSet children;  // colours of child rays
  WideLightSet tints;  // lights whose filters' colours change; of a program with sums: any if not empty
  auto operator<=>(const ChangingLeaves&) const = default;
};

/// What a lamp adds to a sum.
struct SplitTerm {
  bool changes = false;
  Kernel constants;    // outputs: its columns; reads the columns of Pieces and the lamp at hand
  Kernel residual;     // reads columns, of the node first, then its own; outputs: R, G, B
  Dependencies baked;  // parameters that its columns were evaluated with
  Dependencies read;   // all parameters; `lamps`: those of the lamp at hand
};

struct SplitSum {
  bool changes = false;           // with or without its lamps
  bool changes_at_first = false;  // without them
  Kernel stage;                   // changes_at_first: reads columns of the node; outputs: the sum without lamps
  Dependencies read;              // otherwise: the parameters of the sum without lamps
  std::vector<SplitTerm> terms;   // changes: by term(); there are those that may occur

  /// Does the lamp at hand change, do filters before it?
  [[nodiscard]] static constexpr std::size_t term(std::size_t light_term, bool lamp, bool tint) {
    return 4 * light_term + (lamp ? 2U : 0U) + (tint ? 1U : 0U);
  }
};

struct SplitProgram {
  Kernel constants;    // outputs: the columns
  Kernel residual;     // reads the columns (Op::column); outputs: R, G, B, A
  Dependencies baked;  // parameters that the columns were evaluated with; `lamps`: of all lamps that reach the node
  std::vector<SplitSum> sums;
};

[[nodiscard]] SplitProgram split(const ColorProgram& program, const ChangingLeaves& leaves);

}  // namespace relook
