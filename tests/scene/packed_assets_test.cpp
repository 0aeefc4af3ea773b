// Compressed files that others made: the same meshes as without compression but for its rounding. Skips without
// ../shared/assets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <ostream>

#include "scene/gltf/import.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kAssets = fs::path(RELOOK_SOURCE_DIR) / ".." / "shared" / "assets";

struct Pair {
  const char *packed, *plain;  // below kAssets
};
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.packed; }

class PackedAssets : public testing::TestWithParam<Pair> {};

/// The largest distance from a point of one mesh to the nearest of the other; by a grid of cells of `reach`.
double largest_distance(const std::vector<Point>& from, const std::vector<Point>& to, float reach) {
  std::map<std::array<int, 3>, std::vector<Point>> cells;
  const auto cell = [&](const Point& p, int dx, int dy, int dz) {
    return std::array<int, 3>{static_cast<int>(std::floor(p.x / reach)) + dx,
                              static_cast<int>(std::floor(p.y / reach)) + dy,
                              static_cast<int>(std::floor(p.z / reach)) + dz};
  };
  for (const Point& p : to) cells[cell(p, 0, 0, 0)].push_back(p);
  double largest = 0;
  for (const Point& p : from) {
    double nearest = 1e30;
    for (int i = 0; i < 27; ++i)
      if (const auto found = cells.find(cell(p, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)); found != cells.end())
        for (const Point& q : found->second) nearest = std::min(nearest, static_cast<double>((p - q).length()));
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// The areas of all triangles as seen along each axis, added up: a lost or displaced triangle changes them.
Imath::V3d seen_areas(const Mesh& mesh) {
  Imath::V3d sum(0);
  for (const auto& corners : mesh.triangles) {
    const Imath::V3d a(mesh.positions[corners[0]]), b(mesh.positions[corners[1]]), c(mesh.positions[corners[2]]);
    const Imath::V3d area = (b - a).cross(c - a);
    sum += Imath::V3d(std::abs(area.x), std::abs(area.y), std::abs(area.z));
  }
  return sum;
}

TEST_P(PackedAssets, are_their_plain_twins_but_for_rounding) {
  if (!fs::exists(kAssets)) GTEST_SKIP() << "no ../shared/assets beside the project: compressed files are NOT tested";
  const ImportedGltf packed = import_gltf(kAssets / GetParam().packed), plain = import_gltf(kAssets / GetParam().plain);
  ASSERT_EQ(packed.meshes.size(), plain.meshes.size());
  for (std::size_t m = 0; m < plain.meshes.size(); ++m) {
    ASSERT_EQ(packed.meshes[m].size(), plain.meshes[m].size()) << "mesh " << m;
    for (std::size_t p = 0; p < plain.meshes[m].size(); ++p) {
      const Mesh &a = packed.meshes[m][p], &b = plain.meshes[m][p];
      SCOPED_TRACE("mesh " + std::to_string(m) + ", primitive " + std::to_string(p));
      const float reach = b.bounds.size().length() / 512;  // positions of 10 bits and more
      EXPECT_LE(a.triangles.size(), b.triangles.size());
      EXPECT_GE(a.triangles.size(), b.triangles.size() * 99 / 100) << "triangles without area may be lost";
      EXPECT_LE(largest_distance(a.positions, b.positions, reach), reach);
      EXPECT_LE(largest_distance(b.positions, a.positions, reach), reach);
      EXPECT_LE((seen_areas(a) - seen_areas(b)).length(), 0.02 * seen_areas(b).length());
      EXPECT_EQ(a.normals.empty(), b.normals.empty());
      EXPECT_EQ(a.targets.size(), b.targets.size());
      EXPECT_EQ(a.joints.empty(), b.joints.empty());
      for (std::size_t set = 0; set < a.uv.size(); ++set) EXPECT_EQ(a.uv[set].empty(), b.uv[set].empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, PackedAssets,
    testing::Values(Pair{"chess-board-draco/chess-board.glb", "chess-board-decoded/chess-board.glb"},
                    Pair{"khronos-more/Box/glTF-Draco/Box.gltf", "khronos-more/Box/glTF-Binary/Box.glb"},
                    Pair{"khronos-more/CesiumMan/glTF-Draco/CesiumMan.gltf",
                         "khronos-more/CesiumMan/glTF-Binary/CesiumMan.glb"},
                    Pair{"khronos-more/CesiumMilkTruck/glTF-Draco/CesiumMilkTruck.gltf",
                         "khronos-more/CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb"},
                    Pair{"khronos-more/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf",
                         "khronos-more/MorphPrimitivesTest/glTF-Binary/MorphPrimitivesTest.glb"},
                    Pair{"khronos-small/Duck/glTF-Draco/Duck.gltf", "duck-ktx2/glTF/Duck.gltf"}));

}  // namespace
}  // namespace relook
