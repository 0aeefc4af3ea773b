#include "scene/compile/compile_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/look/look_schema.h"

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

using Vector = Imath::V3d;

/// Where the three axes go.
std::array<Vector, 3> rows_of(const Transform& m) {
  std::array<Vector, 3> rows;
  for (std::size_t row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[row][column] = static_cast<double>(m[static_cast<int>(row)][column]);
  return rows;
}

/// A vector perpendicular to all three, which lie in a plane.
Vector largest_cross(const std::array<Vector, 3>& vectors) {
  Vector largest(0, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector cross = vectors[i].cross(vectors[(i + 1) % 3]);
    if (cross.length2() > largest.length2()) largest = cross;
  }
  return largest;
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

int dimensions_of(const Transform& to_world) {
  constexpr double kLeastRow = 1e-12, kLeastSkewness = 1e-9;
  const std::array<Vector, 3> rows = rows_of(to_world);
  double product = 1;
  int long_rows = 0;
  for (const Vector& row : rows) {
    const double length = row.length();
    if (length > kLeastRow) ++long_rows;
    product *= length;
  }
  if (long_rows == 3 && std::abs(rows[0].dot(rows[1].cross(rows[2]))) > kLeastSkewness * product) return 3;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &a = rows[i], &b = rows[(i + 1) % 3];
    if (a.length() > kLeastRow && b.length() > kLeastRow &&
        a.cross(b).length() > kLeastSkewness * a.length() * b.length())
      return 2;
  }
  return long_rows > 0 ? 1 : 0;
}

SheetTransform sheet_transform(const Transform& to_world) {
  const std::array<Vector, 3> rows = rows_of(to_world);
  std::array<Vector, 3> columns;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      columns[static_cast<std::size_t>(column)][row] = rows[static_cast<std::size_t>(row)][column];
  const Vector lost = largest_cross(columns).normalized();   // in object space
  const Vector across = largest_cross(rows).normalized();  // of the sheet, in the world
  double size = 0;
  for (const Vector& row : rows) size = std::max(size, row.length());
  SheetTransform sheet;
  WideTransform filled = widened(to_world);
  for (int row = 0; row < 3; ++row) {
    const Vector kept = rows[static_cast<std::size_t>(row)];
    for (int column = 0; column < 3; ++column) {
      sheet.flatten[row][column] =
          static_cast<float>((row == column ? 1.0 : 0.0) - lost[row] * lost[column]) + 0.0F;
      filled[row][column] = kept[column] + lost[row] * across[column] * size;
    }
  }
  sheet.to_world = rounded(filled, WidePoint(0, 0, 0));
  const std::array<Vector, 3> whole = rows_of(sheet.to_world);
  if (whole[0].dot(whole[1].cross(whole[2])) > 0) return sheet;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      filled[row][column] -= 2 * lost[row] * across[column] * size;
  sheet.to_world = rounded(filled, WidePoint(0, 0, 0));
  return sheet;
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
