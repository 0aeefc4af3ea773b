// What bends a primitive: morph targets (glTF 2.0 section 3.7.2.2) and the joints of its vertices (section 3.7.3.3).
#include <algorithm>
#include <cmath>

#include "scene/gltf/gltf_primitive.h"

namespace relook {
namespace {

constexpr std::size_t kSetWidth = 4;  // joints of a vertex in one of JOINTS_0, JOINTS_1, ...

std::string joints_of(std::size_t set) { return "JOINTS_" + std::to_string(set); }
std::string weights_of(std::size_t set) { return "WEIGHTS_" + std::to_string(set); }

std::size_t set_count(const GltfPrimitive& primitive) {
  std::size_t sets = 0;
  while (primitive.attributes.contains(joints_of(sets)) && primitive.attributes.contains(weights_of(sets))) ++sets;
  return sets;
}

/// What a target adds to one column; empty for nothing but zeros. All columns of a mesh that is shown count: what could
/// be derived would be so for the mesh at rest.
std::vector<Imath::V3f> target_column(const PrimitiveSource& source, std::size_t target, std::string_view semantic) {
  const GltfAttributes& attributes = source.primitive.targets[target];
  const auto found = attributes.find(semantic);
  if (found == attributes.end()) return {};
  const GltfAccessor& accessor = source.model.accessors[found->second];
  const std::string place = "/targets/" + std::to_string(target) + "/" + std::string(semantic);
  const std::size_t count = source.accessor("POSITION")->count;
  if (accessor.count != count)
    source.fail(place, "has " + std::to_string(accessor.count) + " elements, the primitive has " +
                           std::to_string(count) + " vertices");
  const auto values = column_of(source, accessor, place, {3, 3, true, false}, kLargestCoordinate,
                                source.use.meshes[source.mesh]);
  if (std::ranges::all_of(values, [](float value) { return value == 0; })) return {};
  std::vector<Imath::V3f> column;
  column.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3) column.emplace_back(values[i], values[i + 1], values[i + 2]);
  return column;
}

/// The weights of a vertex: their sum is 1, and of those that are 0 so is the joint. Without any weight the first joint
/// has all of it. A sum that is 1 but for rounding stays as it is: so what was read and is written comes back the same.
void normalize(std::uint16_t* joints, float* weights, std::size_t count) {
  constexpr double kRounding = 0x1p-20;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    weights[i] = std::max(weights[i], 0.0F);
    if (weights[i] == 0) joints[i] = 0;
    sum += static_cast<double>(weights[i]);
  }
  if (!(sum > 1e-12)) {
    std::fill_n(weights, count, 0.0F);
    std::fill_n(joints, count, std::uint16_t{0});
    weights[0] = 1;
  } else if (std::abs(sum - 1) > kRounding) {
    for (std::size_t i = 0; i < count; ++i) weights[i] = static_cast<float>(static_cast<double>(weights[i]) / sum);
  }
}

}  // namespace

void decode_targets(const PrimitiveSource& source, Mesh& mesh) {
  bool has_others = false;
  mesh.targets.reserve(source.primitive.targets.size());
  for (std::size_t i = 0; i < source.primitive.targets.size(); ++i) {
    MorphTarget& target = mesh.targets.emplace_back();
    target.positions = target_column(source, i, "POSITION");
    if (!mesh.normals.empty()) target.normals = target_column(source, i, "NORMAL");
    if (!mesh.tangents.empty()) target.tangents = target_column(source, i, "TANGENT");
    for (const auto& [semantic, unused] : source.primitive.targets[i])
      has_others = has_others || (semantic != "POSITION" && semantic != "NORMAL" && semantic != "TANGENT");
  }
  if (has_others) source.warn("/targets", "only positions, normals and tangents are morphed");
}

void decode_joints(const PrimitiveSource& source, Mesh& mesh) {
  const std::size_t sets = set_count(source.primitive);
  const std::size_t influences = sets * kSetWidth, vertices = mesh.positions.size();
  mesh.joints.resize(vertices * influences);
  mesh.joint_weights.resize(vertices * influences);
  for (std::size_t set = 0; set < sets; ++set) {
    const GltfAccessor& joints = *source.accessor(joints_of(set));
    if (source.reads(joints_of(set)) &&
        ((joints.component != Component::u8 && joints.component != Component::u16) || joints.normalized))
      source.fail(attribute_place(joints_of(set)), "joints must be unsigned integers of 8 or 16 bits");
    constexpr float kMostJoint = 65535, kLargestWeight = 1e6F;
    const auto indices = attribute(source, joints_of(set), {kSetWidth, kSetWidth, true, false}, kMostJoint);
    const auto weights = attribute(source, weights_of(set), {kSetWidth, kSetWidth, true, true}, kLargestWeight);
    if (indices.empty() || weights.empty()) {
      mesh.joints.clear();
      mesh.joint_weights.clear();
      return;
    }
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
      for (std::size_t i = 0; i < kSetWidth; ++i) {
        const std::size_t to = vertex * influences + set * kSetWidth + i, from = vertex * kSetWidth + i;
        mesh.joints[to] = static_cast<std::uint16_t>(indices[from]);
        mesh.joint_weights[to] = weights[from];
      }
  }
  for (std::size_t vertex = 0; vertex < vertices && influences > 0; ++vertex)
    normalize(&mesh.joints[vertex * influences], &mesh.joint_weights[vertex * influences], influences);
}

std::uint64_t deforming_bytes(const GltfPrimitive& primitive, std::uint64_t vertices) {
  std::uint64_t bytes = bounded_product(primitive.targets.size(), sizeof(MorphTarget));
  for (const GltfAttributes& target : primitive.targets)
    for (const std::string_view semantic : {"POSITION", "NORMAL", "TANGENT"})
      if (target.contains(semantic)) bytes = bounded_sum(bytes, bounded_product(vertices, sizeof(Imath::V3f)));
  const std::uint64_t of_vertex = set_count(primitive) * kSetWidth * (sizeof(std::uint16_t) + sizeof(float));
  return bounded_sum(bytes, bounded_product(vertices, of_vertex));
}

std::uint64_t passing_bytes(const GltfPrimitive& primitive) {
  return std::max(sizeof(Imath::V3d), set_count(primitive) > 0 ? 2 * kSetWidth * sizeof(float) : 0);
}

}  // namespace relook
