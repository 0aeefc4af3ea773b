#include "scene/gltf/gltf_write.h"

#include <ImathMatrixAlgo.h>

#include <array>
#include <limits>

#include "base/error.h"

namespace relook {
namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123, kPoints = 0;
constexpr std::size_t kWord = sizeof(std::uint32_t);

void append(Bytes& bytes, BytesView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

void append_word(Bytes& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  append(bytes, std::as_bytes(std::span(&word, 1)));
}

std::size_t whole_words(std::size_t bytes) { return (bytes + kWord - 1) / kWord * kWord; }

/// A chunk of a GLB file, filled up to whole words (section 4.4.3).
void append_chunk(Bytes& bytes, std::uint32_t type, BytesView content, std::byte filler) {
  append_word(bytes, whole_words(content.size()));
  append_word(bytes, type);
  append(bytes, content);
  bytes.resize(bytes.size() + whole_words(content.size()) - content.size(), filler);
}

Json triple(const Point& point) { return {point.x, point.y, point.z}; }

}  // namespace

std::size_t ColumnWriter::add_view(BytesView bytes) {
  binary_.resize(whole_words(binary_.size()));
  gltf_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
  append(binary_, bytes);
  return gltf_["bufferViews"].size() - 1;
}

template <class T>
std::size_t ColumnWriter::add_column(const std::vector<T>& column, const char* type, int component, std::size_t count) {
  const std::size_t view = add_view(std::as_bytes(std::span(column)));
  gltf_["accessors"].push_back({{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
  return gltf_["accessors"].size() - 1;
}

template <class T>
void ColumnWriter::add_attribute(Json& attributes, const std::string& semantic, const std::vector<T>& column,
                                 const char* type) {
  if (!column.empty()) attributes[semantic] = add_column(column, type, kFloat, column.size());
}

/// Their bounds must stand in the file (section 3.7.2.1).
std::size_t ColumnWriter::add_positions(const std::vector<Point>& positions) {
  Box bounds;
  for (const Point& position : positions) bounds.extendBy(position);
  const std::size_t index = add_column(positions, "VEC3", kFloat, positions.size());
  Json& accessor = gltf_["accessors"].back();
  accessor["min"] = triple(bounds.min);
  accessor["max"] = triple(bounds.max);
  return index;
}

Json ColumnWriter::add_primitives(const MeshToWrite& mesh) {
  Json primitives = Json::array();
  auto next = mesh.primitives.begin();
  for (std::size_t p = 0; p < mesh.primitive_count; ++p) {
    if (next != mesh.primitives.end() && (*next)->primitive == p)
      primitives.push_back(add_primitive(**next++));
    else
      primitives.push_back({{"mode", kPoints}, {"attributes", {{"POSITION", add_positions({Point(0, 0, 0)})}}}});
  }
  return primitives;
}

Json ColumnWriter::add_primitive(const Mesh& mesh) {
  Json attributes = {{"POSITION", add_positions(mesh.positions)}};
  add_attribute(attributes, "NORMAL", mesh.normals, "VEC3");
  add_attribute(attributes, "TANGENT", mesh.tangents, "VEC4");
  add_attribute(attributes, "TEXCOORD_0", mesh.uv[0], "VEC2");
  add_attribute(attributes, "TEXCOORD_1", mesh.uv[1], "VEC2");
  add_attribute(attributes, "COLOR_0", mesh.colors, "VEC4");
  add_joints(attributes, mesh);
  const std::size_t indices = add_column(mesh.triangles, "SCALAR", kUnsignedInt, mesh.triangles.size() * 3);
  Json primitive = {{"attributes", std::move(attributes)}, {"indices", indices}};
  for (const MorphTarget& target : mesh.targets) primitive["targets"].push_back(add_target(mesh, target));
  return primitive;
}

/// Four influences of each vertex in one JOINTS_n and WEIGHTS_n.
void ColumnWriter::add_joints(Json& attributes, const Mesh& mesh) {
  const std::size_t sets = mesh.joints.size() / mesh.positions.size() / 4;
  for (std::size_t set = 0; set < sets; ++set) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t i = 4 * set; i < mesh.joints.size(); i += 4 * sets) {
      joints.insert(joints.end(), &mesh.joints[i], &mesh.joints[i] + 4);
      weights.insert(weights.end(), &mesh.joint_weights[i], &mesh.joint_weights[i] + 4);
    }
    attributes["JOINTS_" + std::to_string(set)] = add_column(joints, "VEC4", kUnsignedShort, joints.size() / 4);
    attributes["WEIGHTS_" + std::to_string(set)] = add_column(weights, "VEC4", kFloat, weights.size() / 4);
  }
}

/// A column that adds nothing has no accessor; a target without any adds zeros to the positions.
Json ColumnWriter::add_target(const Mesh& mesh, const MorphTarget& target) {
  Json attributes = Json::object();
  if (!target.positions.empty()) attributes["POSITION"] = add_positions(target.positions);
  add_attribute(attributes, "NORMAL", target.normals, "VEC3");
  add_attribute(attributes, "TANGENT", target.tangents, "VEC3");
  if (attributes.empty())
    attributes["POSITION"] = add_positions(std::vector<Point>(mesh.positions.size(), Point(0, 0, 0)));
  return attributes;
}

std::size_t ColumnWriter::add_matrices(std::span<const Transform> matrices) {
  return add_column(std::vector<Transform>(matrices.begin(), matrices.end()), "MAT4", kFloat, matrices.size());
}

Json ColumnWriter::add_instances(std::span<const Transform> matrices) {
  std::vector<Point> translations, scales;
  std::vector<Imath::V4f> rotations;
  std::array<std::vector<Point>, 3> axes;
  for (const Transform& matrix : matrices) {
    Imath::V3f scale(1, 1, 1), shear, translation;
    Imath::Eulerf angles;
    const bool is_plain = Imath::extractSHRT(matrix, scale, shear, angles, translation, false);
    const Imath::Quatf turn = is_plain ? angles.toQuat().normalized() : Imath::Quatf();
    translations.emplace_back(matrix[3][0], matrix[3][1], matrix[3][2]);
    scales.emplace_back(scale);
    rotations.emplace_back(turn.v.x, turn.v.y, turn.v.z, turn.r);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const float* row = matrix[static_cast<int>(axis)];
      axes[axis].emplace_back(row[0], row[1], row[2]);
    }
  }
  Json attributes = Json::object();
  add_attribute(attributes, "TRANSLATION", translations, "VEC3");
  add_attribute(attributes, "ROTATION", rotations, "VEC4");
  add_attribute(attributes, "SCALE", scales, "VEC3");
  add_attribute(attributes, "_RELOOK_X", axes[0], "VEC3");
  add_attribute(attributes, "_RELOOK_Y", axes[1], "VEC3");
  add_attribute(attributes, "_RELOOK_Z", axes[2], "VEC3");
  return attributes;
}

Bytes glb_file(const Json& gltf, BytesView binary) {
  const std::string text = gltf.dump();
  constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  const std::size_t size = 5 * kWord + whole_words(text.size()) + (binary.empty() ? 0 : 2 * kWord + binary.size());
  if (whole_words(size) > std::numeric_limits<std::uint32_t>::max())
    throw InputError("", "", "more than 4 GB fit no GLB file");
  Bytes file;
  file.reserve(whole_words(size));
  append_word(file, kMagic);
  append_word(file, kVersion);
  append_word(file, whole_words(size));
  append_chunk(file, kJsonChunk, bytes_of(text), std::byte{' '});
  if (!binary.empty()) append_chunk(file, kBinaryChunk, binary, std::byte{0});
  return file;
}

Bytes glb_of(std::span<const MeshToWrite> meshes) {
  Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "relook"}}}};
  Bytes binary;
  ColumnWriter writer(gltf, binary);
  for (const MeshToWrite& mesh : meshes)
    gltf["meshes"].push_back({{"name", mesh.name}, {"primitives", writer.add_primitives(mesh)}});
  gltf["buffers"] = {{{"byteLength", binary.size()}}};
  return glb_file(gltf, binary);
}

}  // namespace relook
