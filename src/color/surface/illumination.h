// Illumination models as colour expressions: what SHADING.md defines, written once for every pixel. A node's key and
// its material's values of structure in, its colour program out.
#pragma once
#include "color/expression/program.h"
#include "color/surface/node_key.h"

namespace relook {

/// The program of nodes whose keys differ in the material alone, if these materials have this structure.
[[nodiscard]] ColorProgram build_program(const Scene& scene, const MaterialStructure& structure, const NodeKey& key);

}  // namespace relook
