// Primitives to triangles (glTF 2.0 section 3.7.2).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/error.h"
#include "scene/gltf/gltf_primitive.h"

namespace relook {
namespace {

/// Unit vector, or zero when there is no direction in it. What is unit but for rounding stays as it is: so what was
/// read and is written comes back the same.
Normal normalized(float x, float y, float z) {
  constexpr double kRounding = 0x1p-22;  // of a squared length: three components rounded to 24 bits stay within 2^-23
  const double dx = static_cast<double>(x), dy = static_cast<double>(y), dz = static_cast<double>(z);
  const double squared = dx * dx + dy * dy + dz * dz, length = std::sqrt(squared);
  if (std::abs(squared - 1) <= kRounding) return {x, y, z};
  if (length < 1e-12) return {0, 0, 0};
  return {static_cast<float>(dx / length), static_cast<float>(dy / length), static_cast<float>(dz / length)};
}

constexpr std::uint32_t kRestart = 0xFFFFFFFFU;
constexpr float kAnySize = std::numeric_limits<float>::max();  // of a column that is normalized or clamped

float bounded(float coordinate) { return std::clamp(coordinate, -kLargestCoordinate, kLargestCoordinate); }

/// The vertices that triangles are made of; kRestart where a strip or fan begins anew.
std::vector<std::uint32_t> vertex_sequence(const PrimitiveSource& source, std::size_t vertices) {
  std::vector<std::uint32_t> sequence;
  if (source.primitive.indices == kNoIndex) {
    sequence.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) sequence[i] = static_cast<std::uint32_t>(i);
    return sequence;
  }
  const GltfAccessor& accessor = source.model.accessors[source.primitive.indices];
  const Component type = accessor.component;
  if (accessor.width != 1 || accessor.normalized ||
      (type != Component::u8 && type != Component::u16 && type != Component::u32))
    source.fail("/indices", "indices must be unsigned integers, one at a time");
  if (const auto fault = data_fault(source.model, accessor); !fault.empty()) source.fail("/indices", fault);
  sequence = read_indices(source.model, accessor);
  const std::uint32_t restart = type == Component::u8 ? 0xFFU : type == Component::u16 ? 0xFFFFU : kRestart;
  bool restarts = false;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (sequence[i] == restart) {
      sequence[i] = kRestart;
      restarts = true;
      continue;
    }
    if (sequence[i] >= vertices)
      source.fail("/indices", "index " + std::to_string(i) + " is " + std::to_string(sequence[i]) + ", but there are " +
                                  std::to_string(vertices) + " vertices");
  }
  if (restarts) source.forgive("/indices", "primitive restart values, which glTF does not have, begin new strips");
  return sequence;
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Triangles of modes 4 (list), 5 (strip) and 6 (fan), without a restart among them. Those that name a vertex twice
/// have no area: they are left out.
void add_triangles(std::span<const std::uint32_t> sequence, int mode, Triangles& triangles) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const std::array<std::uint32_t, 3> corners = {sequence[a], sequence[b], sequence[c]};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[0] != corners[2]) triangles.push_back(corners);
  };
  const std::size_t step = mode == 4 ? 3 : 1;
  for (std::size_t i = 0; i + 3 <= sequence.size(); i += step) {
    if (mode == 6)
      add(i + 1, i + 2, 0);
    else if (mode == 5)
      add(i, i + 1 + i % 2, i + 2 - i % 2);
    else
      add(i, i + 1, i + 2);
  }
}

Triangles triangles_of(std::span<const std::uint32_t> sequence, int mode) {
  Triangles triangles;
  triangles.reserve(sequence.size() / (mode == 4 ? 3 : 1));
  while (!sequence.empty()) {
    const auto end = std::ranges::find(sequence, kRestart);
    const auto length = static_cast<std::size_t>(end - sequence.begin());
    add_triangles(sequence.first(length), mode, triangles);
    sequence = sequence.subspan(std::min(length + 1, sequence.size()));
  }
  return triangles;
}

/// The vertices that triangles name, increasing; the triangles then name places among them.
std::vector<std::uint32_t> gather_vertices(Triangles& triangles) {
  std::vector<std::uint32_t> vertices;
  vertices.reserve(3 * triangles.size());
  std::uint32_t last = 0;
  for (const auto& corners : triangles)
    for (const std::uint32_t corner : corners) {
      vertices.push_back(corner);
      last = std::max(last, corner);
    }
  if (last < 4 * vertices.size()) {  // as a rule most are named: no need to sort
    std::vector<std::uint32_t> place(std::size_t{last} + 1, kRestart);
    for (const std::uint32_t vertex : vertices) place[vertex] = 0;
    vertices.clear();
    for (std::uint32_t vertex = 0; vertex < place.size(); ++vertex)
      if (place[vertex] == 0) {
        place[vertex] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(vertex);
      }
    if (vertices.size() < place.size())
      for (auto& corners : triangles)
        for (std::uint32_t& corner : corners) corner = place[corner];
    return vertices;
  }
  std::ranges::sort(vertices);
  vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
  for (auto& corners : triangles)
    for (std::uint32_t& corner : corners)
      corner = static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, corner) - vertices.begin());
  return vertices;
}

/// Vertices whose stored normal has no direction get the mean of their triangles' normals.
void replace_missing_normals(Mesh& mesh) {
  const Normal zero{0, 0, 0};
  if (std::ranges::find(mesh.normals, zero) == mesh.normals.end()) return;
  std::vector<Imath::V3d> sums(mesh.positions.size(), Imath::V3d(0, 0, 0));
  for (const auto& corners : mesh.triangles) {
    const Imath::V3d a(mesh.positions[corners[0]]), b(mesh.positions[corners[1]]), c(mesh.positions[corners[2]]);
    const Imath::V3d area = (b - a).cross(c - a);
    for (const std::uint32_t corner : corners) sums[corner] += area;
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i] != zero) continue;
    const double length = std::sqrt(sums[i].dot(sums[i]));
    mesh.normals[i] = length > 0 ? Normal(sums[i] / length) : Normal(0, 0, 1);
  }
}

void decode_normals(const PrimitiveSource& source, Mesh& mesh) {
  const auto values = attribute(source, "NORMAL", {3, 3, true, true, true}, kAnySize);
  mesh.normals.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3)
    mesh.normals.push_back(normalized(values[i], values[i + 1], values[i + 2]));
  replace_missing_normals(mesh);
}

/// Tangents without a direction, a side or normals make the whole column useless: it is derived from uv then.
void decode_tangents(const PrimitiveSource& source, Mesh& mesh) {
  if (mesh.normals.empty()) return;  // glTF 3.7.2.1
  const auto values = attribute(source, "TANGENT", {4, 4, true, true, true}, kAnySize);
  mesh.tangents.reserve(values.size() / 4);
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const Normal direction = normalized(values[i], values[i + 1], values[i + 2]);
    if (direction == Normal(0, 0, 0)) {
      mesh.tangents.clear();
      return;
    }
    const float handedness = values[i + 3];
    if (handedness != 1 && handedness != -1) {
      source.forgive(attribute_place("TANGENT"),
                  "element " + std::to_string(source.vertices[i / 4]) +
                      " has a w that is neither 1 nor -1; tangents follow from the texture coordinates");
      mesh.tangents.clear();
      return;
    }
    mesh.tangents.emplace_back(direction.x, direction.y, direction.z, handedness);
  }
}

void decode_colors(const PrimitiveSource& source, Mesh& mesh) {
  const auto values = attribute(source, "COLOR_0", {3, 4, true, true}, kAnySize);
  if (values.empty()) return;
  const std::size_t width = source.accessor("COLOR_0")->width;
  const auto clamped = [&](std::size_t i) { return std::clamp(values[i], 0.0F, 1.0F); };
  mesh.colors.reserve(values.size() / width);
  for (std::size_t i = 0; i < values.size(); i += width) {
    const float alpha = width == 4 ? clamped(i + 3) : 1.0F;
    mesh.colors.emplace_back(clamped(i), clamped(i + 1), clamped(i + 2), alpha);
    mesh.min_alpha = std::min(mesh.min_alpha, alpha);
  }
}

Mesh decode_primitive(PrimitiveSource source) {
  Mesh mesh;
  const std::size_t count = source.accessor("POSITION")->count;
  mesh.triangles = triangles_of(vertex_sequence(source, count), source.primitive.mode);
  source.vertices = gather_vertices(mesh.triangles);
  const auto positions = attribute(source, "POSITION", {3, 3, true, false}, kLargestCoordinate);
  if (positions.empty()) return {};
  mesh.positions.reserve(positions.size() / 3);
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
    mesh.bounds.extendBy(mesh.positions.back());
  }
  decode_normals(source, mesh);
  decode_tangents(source, mesh);
  for (std::size_t set = 0; set < mesh.uv.size(); ++set) {
    const auto values = attribute(source, "TEXCOORD_" + std::to_string(set), {2, 2, true, false}, kAnySize);
    mesh.uv[set].reserve(values.size() / 2);
    for (std::size_t i = 0; i < values.size(); i += 2)
      mesh.uv[set].emplace_back(bounded(values[i]), bounded(values[i + 1]));
  }
  decode_colors(source, mesh);
  decode_targets(source, mesh);
  decode_joints(source, mesh);
  return mesh;
}

bool makes_triangles(const GltfPrimitive& primitive) {
  return primitive.mode >= 4 && primitive.attributes.contains("POSITION");
}

struct DecodedBytes {
  std::uint64_t kept = 0, passing = 0;  // passing: beside them, while one primitive is decoded
};

DecodedBytes decoded_bytes(const GltfModel& model, const GltfPrimitive& primitive) {
  if (!makes_triangles(primitive)) return {};
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 6> kColumns{{{"POSITION", sizeof(Point)},
                                                                                {"NORMAL", sizeof(Normal)},
                                                                                {"TANGENT", sizeof(Imath::V4f)},
                                                                                {"TEXCOORD_0", sizeof(Uv)},
                                                                                {"TEXCOORD_1", sizeof(Uv)},
                                                                                {"COLOR_0", sizeof(Rgba)}}};
  const std::uint64_t all = model.accessors[primitive.attributes.at("POSITION")].count;
  const std::uint64_t corners =
      primitive.indices == kNoIndex ? all : std::uint64_t{model.accessors[primitive.indices].count};
  const std::uint64_t triangles = primitive.mode == 4 ? corners / 3 : corners;
  const std::uint64_t vertices = std::min(all, 3 * triangles);
  DecodedBytes bytes{bounded_product(triangles, sizeof(std::array<std::uint32_t, 3>)), 0};
  for (const auto& [semantic, size] : kColumns)
    if (primitive.attributes.contains(semantic)) bytes.kept = bounded_sum(bytes.kept, bounded_product(vertices, size));
  bytes.kept = bounded_sum(bytes.kept, deforming_bytes(primitive, vertices));
  bytes.passing = bounded_sum(bounded_product(9 * corners, sizeof(std::uint32_t)),
                              bounded_product(vertices, passing_bytes(primitive)));
  return bytes;
}

/// A small file can name the same accessor in many primitives.
void check_total(const GltfModel& model, std::string_view file, ImportShare& share) {
  std::uint64_t data = 0, needed = 0, passing = 0;
  for (const auto& buffer : model.buffers) data += buffer.size();
  for (const auto& primitives : model.meshes)
    for (const auto& primitive : primitives) {
      const DecodedBytes bytes = decoded_bytes(model, primitive);
      needed = bounded_sum(needed, bytes.kept);
      passing = std::max(passing, bytes.passing);
    }
  constexpr std::uint64_t kAlwaysFine = std::uint64_t{256} << 20, kMostGrowth = 64;
  const std::uint64_t limit = kAlwaysFine + kMostGrowth * data;
  if (needed > limit)
    throw InputError(file, "/meshes",
                     "the geometry needs " + std::to_string(needed >> 20) + " MB; " + std::to_string(limit >> 20) +
                         " MB are allowed for this file");
  share.add(ImportShare(bounded_sum(needed, passing), file, "/meshes: the geometry"));
}

/// Primitives left out for one reason: one warning for all.
struct LeftOut {
  std::string first;
  std::size_t count = 0;

  void add(const std::string& pointer) {
    if (count++ == 0) first = pointer;
  }
  void warn(std::string_view why, std::vector<std::string>& warnings) const {
    if (count == 0) return;
    const std::string others = count == 1 ? "" : " and " + std::to_string(count - 1) + " more";
    warnings.push_back(first + others + ": " + std::string(why));
  }
};

}  // namespace

std::vector<std::vector<Mesh>> decode_meshes(const GltfModel& model, const GltfUse& use, std::string_view file,
                                             std::vector<std::string>& warnings, ImportShare& share) {
  check_total(model, file, share);
  std::vector<std::vector<Mesh>> meshes;
  LeftOut not_triangles, without_positions, empty;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    auto& primitives = meshes.emplace_back();
    for (std::size_t p = 0; p < model.meshes[m].size(); ++p) {
      const GltfPrimitive& primitive = model.meshes[m][p];
      const std::string pointer = "/meshes/" + std::to_string(m) + "/primitives/" + std::to_string(p);
      if (!makes_triangles(primitive)) {
        (primitive.mode < 4 ? not_triangles : without_positions).add(pointer);
        continue;
      }
      Mesh mesh = decode_primitive({model, primitive, file, pointer, warnings, use, m, p, {}});
      mesh.primitive = static_cast<std::uint32_t>(p);
      if (mesh.triangles.empty())
        empty.add(pointer);
      else
        primitives.push_back(std::move(mesh));
    }
  }
  not_triangles.warn("points and lines are ignored", warnings);
  without_positions.warn("a primitive without positions is ignored", warnings);
  empty.warn("a primitive without triangles is ignored", warnings);
  return meshes;
}

}  // namespace relook
