#include "cache/scene_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/import_memory.h"
#include "base/json.h"
#include "scene/look/counted_assets.h"

namespace relook {
namespace {

constexpr std::int64_t kMostValues = std::int64_t{1} << 40;
constexpr float kLargestNumber = 1e18F;
constexpr std::array<const char*, 16> kColumns{"positions",
                                               "triangles",
                                               "normals",
                                               "tangents",
                                               "uv0",
                                               "uv1",
                                               "colors",
                                               "bounds",
                                               "min_alpha",
                                               "target_positions",
                                               "target_normals",
                                               "target_tangents",
                                               "joints",
                                               "joint_weights",
                                               "inverse_binds",
                                               "instances"};

template <class T>
void check_numbers(const std::vector<T>& values, const char* section) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  const std::span<const float> numbers(reinterpret_cast<const float*>(values.data()),
                                       values.size() * (sizeof(T) / sizeof(float)));
  for (const float number : numbers)
    check_sound(std::abs(number) <= kLargestNumber, "a number that is not finite in section ", section);
}

/// Hands out the values of a column from the front.
template <class T>
class Cutter {
 public:
  Cutter(const ContainerReader& reader, const char* section)
      : section_(section), values_(reader.column<T>(section, reader.count<T>(section))) {
    if constexpr (sizeof(T) % sizeof(float) == 0 && !std::is_same_v<T, std::array<std::uint32_t, 3>>)
      check_numbers(values_, section);
  }
  std::vector<T> take(std::uint64_t count) {
    check_sound(count <= values_.size() - next_, "section " + section_ + " is too short");
    const auto first = values_.begin() + static_cast<std::ptrdiff_t>(next_);
    next_ += count;
    return {first, first + static_cast<std::ptrdiff_t>(count)};
  }
  void finish() const { check_sound(next_ == values_.size(), "section " + section_ + " is too long"); }

 private:
  std::string section_;
  std::vector<T> values_;
  std::size_t next_ = 0;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

Json target_entries(const Mesh& mesh) {
  Json entries = Json::array();
  for (const MorphTarget& target : mesh.targets)
    entries.push_back({target.positions.size(), target.normals.size(), target.tangents.size()});
  return entries;
}

Json mesh_entry(const Mesh& mesh) {
  return {{"name", mesh.name},
          {"primitive", mesh.primitive},
          {"positions", mesh.positions.size()},
          {"triangles", mesh.triangles.size()},
          {"normals", mesh.normals.size()},
          {"tangents", mesh.tangents.size()},
          {"uv0", mesh.uv[0].size()},
          {"uv1", mesh.uv[1].size()},
          {"colors", mesh.colors.size()},
          {"targets", target_entries(mesh)},
          {"joints", mesh.joints.size()}};
}

Json names_entry(const LookDocument& document) {
  Json order = Json::object();
  for (std::size_t s = 0; s < kSectionCount; ++s)
    order[std::string(section_name(static_cast<Section>(s)))] = document.order[s];
  Json instances = Json::array();
  for (const auto& [node, matrices] : document.instances)
    instances.push_back({{"node", node}, {"count", matrices.size()}});
  Json skins = Json::array();
  for (const auto& [skin, matrices] : document.inverse_binds)
    skins.push_back({{"skin", skin}, {"count", matrices.size()}});
  Json groups = Json::object();
  for (const auto& [name, ids] : document.assets->mesh_primitives) {
    Json& group = groups[name] = Json::array();
    for (const MeshId id : ids) group.push_back(id.index());
  }
  Json meshes = Json::array();
  for (const Mesh& mesh : document.assets->meshes) meshes.push_back(mesh_entry(mesh));
  return {{"order", std::move(order)},   {"instances", std::move(instances)}, {"groups", std::move(groups)},
          {"meshes", std::move(meshes)}, {"cameras", document.cameras},       {"file", document.file},
          {"skins", std::move(skins)}};
}

/// Runs a reader of JSON that this program has written: what does not fit is damage, not bad input.
template <class Read>
auto read_own_json(Read read) {
  try {
    return read();
  } catch (const InputError& fault) {
    throw CacheDamage(CacheFault::damaged, fault.what());
  }
}

std::uint64_t size_at(const JsonView& view, const char* key) {
  return static_cast<std::uint64_t>(view.at(key).integer(0, kMostValues));
}

struct GeometryColumns {
  explicit GeometryColumns(const ContainerReader& reader)
      : positions(reader, "positions"),
        triangles(reader, "triangles"),
        normals(reader, "normals"),
        tangents(reader, "tangents"),
        uv0(reader, "uv0"),
        uv1(reader, "uv1"),
        colors(reader, "colors"),
        bounds(reader, "bounds"),
        min_alpha(reader, "min_alpha"),
        target_positions(reader, "target_positions"),
        target_normals(reader, "target_normals"),
        target_tangents(reader, "target_tangents"),
        joints(reader, "joints"),
        joint_weights(reader, "joint_weights") {}
  void finish() const {
    positions.finish(), triangles.finish(), normals.finish(), tangents.finish(), uv0.finish(), uv1.finish();
    colors.finish(), bounds.finish(), min_alpha.finish();
    target_positions.finish(), target_normals.finish(), target_tangents.finish();
    joints.finish(), joint_weights.finish();
  }

  Cutter<Point> positions;
  Cutter<std::array<std::uint32_t, 3>> triangles;
  Cutter<Normal> normals;
  Cutter<Imath::V4f> tangents;
  Cutter<Uv> uv0, uv1;
  Cutter<Rgba> colors;
  Cutter<Point> bounds;
  Cutter<float> min_alpha;
  Cutter<Imath::V3f> target_positions, target_normals, target_tangents;
  Cutter<std::uint16_t> joints;
  Cutter<float> joint_weights;
};

/// Reads a mesh's morph targets. A column is empty or as long as the positions; anything else is damage.
void read_targets(const JsonView& entries, GeometryColumns& columns, Mesh& mesh) {
  entries.require_array();
  mesh.targets.reserve(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const JsonView sizes = entries.at(i);
    const auto take = [&](std::size_t column, Cutter<Imath::V3f>& values) {
      const auto size = static_cast<std::uint64_t>(sizes.at(column).integer(0, kMostValues));
      check_sound(size == 0 || size == mesh.positions.size(),
                  "a morph target that is not as long as mesh " + printable(mesh.name));
      return values.take(size);
    };
    MorphTarget& target = mesh.targets.emplace_back();
    target.positions = take(0, columns.target_positions);
    target.normals = take(1, columns.target_normals);
    target.tangents = take(2, columns.target_tangents);
    check_sound(
        (target.normals.empty() || !mesh.normals.empty()) && (target.tangents.empty() || !mesh.tangents.empty()),
        "a morph target of a column that is missing in mesh " + printable(mesh.name));
  }
}

/// Reads a mesh's joints and weights: as many for each vertex, and no weight that makes numbers too large. Their sums
/// are not looked at.
void read_joints(const JsonView& entry, GeometryColumns& columns, Mesh& mesh) {
  const std::uint64_t count = size_at(entry, "joints");
  mesh.joints = columns.joints.take(count);
  mesh.joint_weights = columns.joint_weights.take(count);
  if (count == 0) return;
  const std::string name = printable(mesh.name);
  check_sound(!mesh.positions.empty() && count % mesh.positions.size() == 0, "joints that do not fit mesh ", name);
  for (const float weight : mesh.joint_weights)
    check_sound(weight >= 0 && weight <= 2, "a weight of a joint that is out of range in mesh ", name);
}

Mesh read_mesh(const JsonView& entry, GeometryColumns& columns) {
  Mesh mesh;
  mesh.name = entry.at("name").text();
  mesh.primitive = static_cast<std::uint32_t>(entry.at("primitive").integer(0, 0xFFFFFFFF));
  mesh.positions = columns.positions.take(size_at(entry, "positions"));
  mesh.triangles = columns.triangles.take(size_at(entry, "triangles"));
  mesh.normals = columns.normals.take(size_at(entry, "normals"));
  mesh.tangents = columns.tangents.take(size_at(entry, "tangents"));
  mesh.uv = {columns.uv0.take(size_at(entry, "uv0")), columns.uv1.take(size_at(entry, "uv1"))};
  mesh.colors = columns.colors.take(size_at(entry, "colors"));
  read_targets(entry.at("targets"), columns, mesh);
  read_joints(entry, columns, mesh);
  const std::vector<Point> corners = columns.bounds.take(2);
  mesh.bounds = Box(corners[0], corners[1]);
  mesh.min_alpha = columns.min_alpha.take(1)[0];

  for (const std::size_t size :
       {mesh.normals.size(), mesh.tangents.size(), mesh.uv[0].size(), mesh.uv[1].size(), mesh.colors.size()})
    check_sound(size == 0 || size == mesh.positions.size(),
                "columns of mesh " + printable(mesh.name) + " differ in length");
  const std::string name = printable(mesh.name);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      check_sound(vertex < mesh.positions.size(), "a vertex that does not exist in mesh ", name);
  return mesh;
}

/// Checks that cameras have the members that make_look_document() gives them: edits look them up by index and by name.
Json read_cameras(const JsonView& cameras) {
  cameras.require_object();
  for (const auto& [name, unused] : cameras.value().items()) {
    const JsonView camera = cameras.at(name);
    (void)camera.at("node").text();
    camera.at("camera").require_object();
    (void)camera.at("index").integer(0, kMostValues);
  }
  return cameras.value();
}

void read_names(const JsonView& names, LookDocument& document, Assets& assets) {
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const JsonView order = names.at("order").at(section_name(static_cast<Section>(s)));
    order.require_array();
    for (std::size_t i = 0; i < order.size(); ++i) document.order[s].push_back(order.at(i).text());
  }
  const JsonView groups = names.at("groups");
  groups.require_object();
  for (const auto& [name, unused] : groups.value().items()) {
    const JsonView group = groups.at(name);
    group.require_array();
    std::vector<MeshId>& ids = assets.mesh_primitives[name];
    for (std::size_t i = 0; i < group.size(); ++i)
      ids.emplace_back(
          static_cast<std::uint32_t>(group.at(i).integer(0, static_cast<std::int64_t>(assets.meshes.size()) - 1)));
  }
  document.cameras = read_cameras(names.at("cameras"));
  document.file = names.at("file").text();
}

/// Reads the matrices of the nodes or skins that `entries` list, whose names stand in `key`.
void read_matrices(const JsonView& entries, const char* key, Cutter<Transform> matrices,
                   std::map<std::string, std::vector<Transform>, std::less<>>& of_owners) {
  entries.require_array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const JsonView entry = entries.at(i);
    of_owners[entry.at(key).text()] = matrices.take(size_at(entry, "count"));
  }
  matrices.finish();
}

/// The columns of all meshes' morph targets and joints, which have lengths of their own.
struct DeformingColumns {
  std::vector<Imath::V3f> positions, normals, tangents;
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;

  void add(const Mesh& mesh) {
    for (const MorphTarget& target : mesh.targets)
      append(positions, target.positions), append(normals, target.normals), append(tangents, target.tangents);
    append(joints, mesh.joints), append(weights, mesh.joint_weights);
  }
  void write(ContainerWriter& writer) const {
    writer.add_column("target_positions", positions, 4);
    writer.add_column("target_normals", normals, 4);
    writer.add_column("target_tangents", tangents, 4);
    writer.add_column("joints", joints, 2);
    writer.add_column("joint_weights", weights, 4);
  }
};

}  // namespace

Bytes encode_look(const LookDocument& document) {
  const std::string text = document.look.dump(1) + "\n";
  const BytesView bytes = bytes_of(text);
  return {bytes.begin(), bytes.end()};
}

Bytes encode_geometry(const LookDocument& document, const CacheIdentity& identity) {
  Mesh all;
  std::vector<Point> bounds;
  std::vector<float> min_alpha;
  DeformingColumns deforming;
  for (const Mesh& mesh : document.assets->meshes) {
    deforming.add(mesh);
    append(all.positions, mesh.positions);
    append(all.triangles, mesh.triangles);
    append(all.normals, mesh.normals);
    append(all.tangents, mesh.tangents);
    append(all.uv[0], mesh.uv[0]);
    append(all.uv[1], mesh.uv[1]);
    append(all.colors, mesh.colors);
    bounds.push_back(mesh.bounds.min);
    bounds.push_back(mesh.bounds.max);
    min_alpha.push_back(mesh.min_alpha);
  }
  std::vector<Transform> instances, inverse_binds;
  for (const auto& [node, matrices] : document.instances) append(instances, matrices);
  for (const auto& [skin, matrices] : document.inverse_binds) append(inverse_binds, matrices);

  ContainerWriter writer;
  writer.add("names", bytes_of(json_text(names_entry(document))));
  writer.add_column("positions", all.positions, 4);
  writer.add_column("triangles", all.triangles, 4);
  writer.add_column("normals", all.normals, 4);
  writer.add_column("tangents", all.tangents, 4);
  writer.add_column("uv0", all.uv[0], 4);
  writer.add_column("uv1", all.uv[1], 4);
  writer.add_column("colors", all.colors, 4);
  writer.add_column("bounds", bounds, 4);
  writer.add_column("min_alpha", min_alpha, 4);
  deforming.write(writer);
  writer.add_column("inverse_binds", inverse_binds, 4);
  writer.add_column("instances", instances, 4);
  return writer.finish(identity);
}

void decode_look(BytesView file, LookDocument& document) {
  document.look = read_own_json([&] { return parse_json(text_of(file), ""); });
  check_sound(document.look.is_object(), "the look document is no object");
}

void decode_geometry(BytesView file, const CacheIdentity& identity, LookDocument& document, Assets& assets) {
  const ContainerReader reader(file, identity);
  std::uint64_t bytes = 0;
  for (const char* section : kColumns) bytes = bounded_sum(bytes, reader.raw_bytes(section));
  require_import_memory(bounded_product(bytes, 2), "", "the geometry, with a copy while it is read,");
  ImportShare share(bytes, "", "the geometry");
  const std::string text = reader.text("names");
  read_own_json([&] {
    const Json json = parse_json(text, "");
    const JsonView names(json, "");
    GeometryColumns columns(reader);
    const JsonView meshes = names.at("meshes");
    meshes.require_array();
    for (std::size_t i = 0; i < meshes.size(); ++i) assets.meshes.push_back(read_mesh(meshes.at(i), columns));
    columns.finish();
    read_names(names, document, assets);
    read_matrices(names.at("instances"), "node", Cutter<Transform>(reader, "instances"), document.instances);
    read_matrices(names.at("skins"), "skin", Cutter<Transform>(reader, "inverse_binds"), document.inverse_binds);
  });
  share = ImportShare();  // from here on with what has been made of it
  count_geometry(document);
}

}  // namespace relook
