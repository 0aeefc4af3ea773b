#include "scene/compile/displacement.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "scene/texture/procedural.h"
#include "scene/texture/texture.h"
#include "scene/texture/texture_mapping.h"

namespace relook {
namespace {

Normal unit_or_zero(const Normal& n) {
  const float largest = std::max({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)});
  if (!(largest > 0)) return {0, 0, 0};
  const Normal scaled = n / largest;
  return scaled / std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

/// [vertices]: the first vertex at the same position, whatever its uv.
std::vector<std::uint32_t> welded(const std::vector<Point>& positions) {
  struct Hash {
    std::size_t operator()(const Point& p) const {
      std::size_t hash = 0;
      for (int i = 0; i < 3; ++i) hash = hash * 0x9E3779B97F4A7C15ULL + std::hash<float>()(p[i]);
      return hash ^ (hash >> 29U);
    }
  };
  std::unordered_map<Point, std::uint32_t, Hash> first;
  std::vector<std::uint32_t> weld(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) weld[i] = first.try_emplace(positions[i], i).first->second;
  return weld;
}

/// Area-weighted normals, shared by the vertices that `weld` puts together.
std::vector<Normal> averaged_normals(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
  std::vector<Normal> sums(mesh.positions.size(), Normal(0, 0, 0));
  for (const auto& triangle : mesh.triangles) {
    const Point& a = mesh.positions[triangle[0]];
    const Normal area = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    for (std::uint32_t vertex : triangle) sums[weld[vertex]] += area;
  }
  std::vector<Normal> normals(mesh.positions.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = unit_or_zero(sums[weld[i]]);
  return normals;
}

template <class Value>
void append_middle(std::vector<Value>& column, std::uint32_t a, std::uint32_t b) {
  if (!column.empty()) column.push_back((column[a] + column[b]) * 0.5F);
}

/// The vertex in the middle of an edge, made on first use.
class Midpoints {
 public:
  explicit Midpoints(Mesh& mesh) : mesh_(mesh) {}

  std::uint32_t between(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
    const auto [vertex, is_new] = vertices_.try_emplace(edge, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) append(std::min(a, b), std::max(a, b));
    return vertex->second;
  }

 private:
  void append(std::uint32_t a, std::uint32_t b) {
    append_middle(mesh_.positions, a, b);
    append_middle(mesh_.normals, a, b);
    if (!mesh_.normals.empty()) mesh_.normals.back() = unit_or_zero(mesh_.normals.back());
    append_middle(mesh_.tangents, a, b);
    for (auto& uv : mesh_.uv) append_middle(uv, a, b);
    append_middle(mesh_.colors, a, b);
  }

  Mesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

/// One round of 1-to-4 subdivision; triangle i becomes 4i .. 4i + 3.
void subdivide(Mesh& mesh) {
  Midpoints midpoints(mesh);
  std::vector<std::array<std::uint32_t, 3>> finer;
  finer.reserve(mesh.triangles.size() * 4);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = midpoints.between(a, b), bc = midpoints.between(b, c), ca = midpoints.between(c, a);
    finer.push_back({a, ab, ca});
    finer.push_back({ab, b, bc});
    finer.push_back({ca, bc, c});
    finer.push_back({ab, bc, ca});
  }
  mesh.triangles = std::move(finer);
}

float height_at(const Mesh& mesh, const TextureSlot& slot, Mapping mapping, std::uint32_t vertex) {
  const Point at = vertex_coordinates(mesh, slot, mapping, vertex);
  if (slot.kind == TextureKind::none) return 1;
  if (slot.kind == TextureKind::image) return sample(*slot.pyramid, transformed_uv(slot, at), 0, slot.sampler).r;
  if (mapping == Mapping::solid) return evaluate(slot.procedural, at).r;
  const Uv uv = transformed_uv(slot, at);
  return evaluate(slot.procedural, Point(uv.x, uv.y, 0)).r;
}

}  // namespace

std::size_t displaced_triangles(const Mesh& mesh, const Displacement& displacement) {
  return mesh.triangles.size() << static_cast<unsigned>(2 * displacement.subdivide);
}

Mesh displaced(const Mesh& mesh, const Displacement& displacement) {
  require(displaced_triangles(mesh, displacement) <= kMostDisplacedTriangles, "the compiler limits subdivision");
  Mesh result = mesh;
  result.targets.clear(), result.joints.clear(), result.joint_weights.clear();
  for (std::int32_t round = 0; round < displacement.subdivide; ++round) subdivide(result);
  const std::vector<std::uint32_t> weld = welded(result.positions);
  const bool is_smooth = !result.normals.empty();
  const std::vector<Normal> along = is_smooth ? result.normals : averaged_normals(result, weld);
  const Mapping mapping = effective_mapping(result, displacement.texture);
  std::vector<Point> moved = result.positions;
  for (std::uint32_t i = 0; i < moved.size(); ++i) {
    const float height = height_at(result, displacement.texture, mapping, i) - displacement.midlevel;
    moved[i] += along[i] * (displacement.scale * height);
  }
  result.positions = std::move(moved);
  if (is_smooth) {
    // Fresh normals, shared across seams only where the old ones agreed: hard edges stay hard.
    std::vector<std::uint32_t> smooth_weld = weld;
    for (std::uint32_t i = 0; i < weld.size(); ++i)
      if (mesh.normals.size() > 0 && along[i] != along[weld[i]]) smooth_weld[i] = i;
    const std::vector<Normal> fresh = averaged_normals(result, smooth_weld);
    for (std::size_t i = 0; i < fresh.size(); ++i)
      if (fresh[i] != Normal(0, 0, 0)) result.normals[i] = fresh[i];
  }
  result.tangents.clear();
  result.bounds.makeEmpty();
  for (const Point& position : result.positions) result.bounds.extendBy(position);
  return result;
}

}  // namespace relook
