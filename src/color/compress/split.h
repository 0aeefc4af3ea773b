// Partial evaluation of colour programs (paper 3.3): what a set of changing leaves cannot alter becomes stored columns,
// one value a sample; a residual program keeps the chain from these leaves to the result. No operation is
// re-associated, so the residual yields the program's bits. Called by SplitTable (compressed_block.h).
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
  bool ambient = false, environment = false;
  BranchSet children;  // colours of child rays
  WideLightSet tints;  // lights whose filters' colours change
  auto operator<=>(const ChangingLeaves&) const = default;
};

struct SplitProgram {
  Kernel constants;    // outputs: the columns
  Kernel residual;     // reads the columns (Op::column); outputs: R, G, B, A
  Dependencies baked;  // parameters that the columns were evaluated with
};

[[nodiscard]] SplitProgram split(const ColorProgram& program, const ChangingLeaves& leaves);

}  // namespace relook
