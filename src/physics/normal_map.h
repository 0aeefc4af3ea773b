// Normal maps (glTF 2.0, 3.9.3): the frame of a map at a hit and a texel of it in, the shading normal out.
#pragma once
#include "physics/scalar.h"

namespace relook {

/// The axes of a map, for the front of the surface: unit vectors, or zero where the mesh gives none.
template <class V>
struct MapAxes {
  V tangent, bitangent;
};

/// What a map bends: normals on the side of the incoming ray.
template <class V>
struct UnmappedNormals {
  V smooth, geometric;
  bool inside = false;  // the back of the surface was met: the map bends the front's normal, and all is turned round
};

/// `texel`: of the map, [0, 1]; `scale`: its strength. `unit`(vector, normal of the front): the vector with length 1.
/// Where the bent normal would lie below the geometric surface, the smooth one is returned as it is.
template <class V, class Unit>
[[nodiscard]] V mapped_normal(const MapAxes<V>& axes, const UnmappedNormals<V>& normals, const V& texel,
                              ScalarOf<V> scale, const Unit& unit) {
  using S = ScalarOf<V>;
  const V front = normals.inside ? normals.smooth * -1.0F : normals.smooth;
  const S x = (texel.x * 2.0F - 1.0F) * scale, y = (texel.y * 2.0F - 1.0F) * scale, z = texel.z * 2.0F - 1.0F;
  const V bent = unit(axes.tangent * x + axes.bitangent * y + front * z, front);
  const V turned = normals.inside ? bent * -1.0F : bent;
  return if_positive(dot(turned, normals.geometric), turned, normals.smooth);
}

}  // namespace relook
