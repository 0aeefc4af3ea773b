#include "scene/texture/texture_mapping.h"

#include <cmath>

#include "base/portable_math.h"

namespace relook {
namespace {

/// Coordinates over the mesh's bounds, in [0, 1] within them; the axis `axis` comes last.
Point bounds_coordinates(const Mesh& mesh, const Point& local, int axis) {
  const Point size = mesh.bounds.size();
  Point unit;
  for (int i = 0; i < 3; ++i) unit[i] = size[i] > 0 ? (local[i] - mesh.bounds.min[i]) / size[i] : 0.5F;
  return Point(unit[(axis + 1) % 3], unit[(axis + 2) % 3], unit[axis]);
}

}  // namespace

Point projected_coordinates(const Mesh& mesh, const Point& local, Mapping mapping, int axis) {
  const Point unit = bounds_coordinates(mesh, local, axis);
  if (mapping == Mapping::planar) return Point(unit.x, unit.y, 0);
  const Direction centred = unit * 2.0F - Point(1, 1, 1);
  const float around = portable_atan2_turns(centred.y, centred.x) + 0.5F;
  if (mapping == Mapping::cylindrical) return Point(around, 1.0F - unit.z, 0);
  const float length = std::sqrt(centred.dot(centred));
  return Point(around, 0.5F - 2.0F * portable_asin_turns(length > 0 ? centred.z / length : 0), 0);
}

}  // namespace relook
