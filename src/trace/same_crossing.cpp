#include "trace/same_crossing.h"

#include <algorithm>
#include <array>

namespace relook {
namespace {

/// The triangle's positions.
std::array<Point, 3> corners(const Mesh& mesh, std::uint32_t primitive) {
  const auto& triangle = mesh.triangles[primitive];
  return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

bool is_at_edge(const Hit& hit) {
  constexpr float kWidth = 0x1p-17F;
  return std::min(std::min(hit.u, hit.v), 1 - hit.u - hit.v) <= kWidth;
}

}  // namespace

bool is_same_crossing(const RayObject& object, const Hit& a, const Hit& b, const Direction& travel) {
  if (!is_at_edge(a) || !is_at_edge(b)) return false;
  const auto of_a = corners(*object.mesh, a.primitive), of_b = corners(*object.mesh, b.primitive);
  const auto shared = std::ranges::count_if(of_a, [&](const Point& p) { return std::ranges::count(of_b, p) > 0; });
  if (shared == 0 || shared == 3) return false;
  const auto faces = [&](const std::array<Point, 3>& p) {
    return ((p[1] - p[0]).cross(p[2] - p[0]) * object.normal_to_world).dot(travel) > 0;
  };
  return faces(of_a) == faces(of_b);
}

}  // namespace relook
