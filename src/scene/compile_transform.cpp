#include "scene/compile_transform.h"

#include <cmath>

#include "scene/look_schema.h"

namespace relook {
namespace {

template <std::size_t Count>
std::array<double, Count> numbers(const Json& node, std::string_view key, std::array<double, Count> fallback) {
  const auto found = node.find(key);
  if (found == node.end()) return fallback;
  std::array<double, Count> values{};
  for (std::size_t i = 0; i < Count; ++i) values[i] = (*found)[i].template get<double>();
  return values;
}

/// glTF matrices are column-major with column vectors: the same sixteen numbers as row-major with row vectors.
WideTransform matrix_of(const Json& node, std::string_view file, const std::string& pointer) {
  for (const char* key : {"translation", "rotation", "scale"})
    if (node.contains(key))
      throw LookError(file, pointer + "/" + key, "a node has either a matrix or translation, rotation and scale");
  const auto m = numbers<16>(node, "matrix", {});
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    throw LookError(file, pointer + "/matrix", "the matrix is not affine: its last row must be 0, 0, 0, 1");
  WideTransform matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[row][column] = m[static_cast<std::size_t>(row * 4 + column)];
  return matrix;
}

}  // namespace

WideTransform local_transform(const Json& node, std::string_view file, const std::string& pointer) {
  if (node.contains("matrix")) return matrix_of(node, file, pointer);
  const auto t = numbers<3>(node, "translation", {0, 0, 0});
  const auto s = numbers<3>(node, "scale", {1, 1, 1});
  const auto q = numbers<4>(node, "rotation", {0, 0, 0, 1});
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-9)) throw LookError(file, pointer + "/rotation", "a rotation must not be the zero quaternion");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  // Row vectors: row i is where the i-th axis goes.
  return {s[0] * (1 - 2 * (y * y + z * z)),
          s[0] * (2 * (x * y + z * w)),
          s[0] * (2 * (x * z - y * w)),
          0,
          s[1] * (2 * (x * y - z * w)),
          s[1] * (1 - 2 * (x * x + z * z)),
          s[1] * (2 * (y * z + x * w)),
          0,
          s[2] * (2 * (x * z + y * w)),
          s[2] * (2 * (y * z - x * w)),
          s[2] * (1 - 2 * (x * x + y * y)),
          0,
          t[0],
          t[1],
          t[2],
          1};
}

bool is_in_range(const WideTransform& world) {
  constexpr double kMost = 1e12;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      if (!(std::abs(world[row][column]) <= kMost)) return false;
  return true;
}

bool is_invertible(const Transform& to_world) {
  constexpr double kLeastRow = 1e-12, kLeastSkewness = 1e-9;
  Imath::V3d rows[3];
  for (int row = 0; row < 3; ++row)
    rows[row] = Imath::V3d(static_cast<double>(to_world[row][0]), static_cast<double>(to_world[row][1]),
                           static_cast<double>(to_world[row][2]));
  double product = 1;
  for (const Imath::V3d& row : rows) {
    const double length = std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z);
    if (!(length > kLeastRow)) return false;
    product *= length;
  }
  const double determinant = rows[0].dot(rows[1].cross(rows[2]));
  return std::abs(determinant) > kLeastSkewness * product;
}

Transform rounded(const WideTransform& in_world, const WidePoint& eye) {
  WideTransform world = in_world;
  for (int axis = 0; axis < 3; ++axis) world[3][axis] -= eye[axis];
  Transform result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      result[row][column] = static_cast<float>(world[row][column]) + 0.0F;  // never -0
  return result;
}

WideTransform widened(const Transform& local) {
  WideTransform result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result[row][column] = static_cast<double>(local[row][column]);
  return result;
}

}  // namespace relook
