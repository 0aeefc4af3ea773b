#include "trace/surface.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "scene/texture/procedural.h"
#include "scene/texture/texture_mapping.h"
#include "trace/rounding.h"

namespace relook {
namespace {

struct Weights {
  float w0, w1, w2;
};
Weights weights(const Hit& hit) { return {1.0F - hit.u - hit.v, hit.u, hit.v}; }

template <class T>
inline T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& triangle, const Hit& hit) {
  const auto [w0, w1, w2] = weights(hit);
  return values[triangle[0]] * w0 + values[triangle[1]] * w1 + values[triangle[2]] * w2;
}

Point to_world(const Transform& m, const Point& p) {
  return Point(p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0],
               p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1],
               p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2]);
}
Direction vector_to_world(const Transform& m, const Direction& v) {
  return Direction(v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
                   v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]);
}

/// v / |v|, or `otherwise` when v is too short or too long to have a direction.
Direction unit_or(const Direction& v, const Direction& otherwise) {
  const float length2 = v.dot(v);
  return length2 > 1e-30F && length2 < 1e30F ? v / std::sqrt(length2) : otherwise;
}

/// Scaled so that its largest component is 1: products of tiny or huge vectors stay in range. (0, 0, 1) for a zero
/// vector.
Direction scaled(const Direction& v) {
  const float largest = std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
  return largest > 0 ? v * (1.0F / largest) : Direction(0, 0, 1);
}

/// A normal taken to the world and to length 1; tiny and huge ones are scaled on the way, so that none loses its
/// direction.
inline Normal unit_normal(const Normal& n, const Imath::M33f& to_world, const Normal& otherwise) {
  const Normal world = n * to_world;
  const float length2 = world.dot(world);
  if (length2 > 1e-24F && length2 < 1e24F) return world / std::sqrt(length2);
  return unit_or(scaled(scaled(n) * to_world), otherwise);
}

float largest_of(float a, float b, float c) { return std::max(std::max(std::fabs(a), std::fabs(b)), std::fabs(c)); }
Point largest_of(const Point& a, const Point& b, const Point& c) {
  return Point(largest_of(a.x, b.x, c.x), largest_of(a.y, b.y, c.y), largest_of(a.z, b.z, c.z));
}

/// From a point of a triangle towards the planes through its vertices across their normals, weighted as the vertices
/// are: onto the surface that they stand for, where that lies above the triangle (Hanika 2021, "Hacking the Shadow
/// Terminator"). Object space.
Direction smooth_lift(const Mesh& mesh, const Hit& hit, const Point& local, bool inside) {
  const auto& triangle = mesh.triangles[hit.primitive];
  const auto [w0, w1, w2] = weights(hit);
  const float side = inside ? -1.0F : 1.0F;
  const auto part = [&](std::uint32_t vertex, float weight) {
    const Normal n = mesh.normals[vertex] * side;
    return n * (weight * std::max((mesh.positions[vertex] - local).dot(n), 0.0F));
  };
  return part(triangle[0], w0) + part(triangle[1], w1) + part(triangle[2], w2);
}

}  // namespace

SurfacePoint surface_point(const RayObject& object, const Hit& hit, Direction direction) {
  const Mesh& mesh = *object.mesh;
  const auto& triangle = mesh.triangles[hit.primitive];
  for (const std::uint32_t vertex : triangle) {  // what is read behind the positions, here and by textures
    if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[vertex]);
    if (!mesh.uv[0].empty()) __builtin_prefetch(&mesh.uv[0][vertex]);
  }
  SurfacePoint point;
  point.local = interpolate(mesh.positions, triangle, hit);
  point.position = to_world(object.to_world, point.local);
  const Point &a = mesh.positions[triangle[0]], &b = mesh.positions[triangle[1]], &c = mesh.positions[triangle[2]];
  point.offset = rounding_offset(object.to_world, largest_of(a, b, c));
  const Normal cross = (b - a).cross(c - a);
  Normal front = unit_normal(cross, object.normal_to_world, Normal(0, 0, 1));
  if (object.flipped) front = -front;
  point.inside = front.dot(direction) > 0;
  point.geometric = point.inside ? -front : front;
  point.shading = point.geometric;
  if (!mesh.normals.empty()) {
    point.shading = unit_normal(interpolate(mesh.normals, triangle, hit), object.normal_to_world, point.geometric);
    if (point.shading.dot(point.geometric) < 0) point.shading = -point.shading;
    point.lift = vector_to_world(object.to_world, smooth_lift(mesh, hit, point.local, point.inside));
  }
  return point;
}

TextureCoordinates texture_coordinates(const RayObject& object, const Hit& hit, const Point& local,
                                       const TextureSlot& slot) {
  const Mesh& mesh = *object.mesh;
  const Mapping mapping = effective_mapping(mesh, slot);
  if (mapping == Mapping::solid) return {local, 0};
  const auto& triangle = mesh.triangles[hit.primitive];
  const Point a = vertex_coordinates(mesh, slot, mapping, triangle[0]);
  const Point b = vertex_coordinates(mesh, slot, mapping, triangle[1]) - a;
  const Point c = vertex_coordinates(mesh, slot, mapping, triangle[2]) - a;
  const Point& p = mesh.positions[triangle[0]];
  const Direction e1 = vector_to_world(object.to_world, mesh.positions[triangle[1]] - p);
  const Direction e2 = vector_to_world(object.to_world, mesh.positions[triangle[2]] - p);
  const Direction cross = e1.cross(e2);
  const float world_area = std::sqrt(cross.dot(cross));
  const float texture_area = std::fabs(b.x * c.y - b.y * c.x);
  TextureCoordinates at;
  at.position =
      mapping == Mapping::uv ? a + b * hit.u + c * hit.v : projected_coordinates(mesh, local, mapping, slot.axis);
  at.area_ratio = world_area > 0 ? texture_area / world_area : 0;
  return at;
}

Point procedural_position(const TextureSlot& slot, const TextureCoordinates& at) {
  if (slot.mapping == Mapping::solid || at.area_ratio == 0) return at.position;
  const Uv uv = transformed_uv(slot, at.position);
  return Point(uv.x, uv.y, 0);
}

void find_taps(const TextureSlot& slot, const TextureCoordinates& at, float footprint, TexelTaps& taps) {
  const auto& base = slot.pyramid->levels.front();
  const float texels = static_cast<float>(base.width) * static_cast<float>(base.height) *
                       std::fabs(slot.scale.x * slot.scale.y) * at.area_ratio;
  const float level = 0.5F * portable_log2(texels * footprint * footprint);
  find_taps(*slot.pyramid, transformed_uv(slot, at.position), level, slot.sampler, taps);
}

Rgba texture_value(const TextureSlot& slot, const TextureCoordinates& at, float footprint) {
  if (slot.kind == TextureKind::procedural) return evaluate(slot.procedural, procedural_position(slot, at));
  TexelTaps taps;
  find_taps(slot, at, footprint, taps);
  return value_of(*slot.pyramid, taps);
}

namespace {

const TangentFrame kNoFrame{Direction(0, 0, 0), Direction(0, 0, 0)};

/// The frame of the map as KHR_texture_transform lays it: +X along its own u, +Y against its own v.
TangentFrame turned(const TangentFrame& frame, const Normal& front, const TextureSlot& slot) {
  if (slot.rotation == 0 && slot.scale.x > 0 && slot.scale.y > 0) return frame;
  const auto [sine, cosine] = rotation_of(slot);
  // d(u, v) of the mesh for a step along the map's u, from the inverse of the transform, times |scale x scale|.
  const float along_u = cosine * slot.scale.y, along_v = sine * slot.scale.x;
  const float sign = slot.scale.x * slot.scale.y < 0 ? -1.0F : 1.0F;
  const Direction tangent = unit_or((frame.tangent * along_u - frame.bitangent * along_v) * sign, Direction(0, 0, 0));
  const float handedness = front.cross(frame.tangent).dot(frame.bitangent) < 0 ? -sign : sign;
  return {tangent, front.cross(tangent) * handedness};
}

}  // namespace

TangentFrame tangent_frame(const RayObject& object, const Hit& hit, const SurfacePoint& point,
                           const TextureSlot& slot) {
  const Mesh& mesh = *object.mesh;
  const auto& triangle = mesh.triangles[hit.primitive];
  Direction tangent;
  float handedness = 1;
  const CornerTangents* derived = slot.mapping == Mapping::uv ? object.tangents[slot.texcoord].get() : nullptr;
  if (derived != nullptr || (!mesh.tangents.empty() && slot.mapping == Mapping::uv)) {
    const Imath::V4f t = derived != nullptr ? interpolate(derived->tangents, derived->corners[hit.primitive], hit)
                                            : interpolate(mesh.tangents, triangle, hit);
    tangent = vector_to_world(object.to_world, Direction(t.x, t.y, t.z));
    handedness = t.w < 0 ? -1.0F : 1.0F;
  } else {
    const Mapping mapping = effective_mapping(mesh, slot);
    if (mapping == Mapping::solid) return kNoFrame;
    const Point a = vertex_coordinates(mesh, slot, mapping, triangle[0]);
    const Point b = vertex_coordinates(mesh, slot, mapping, triangle[1]) - a;
    const Point c = vertex_coordinates(mesh, slot, mapping, triangle[2]) - a;
    const Point& p = mesh.positions[triangle[0]];
    const float area = b.x * c.y - b.y * c.x;
    const Direction gradient = (mesh.positions[triangle[1]] - p) * c.y - (mesh.positions[triangle[2]] - p) * b.y;
    tangent = vector_to_world(object.to_world, area < 0 ? -gradient : gradient);
    handedness = area < 0 ? 1.0F : -1.0F;  // v runs down the image: unmirrored triangles have negative areas
  }
  if (object.flipped) handedness = -handedness;
  const Normal front = point.inside ? -point.shading : point.shading;
  if (!(tangent.dot(tangent) > 0)) return kNoFrame;
  tangent = scaled(tangent);
  tangent = unit_or(tangent - front * front.dot(tangent), Direction(0, 0, 0));
  return turned({tangent, front.cross(tangent) * handedness}, front, slot);
}

Normal mapped_normal(const TangentFrame& frame, const SurfacePoint& point, Rgba texel, float scale) {
  const UnmappedNormals<Normal> normals{point.shading, point.geometric, point.inside};
  return mapped_normal(frame, normals, Normal(texel.r, texel.g, texel.b), scale, unit_or);
}

Rgba vertex_color(const Mesh& mesh, const Hit& hit) {
  return mesh.colors.empty() ? Rgba(1, 1, 1, 1) : interpolate(mesh.colors, mesh.triangles[hit.primitive], hit);
}

bool is_back_face(const RayObject& object, std::uint32_t primitive, Direction direction) {
  const Mesh& mesh = *object.mesh;
  const auto& triangle = mesh.triangles[primitive];
  const Point& a = mesh.positions[triangle[0]];
  const Normal cross = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
  const bool along = (scaled(cross) * object.normal_to_world).dot(direction) > 0;
  return along != object.flipped;
}

bool is_covered(const RayObject& object, const Hit& hit) {
  const Material& material = *object.material;
  float alpha = material.base_color.a * vertex_color(*object.mesh, hit).a;
  const TextureSlot& slot = material.slot(Slot::base_color);
  if (slot.kind != TextureKind::none) {
    const Point local = interpolate(object.mesh->positions, object.mesh->triangles[hit.primitive], hit);
    alpha *= texture_value(slot, texture_coordinates(object, hit, local, slot), 0).a;
  }
  return alpha >= material.alpha_cutoff;
}

}  // namespace relook
