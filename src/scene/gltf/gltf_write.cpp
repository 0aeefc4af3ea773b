#include "scene/gltf/gltf_write.h"

#include <limits>

#include "base/error.h"
#include "base/json.h"

namespace relook {
namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123, kPoints = 0;

void append(Bytes& bytes, BytesView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

void append_word(Bytes& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  append(bytes, std::as_bytes(std::span(&word, 1)));
}

/// A chunk of a GLB file, filled up to whole words (section 4.4.3).
void append_chunk(Bytes& bytes, std::uint32_t type, Bytes content, std::byte filler) {
  content.resize((content.size() + 3) / 4 * 4, filler);
  append_word(bytes, content.size());
  append_word(bytes, type);
  append(bytes, content);
}

Json triple(const Point& point) { return {point.x, point.y, point.z}; }

/// One buffer and the accessors into it, a view each.
class GlbWriter {
 public:
  void add(const MeshToWrite& mesh) {
    Json primitives = Json::array();
    auto next = mesh.primitives.begin();
    for (std::size_t p = 0; p < mesh.primitive_count; ++p) {
      if (next != mesh.primitives.end() && (*next)->primitive == p)
        primitives.push_back(primitive(**next++));
      else
        primitives.push_back({{"mode", kPoints}, {"attributes", {{"POSITION", origin()}}}});
    }
    meshes_.push_back({{"name", mesh.name}, {"primitives", std::move(primitives)}});
  }

  [[nodiscard]] Bytes take() {
    const Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "relook"}}},
                       {"buffers", {{{"byteLength", data_.size()}}}},
                       {"bufferViews", std::move(views_)},
                       {"accessors", std::move(accessors_)},
                       {"meshes", std::move(meshes_)}};
    const std::string text = gltf.dump();
    constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
    Bytes chunks, file;
    append_chunk(chunks, kJsonChunk, {bytes_of(text).begin(), bytes_of(text).end()}, std::byte{' '});
    append_chunk(chunks, kBinaryChunk, std::move(data_), std::byte{0});
    constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max() - 3 * sizeof(std::uint32_t);
    if (chunks.size() > kLargest) throw InputError("", "", "geometry of more than 4 GB fits no GLB file");
    append_word(file, kMagic);
    append_word(file, kVersion);
    append_word(file, 3 * sizeof(std::uint32_t) + chunks.size());
    append(file, chunks);
    return file;
  }

 private:
  /// Appends a column of tightly packed numbers, a multiple of four bytes. Its accessor, where type is "SCALAR",
  /// "VEC2", ...
  template <class T>
  std::size_t add_column(const std::vector<T>& column, const char* type, int component, std::size_t count) {
    const BytesView bytes = std::as_bytes(std::span(column));
    views_.push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
    append(data_, bytes);
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"type", type}, {"count", count}});
    return accessors_.size() - 1;
  }
  template <class T>
  void add_attribute(Json& attributes, const char* semantic, const std::vector<T>& column, const char* type) {
    if (!column.empty()) attributes[semantic] = add_column(column, type, kFloat, column.size());
  }

  std::size_t add_positions(const std::vector<Point>& positions, const Box& bounds) {
    const std::size_t accessor = add_column(positions, "VEC3", kFloat, positions.size());
    accessors_.back()["min"] = triple(bounds.min);
    accessors_.back()["max"] = triple(bounds.max);
    return accessor;
  }

  Json primitive(const Mesh& mesh) {
    Json attributes = {{"POSITION", add_positions(mesh.positions, mesh.bounds)}};
    add_attribute(attributes, "NORMAL", mesh.normals, "VEC3");
    add_attribute(attributes, "TANGENT", mesh.tangents, "VEC4");
    add_attribute(attributes, "TEXCOORD_0", mesh.uv[0], "VEC2");
    add_attribute(attributes, "TEXCOORD_1", mesh.uv[1], "VEC2");
    add_attribute(attributes, "COLOR_0", mesh.colors, "VEC4");
    add_joints(attributes, mesh);
    const std::size_t indices = add_column(mesh.triangles, "SCALAR", kUnsignedInt, mesh.triangles.size() * 3);
    Json primitive = {{"attributes", std::move(attributes)}, {"indices", indices}};
    for (const MorphTarget& target : mesh.targets) primitive["targets"].push_back(targets_of(mesh, target));
    return primitive;
  }

  /// Four influences of each vertex in one JOINTS_n and WEIGHTS_n.
  void add_joints(Json& attributes, const Mesh& mesh) {
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
  Json targets_of(const Mesh& mesh, const MorphTarget& target) {
    Json attributes = Json::object();
    add_attribute(attributes, "POSITION", target.positions, "VEC3");
    add_attribute(attributes, "NORMAL", target.normals, "VEC3");
    add_attribute(attributes, "TANGENT", target.tangents, "VEC3");
    if (attributes.empty())
      add_attribute(attributes, "POSITION", std::vector<Point>(mesh.positions.size(), Point(0, 0, 0)), "VEC3");
    return attributes;
  }

  std::size_t origin() { return add_positions({Point(0, 0, 0)}, Box(Point(0, 0, 0))); }

  Bytes data_;
  Json views_ = Json::array(), accessors_ = Json::array(), meshes_ = Json::array();
};

}  // namespace

Bytes glb_of(std::span<const MeshToWrite> meshes) {
  GlbWriter writer;
  for (const MeshToWrite& mesh : meshes) writer.add(mesh);
  return writer.take();
}

}  // namespace relook
