// Node transforms of a look document in double precision: composed root to leaf and rounded to float once, so that an
// incremental compilation gives the same bits as one from scratch.
#pragma once
#include <string>
#include <string_view>

#include "base/json.h"
#include "base/math.h"

namespace relook {

using WideTransform = Imath::M44d;

/// The local matrix of a node that passed the schema. Throws LookError for what types and ranges cannot tell: a zero
/// quaternion, a matrix that is not affine, a matrix beside translation, rotation or scale.
[[nodiscard]] WideTransform local_transform(const Json& node, std::string_view file, const std::string& pointer);

/// Every entry finite and at most 1e12: what rays can work with.
[[nodiscard]] bool is_in_range(const WideTransform& world);

/// False for transforms that flatten a mesh to nothing (a scale of 0): it cannot be seen, and has no inverse.
[[nodiscard]] bool is_invertible(const Transform& to_world);

/// Relative to `eye`.
[[nodiscard]] Transform rounded(const WideTransform& world, const WidePoint& eye);
[[nodiscard]] WideTransform widened(const Transform& local);

}  // namespace relook
