#include "scene/compile/tangents.h"

#include <bit>
#include <cmath>
#include <unordered_map>

namespace relook {
namespace {

using Wide = Imath::V3d;

/// The bits of a vertex's position, normal and texture coordinates: vertices with the same key are one.
using VertexKey = std::array<std::uint32_t, 8>;
struct VertexKeyHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key) hash = (std::rotl(hash, 5) ^ word) * 0x9E3779B97F4A7C15ULL;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

VertexKey key_of(const Mesh& mesh, std::uint8_t texcoord, std::uint32_t vertex) {
  const Point& p = mesh.positions[vertex];
  const Normal& n = mesh.normals[vertex];
  const Uv& uv = mesh.uv[texcoord][vertex];
  const std::array<float, 8> values{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
  VertexKey key;
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = std::bit_cast<std::uint32_t>(values[i] + 0.0F);  // never -0
  return key;
}

/// [vertices]: the first vertex with the same key.
std::vector<std::uint32_t> shared_vertices(const Mesh& mesh, std::uint8_t texcoord) {
  std::vector<std::uint32_t> shared(mesh.positions.size());
  std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> known;
  known.reserve(shared.size());
  for (std::uint32_t vertex = 0; vertex < shared.size(); ++vertex)
    shared[vertex] = known.try_emplace(key_of(mesh, texcoord, vertex), vertex).first->second;
  return shared;
}

Wide unit_or_zero(const Wide& v) {
  const double length = v.length();
  return length > 1e-30 ? v / length : Wide(0, 0, 0);
}

/// `v` laid into the plane across a unit normal, as a unit vector or zero.
Wide across(const Wide& v, const Wide& normal) { return unit_or_zero(v - normal * normal.dot(v)); }

double angle_between(const Wide& a, const Wide& b) { return std::acos(std::fmin(std::fmax(a.dot(b), -1.0), 1.0)); }

/// The direction of u on a triangle in object space, zero where the triangle has no area in space or in the texture;
/// and whether the texture lies mirrored on it.
struct Axis {
  Wide along_u{0, 0, 0};
  bool is_mirrored = false;
};
Axis axis_of(const std::array<Wide, 3>& p, const std::array<Uv, 3>& uv) {
  const Imath::V2d a = Imath::V2d(uv[1]) - Imath::V2d(uv[0]), b = Imath::V2d(uv[2]) - Imath::V2d(uv[0]);
  const double area = a.x * b.y - a.y * b.x;
  const Wide gradient = (p[1] - p[0]) * b.y - (p[2] - p[0]) * a.y;
  return {area == 0 ? Wide(0, 0, 0) : unit_or_zero(area < 0 ? -gradient : gradient), area < 0};
}

}  // namespace

CornerTangents derive_tangents(const Mesh& mesh, std::uint8_t texcoord) {
  const std::vector<std::uint32_t> shared = shared_vertices(mesh, texcoord);
  // Two places a vertex, one for each handedness.
  std::vector<Wide> sums(2 * shared.size(), Wide(0, 0, 0));
  CornerTangents result;
  result.corners.resize(mesh.triangles.size());
  std::vector<bool> has_axis(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    std::array<Wide, 3> p;
    std::array<Uv, 3> uv;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = Wide(mesh.positions[triangle[i]]);
      uv[i] = mesh.uv[texcoord][triangle[i]];
    }
    const Axis axis = axis_of(p, uv);
    has_axis[t] = axis.along_u != Wide(0, 0, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t place = 2 * shared[triangle[i]] + (axis.is_mirrored ? 1U : 0U);
      result.corners[t][i] = place;
      if (!has_axis[t]) continue;
      const Wide normal(mesh.normals[triangle[i]]);
      const double angle = angle_between(across(p[(i + 1) % 3] - p[i], normal), across(p[(i + 2) % 3] - p[i], normal));
      sums[place] += across(axis.along_u, normal) * angle;
    }
  }
  // Triangles without an axis take their neighbours'.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t& place : result.corners[t])
      if (!has_axis[t] && sums[place] == Wide(0, 0, 0)) place ^= 1U;
  result.tangents.reserve(sums.size());
  for (std::size_t place = 0; place < sums.size(); ++place) {
    const Point tangent(unit_or_zero(sums[place]));
    // v runs down the image: triangles that are not mirrored have negative areas.
    result.tangents.emplace_back(tangent.x, tangent.y, tangent.z, place % 2 == 1 ? 1.0F : -1.0F);
  }
  return result;
}

}  // namespace relook
