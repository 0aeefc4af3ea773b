// Three axes about a surface's normal: directions of the world in, local ones out, and back. Lobes are sampled in local
// directions: x and y along the surface, z along its normal.
#pragma once
#include <cmath>

#include "physics/scalar.h"

namespace relook {

/// Of length 1, at right angles, right-handed.
struct Basis {
  Direction x, y;
  Normal z;

  [[nodiscard]] Direction to_local(const Direction& d) const { return {d.dot(x), d.dot(y), d.dot(z)}; }
  [[nodiscard]] Direction to_world(const Direction& d) const { return x * d.x + y * d.y + z * d.z; }
};

/// About a normal of length 1 (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
[[nodiscard]] inline Basis basis_about(const Normal& n) {
  const float sign = std::copysign(1.0F, n.z);
  const float a = -1.0F / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// Its x axis is the part of `along` that lies in the surface; any where `along` has next to none.
[[nodiscard]] inline Basis basis_along(const Normal& n, const Direction& along) {
  const Direction flat = along - n * along.dot(n);
  const float length2 = flat.dot(flat);
  if (!(length2 > 1e-6F * along.dot(along)) || !(length2 > 1e-30F)) return basis_about(n);
  // Of a nearly parallel axis much of what is left is rounding, so it is laid flat once more.
  const Direction tilted = flat / std::sqrt(length2);
  const Direction x = normalized(tilted - n * tilted.dot(n));
  return {x, n.cross(x), n};
}

}  // namespace relook
