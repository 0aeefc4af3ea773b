// What the programs of the path integrator depend on beside the values of a material: how the ray met the surface, its
// branches, and which of its pieces is asked for.
#pragma once
#include <compare>
#include <cstdint>

#include "base/id.h"
#include "trace/tree/branch.h"

namespace relook {

/// The pieces that a path is put together of. A program yields columns of three channels, in this order:
///   surface  the weight of each branch of `children`, in the order of Branch; what of its emission gets out; ambient
///            light; the colour of an unlit surface; coverage (in all three). If it is lit there follow, as single
///            channels, the values that `light` reads as Op::column: what of it no light changes, textures above all
///   light    what a lit surface makes of a sample of a light
///   filter   the share of light that passes
enum class PathPiece : std::uint8_t { surface, light, filter };

/// Pieces with equal keys share a program and its parameters. `light` reads the same columns of all surfaces that
/// differ in `gathers` and `children` alone, of which its key has none.
struct PathKey {
  PathPiece piece = PathPiece::surface;
  MaterialId material;
  bool inside = false, vertex_colors = false;
  bool interface_only = false;  // the inner side of a volume
  bool gathers = false;         // surface: what it scatters does not count
  bool blurs = false;           // what goes through is scattered by a lobe
  bool lit = false;             // surface: its columns for lights are wanted
  BranchSet children;           // surface
  auto operator<=>(const PathKey&) const = default;
};

}  // namespace relook
