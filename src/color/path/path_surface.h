// Surfaces as the path integrator sees them, as colour expressions: PATH.md in code. A node's key in, columns of its
// program out (path_key.h says which). The lobes are those of the Whitted integrator (color/surface).
#pragma once
#include <vector>

#include "color/path/path_key.h"
#include "color/surface/surface_terms.h"

namespace relook {

using PathColumns = std::vector<Triple>;

[[nodiscard]] PathColumns path_columns(SurfaceTerms& terms, const PathKey& key);

}  // namespace relook
