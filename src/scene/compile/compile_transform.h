// Node transforms of a look document in double precision: composed root to leaf and rounded to float once, so that an
// incremental compilation gives the same bits as one from scratch. Called by the compiler, look_bounds.h and, for
// sheets, trace/ray_scene.cpp.
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

/// What a transform makes of a mesh: 3, a body; 2, a sheet (a scale of 0 along one axis); less, a line or a point,
/// which cannot be seen.
[[nodiscard]] int dimensions_of(const Transform& to_world);

/// A transform that flattens, in two parts: `flatten` within object space, along what the transform loses, and an
/// invertible `to_world` that does the same to what is flat. Front faces are those that are counter-clockwise in the
/// world (glTF 2.0 section 3.7.4: only a negative determinant turns them around).
struct SheetTransform {
  Transform flatten, to_world;
};
/// Requires: dimensions_of(to_world) == 2.
[[nodiscard]] SheetTransform sheet_transform(const Transform& to_world);

/// To floats, with the translation counted from `eye`; and back to doubles.
[[nodiscard]] Transform rounded(const WideTransform& world, const WidePoint& eye);
[[nodiscard]] WideTransform widened(const Transform& local);

}  // namespace relook
