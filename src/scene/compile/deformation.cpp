#include "scene/compile/deformation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace relook {
namespace {

using Vector = Imath::V3d;

Imath::V3f single(const Vector& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Point bounded(const Vector& p) {
  constexpr double kLargest = 1e9;  // as of imported coordinates: products of edges stay finite
  return single({std::clamp(p.x, -kLargest, kLargest), std::clamp(p.y, -kLargest, kLargest),
                 std::clamp(p.z, -kLargest, kLargest)});
}

/// Unit vector, or zero when there is no direction in it.
Vector unit(const Vector& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 1e-300)) return {0, 0, 0};
  const Vector scaled = v / largest;
  return scaled / std::sqrt(scaled.dot(scaled));
}

/// Adds weight times one column of every target; does nothing where no target has it.
template <class Column>
void add_targets(const Mesh& mesh, const std::vector<float>& weights, Column column, std::vector<Vector>& values) {
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const std::vector<Imath::V3f>& added = mesh.targets[k].*column;
    if (weights[k] == 0 || added.empty()) continue;
    const auto weight = static_cast<double>(weights[k]);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += Vector(added[i]) * weight;
  }
}

/// Row vectors: rows 0 to 2 are where the axes go, row 3 is the translation.
struct Affine {
  Vector rows[4] = {Vector(0, 0, 0), Vector(0, 0, 0), Vector(0, 0, 0), Vector(0, 0, 0)};

  [[nodiscard]] Vector linear(const Vector& v) const { return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z; }
  [[nodiscard]] Vector point(const Vector& p) const { return linear(p) + rows[3]; }
  [[nodiscard]] double determinant() const { return rows[0].dot(rows[1].cross(rows[2])); }
  /// By the cofactors: the inverse transpose times the determinant.
  [[nodiscard]] Vector normal(const Vector& n) const {
    return rows[1].cross(rows[2]) * n.x + rows[2].cross(rows[0]) * n.y + rows[0].cross(rows[1]) * n.z;
  }
};

/// The weighted sum of a vertex's joint matrices.
Affine blended(const Mesh& mesh, const std::vector<Transform>& joints, std::size_t vertex) {
  const std::size_t influences = mesh.joints.size() / mesh.positions.size();
  Affine sum;
  for (std::size_t i = vertex * influences; i < (vertex + 1) * influences; ++i) {
    if (mesh.joint_weights[i] == 0) continue;
    const auto weight = static_cast<double>(mesh.joint_weights[i]);
    const Transform& joint = joints[mesh.joints[i]];
    for (int row = 0; row < 4; ++row)
      sum.rows[row] += Vector(static_cast<double>(joint[row][0]), static_cast<double>(joint[row][1]),
                              static_cast<double>(joint[row][2])) *
                       weight;
  }
  return sum;
}

/// A mesh in the making, in double precision.
struct Columns {
  std::vector<Vector> positions, normals, tangents;
  std::vector<bool> mirrored;  // by vertex; empty: none is
};

Columns morphed(const Mesh& mesh, const std::vector<float>& weights) {
  Columns columns;
  columns.positions.assign(mesh.positions.begin(), mesh.positions.end());
  columns.normals.assign(mesh.normals.begin(), mesh.normals.end());
  for (const Imath::V4f& tangent : mesh.tangents)
    columns.tangents.emplace_back(Imath::V3f(tangent.x, tangent.y, tangent.z));
  add_targets(mesh, weights, &MorphTarget::positions, columns.positions);
  add_targets(mesh, weights, &MorphTarget::normals, columns.normals);
  add_targets(mesh, weights, &MorphTarget::tangents, columns.tangents);
  return columns;
}

void skin(const Mesh& mesh, const std::vector<Transform>& joints, Columns& columns) {
  for (std::size_t i = 0; i < columns.positions.size(); ++i) {
    const Affine matrix = blended(mesh, joints, i);
    const bool is_mirrored = matrix.determinant() < 0;
    columns.positions[i] = matrix.point(columns.positions[i]);
    if (!columns.normals.empty()) columns.normals[i] = matrix.normal(columns.normals[i]) * (is_mirrored ? -1.0 : 1.0);
    if (!columns.tangents.empty()) columns.tangents[i] = matrix.linear(columns.tangents[i]);
    if (!is_mirrored) continue;
    columns.mirrored.resize(columns.positions.size(), false);
    columns.mirrored[i] = true;
  }
}

}  // namespace

Mesh deformed(const Mesh& mesh, const Deformation& deformation) {
  const bool is_skinned = !deformation.joints.empty() && !mesh.joints.empty();
  require(deformation.weights.size() <= mesh.targets.size(), "a weight has a target");
  require(!is_skinned || mesh.joint_count() <= deformation.joints.size(), "the compiler checks joints");
  Columns columns = morphed(mesh, deformation.weights);
  if (is_skinned) skin(mesh, deformation.joints, columns);
  Mesh result;
  result.name = mesh.name;
  result.primitive = mesh.primitive;
  result.triangles = mesh.triangles;
  result.uv = mesh.uv;
  result.colors = mesh.colors;
  result.min_alpha = mesh.min_alpha;
  result.positions.reserve(columns.positions.size());
  result.normals.reserve(columns.normals.size());
  result.tangents.reserve(columns.tangents.size());
  for (const Vector& position : columns.positions) {
    result.positions.push_back(bounded(position));
    result.bounds.extendBy(result.positions.back());
  }
  for (const Vector& normal : columns.normals) result.normals.push_back(single(unit(normal)));
  const auto is_mirrored = [&](std::size_t vertex) { return !columns.mirrored.empty() && columns.mirrored[vertex]; };
  for (std::size_t i = 0; i < columns.tangents.size(); ++i) {
    const Imath::V3f tangent = single(unit(columns.tangents[i]));
    result.tangents.emplace_back(tangent.x, tangent.y, tangent.z, mesh.tangents[i].w * (is_mirrored(i) ? -1.0F : 1.0F));
  }
  for (auto& corners : result.triangles)
    if (is_mirrored(corners[0])) std::swap(corners[1], corners[2]);
  return result;
}

Pose posed(const Json& skin, std::span<const Transform> inverse_binds,
           const std::function<WideTransform(const std::string& node)>& world_of) {
  Pose pose;
  const Json& joints = skin.at("joints");
  for (std::size_t i = 0; i < inverse_binds.size(); ++i) {
    const WideTransform world = world_of(joints[i].get_ref<const std::string&>());
    if (i == 0) pose.place = WidePoint(world[3][0], world[3][1], world[3][2]);
    pose.joints.push_back(rounded(widened(inverse_binds[i]) * world, pose.place));
  }
  return pose;
}

const Json* weights_of(const Json& node, const Json& mesh) {
  for (const Json* entry : {&node, &mesh})
    if (const auto weights = entry->find("weights"); weights != entry->end()) return &*weights;
  return nullptr;
}

SharedDeformation deformation_of(const Mesh& mesh, const Json* weights, const Pose& pose) {
  Deformation deformation;
  if (weights != nullptr)
    for (std::size_t i = 0; i < std::min(weights->size(), mesh.targets.size()); ++i)
      deformation.weights.push_back((*weights)[i].get<float>() + 0.0F);  // never -0
  while (!deformation.weights.empty() && deformation.weights.back() == 0) deformation.weights.pop_back();
  if (!mesh.joints.empty()) deformation.joints = pose.joints;
  if (deformation.weights.empty() && deformation.joints.empty()) return {};
  return {std::make_shared<const Deformation>(std::move(deformation))};
}

}  // namespace relook
