// The oracle's hits: triangles, textures and normals as src/color/SHADING.md says under "At a hit".
#include <array>
#include <cmath>
#include <optional>

#include "reference_tracer.h"
#include "scene/compile/deformation.h"
#include "scene/compile/displacement.h"
#include "scene/texture/procedural.h"

namespace relook {
namespace {

Imath::V4d values(Rgba c) { return {c.r, c.g, c.b, c.a}; }
Vec to_world(const Object& object, Vec p) {
  Vec out;
  Imath::M44d(object.to_world).multVecMatrix(p, out);
  return out;
}
template <class T>
T mixed(const T& a, const T& b, const T& c, double u, double v) {
  return a * static_cast<float>(1 - u - v) + b * static_cast<float>(u) + c * static_cast<float>(v);
}

/// What SHADING.md calls lift, in the world.
Vec lift_of(const Mesh& mesh, const WorldTriangle& triangle, double u, double v, bool inside,
            const Imath::M44d& world) {
  const auto& vertices = mesh.triangles[triangle.primitive];
  const std::array<double, 3> weights{1 - u - v, u, v};
  Vec p(0, 0, 0), lift(0, 0, 0), in_world;
  for (std::size_t i = 0; i < 3; ++i) p += Vec(mesh.positions[vertices[i]]) * weights[i];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec n = Vec(mesh.normals[vertices[i]]) * (inside ? -1.0 : 1.0);
    lift += n * (weights[i] * std::max((Vec(mesh.positions[vertices[i]]) - p).dot(n), 0.0));
  }
  world.multDirMatrix(lift, in_world);
  return in_world;
}

struct AxisOfMap {
  Vec along_u;  // object space
  bool is_mirrored;
};

double angle_at(const Mesh& mesh, const std::array<std::uint32_t, 3>& t, std::size_t corner, const Vec& n) {
  const Vec p(mesh.positions[t[corner]]);
  Vec a = Vec(mesh.positions[t[(corner + 1) % 3]]) - p, b = Vec(mesh.positions[t[(corner + 2) % 3]]) - p;
  a = (a - n * n.dot(a)).normalized();
  b = (b - n * n.dot(b)).normalized();
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// Of one triangle; none where it has no area in texture coordinates.
std::optional<AxisOfMap> flat_frame(const Mesh& mesh, std::size_t set, const std::array<std::uint32_t, 3>& t) {
  const Imath::V2d d1 = Imath::V2d(mesh.uv[set][t[1]]) - Imath::V2d(mesh.uv[set][t[0]]),
                   d2 = Imath::V2d(mesh.uv[set][t[2]]) - Imath::V2d(mesh.uv[set][t[0]]);
  const Vec e1 = Vec(mesh.positions[t[1]]) - Vec(mesh.positions[t[0]]),
            e2 = Vec(mesh.positions[t[2]]) - Vec(mesh.positions[t[0]]);
  const double det = d1.cross(d2);
  if (det == 0) return std::nullopt;
  return AxisOfMap{(e1 * d2.y - e2 * d1.y) / det, det < 0};
}

/// MikkTSpace, all triangles against all: at each corner the mean over the triangles that have the same vertex there
/// and the same handedness, weighted by their angles; between the corners interpolated.
std::optional<AxisOfMap> smooth_frame(const Mesh& mesh, std::size_t set, std::uint32_t primitive, double u, double v) {
  const auto& own = mesh.triangles[primitive];
  const std::optional<AxisOfMap> flat = flat_frame(mesh, set, own);
  if (!flat || mesh.normals.empty()) return flat ? std::optional(AxisOfMap{flat->along_u, !flat->is_mirrored}) : flat;
  const std::array<double, 3> weights{1 - u - v, u, v};
  Vec sum(0, 0, 0);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec n(mesh.normals[own[c]]);
    Vec tangent(0, 0, 0);
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        if (mesh.positions[t[i]] != mesh.positions[own[c]] || mesh.normals[t[i]] != mesh.normals[own[c]] ||
            mesh.uv[set][t[i]] != mesh.uv[set][own[c]])
          continue;
        const std::optional<AxisOfMap> other = flat_frame(mesh, set, t);
        if (!other || other->is_mirrored != flat->is_mirrored) continue;
        tangent += (other->along_u - n * n.dot(other->along_u)).normalized() * angle_at(mesh, t, i, n);
      }
    sum += tangent.normalized() * weights[c];
  }
  return AxisOfMap{sum, !flat->is_mirrored};
}

}  // namespace

Mesh shaped_mesh(const Scene& scene, const Object& object) {
  const Mesh& mesh = scene.mesh(object.mesh);
  Mesh shaped = object.deformation ? deformed(mesh, *object.deformation) : mesh;
  return object.displacement ? displaced(shaped, *object.displacement) : shaped;
}

std::vector<WorldTriangle> world_triangles(const Scene& scene, std::uint32_t index) {
  const Object& object = scene.objects[index];
  const Mesh mesh = shaped_mesh(scene, object);
  std::vector<WorldTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({to_world(object, Vec(mesh.positions[a])), to_world(object, Vec(mesh.positions[b])),
                         to_world(object, Vec(mesh.positions[c])), index,
                         static_cast<std::uint32_t>(triangles.size())});
  return triangles;
}

LineHit intersect(const WorldTriangle& triangle, Vec origin, Vec direction, double slack) {
  const Vec e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a, p = direction.cross(e2);
  const double det = e1.dot(p);
  LineHit hit;
  if (det == 0) return hit;
  const Vec s = origin - triangle.a, q = s.cross(e1);
  hit = {false, e2.dot(q) / det, s.dot(p) / det, direction.dot(q) / det};
  hit.inside = hit.u >= -slack && hit.v >= -slack && hit.u + hit.v <= 1 + slack;
  return hit;
}

const Mesh& ReferenceTracer::mesh_of(std::uint32_t object) const {
  const auto found = shaped_.find(object);
  return found != shaped_.end() ? found->second : scene_.mesh(scene_.objects[object].mesh);
}

bool ReferenceTracer::is_hole(const WorldTriangle& triangle, double u, double v) const {
  const Material& material = scene_.material(scene_.objects[triangle.object].material);
  if (material.alpha_mode != AlphaMode::mask) return false;
  Surface s = surface_at({&triangle, 0, u, v}, {Vec(0, 0, 0), Vec(0, 0, 1), 0, 0});
  return s.alpha < material.alpha_cutoff;
}

bool ReferenceTracer::is_met(const WorldTriangle& triangle, const LineHit& hit, Vec direction) const {
  const Object& object = scene_.objects[triangle.object];
  if (surface_optics(scene_.material(object.material), mesh_of(triangle.object)).culls_back) {
    const double side = (triangle.b - triangle.a).cross(triangle.c - triangle.a).dot(direction);
    if ((Imath::M44d(object.to_world).determinant() < 0 ? -side : side) > 0) return false;
  }
  return !is_hole(triangle, hit.u, hit.v);
}

Imath::V4d ReferenceTracer::texture(const Surface& s, Slot which) const {
  const TextureSlot& slot = s.material->slot(which);
  if (slot.kind == TextureKind::none) return {1, 1, 1, 1};
  const auto& [i, j, k] = s.mesh->triangles[s.triangle->primitive];
  const auto& column = s.mesh->uv[slot.texcoord];
  if (slot.mapping == Mapping::solid || (column.empty() && slot.kind == TextureKind::procedural)) {
    const Point p = mixed(s.mesh->positions[i], s.mesh->positions[j], s.mesh->positions[k], s.u, s.v);
    return values(evaluate(slot.procedural, p));
  }
  const auto transformed = [&](Imath::V2d uv) {  // KHR_texture_transform: scale, then rotate, then shift
    uv *= Imath::V2d(slot.scale);
    const double cosine = std::cos(double{slot.rotation}), sine = std::sin(double{slot.rotation});
    return Imath::V2d(cosine * uv.x + sine * uv.y, cosine * uv.y - sine * uv.x) + Imath::V2d(slot.offset);
  };
  const Imath::V2d a = transformed(Imath::V2d(column[i])), b = transformed(Imath::V2d(column[j])),
                   c = transformed(Imath::V2d(column[k])), uv = a * (1 - s.u - s.v) + b * s.u + c * s.v;
  const Uv at(static_cast<float>(uv.x), static_cast<float>(uv.y));
  if (slot.kind == TextureKind::procedural) return values(evaluate(slot.procedural, Point(at.x, at.y, 0)));
  const TexturePyramid::Level& full = slot.pyramid->levels.front();
  const double texels = double{1} * full.width * full.height;
  const double uv_area = std::abs((b - a).cross(c - a));
  const double world_area = (s.triangle->b - s.triangle->a).cross(s.triangle->c - s.triangle->a).length();
  const double level = std::log2(s.width / s.incidence) + std::log2(texels * uv_area / world_area) / 2;
  return values(sample(*slot.pyramid, at, s.with_level ? static_cast<float>(level) : 0, slot.sampler));
}

std::optional<ReferenceTracer::Axes> ReferenceTracer::axes(const Surface& s, Slot which) const {
  const TextureSlot& slot = s.material->slot(which);
  const std::optional<AxisOfMap> frame = smooth_frame(*s.mesh, slot.texcoord, s.triangle->primitive, s.u, s.v);
  if (!frame) return std::nullopt;
  const Imath::M44d world(s.object->to_world);
  Vec along_u;
  world.multDirMatrix(frame->along_u, along_u);
  const Vec front = s.inside ? -s.smooth : s.smooth;
  const Vec of_mesh = (along_u - front * front.dot(along_u)).normalized();
  // +Y of a map runs against v: images are stored top row first.
  const bool turns = (world.determinant() < 0) != frame->is_mirrored;
  const Vec against_v = front.cross(of_mesh) * (turns ? -1.0 : 1.0);
  // A step along the map's u is one along u and v of the mesh, by the inverse of KHR_texture_transform.
  const double cosine = std::cos(double{slot.rotation}), sine = std::sin(double{slot.rotation});
  const Vec tangent = (of_mesh * (cosine / slot.scale.x) - against_v * (sine / slot.scale.y)).normalized();
  Vec bitangent = front.cross(tangent);
  if (bitangent.dot(of_mesh * (sine / slot.scale.x) + against_v * (cosine / slot.scale.y)) < 0) bitangent = -bitangent;
  return Axes{tangent, bitangent};
}

Vec ReferenceTracer::bent_normal(const Surface& s, Slot which, double scale) const {
  if (s.material->slot(which).kind == TextureKind::none) return s.smooth;
  const std::optional<Axes> frame = axes(s, which);
  if (!frame) return s.smooth;
  const auto& [tangent, bitangent] = *frame;
  const Vec front = s.inside ? -s.smooth : s.smooth;
  const Imath::V4d texel = texture(s, which);
  const Vec map((2 * texel.x - 1) * scale, (2 * texel.y - 1) * scale, 2 * texel.z - 1);
  const Vec bent = (tangent * map.x + bitangent * map.y + front * map.z).normalized() * (s.inside ? -1.0 : 1.0);
  return bent.dot(s.ng) > 0 ? bent : s.smooth;
}

void ReferenceTracer::read_material(Surface& s) const {
  const Material& m = *s.material;
  Imath::V4d color(m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a);
  color *= texture(s, Slot::base_color);
  if (!s.mesh->colors.empty()) {
    const auto& [i, j, k] = s.mesh->triangles[s.triangle->primitive];
    color *= values(mixed(s.mesh->colors[i], s.mesh->colors[j], s.mesh->colors[k], s.u, s.v));
  }
  s.base = Vec(color.x, color.y, color.z);
  s.alpha = color.w;
  s.coverage = m.alpha_mode == AlphaMode::blend ? s.alpha : 1;
  const Imath::V4d rough = texture(s, Slot::metallic_roughness);
  s.metallic = m.metallic * rough.z;
  s.roughness = m.roughness * rough.y;
  s.occlusion = 1 + m.occlusion_strength * (texture(s, Slot::occlusion).x - 1);
  s.transmission = m.transmission * texture(s, Slot::transmission).x;
}

ReferenceTracer::Surface ReferenceTracer::surface_at(const Found& found, const Ray& ray) const {
  Surface s{};
  s.triangle = found.triangle;
  s.object = &scene_.objects[found.triangle->object];
  s.mesh = &mesh_of(found.triangle->object);
  s.material = &scene_.material(s.object->material);
  s.optics = surface_optics(*s.material, *s.mesh);
  s.u = found.u;
  s.v = found.v;
  s.p = s.triangle->a * (1 - s.u - s.v) + s.triangle->b * s.u + s.triangle->c * s.v;
  Vec front = (s.triangle->b - s.triangle->a).cross(s.triangle->c - s.triangle->a).normalized();
  const Imath::M44d world(s.object->to_world);
  if (world.determinant() < 0) front = -front;
  s.inside = front.dot(ray.direction) > 0;
  s.ng = s.inside ? -front : front;
  s.view = -ray.direction;
  s.incidence = std::abs(s.ng.dot(ray.direction));
  s.width = ray.width + ray.spread * found.t;
  s.with_level = s.width > 0;
  s.n = s.ng;
  s.lift = Vec(0, 0, 0);
  if (!s.mesh->normals.empty()) {
    const auto& [i, j, k] = s.mesh->triangles[s.triangle->primitive];
    world.inverse().transposed().multDirMatrix(
        Vec(s.mesh->normals[i]) * (1 - s.u - s.v) + Vec(s.mesh->normals[j]) * s.u + Vec(s.mesh->normals[k]) * s.v, s.n);
    s.n.normalize();
    if (s.n.dot(s.ng) < 0) s.n = -s.n;
    s.lift = lift_of(*s.mesh, *s.triangle, s.u, s.v, s.inside, world);
  }
  s.smooth = s.n;
  read_material(s);
  const Vec coat = bent_normal(s, Slot::clearcoat_normal, s.material->clearcoat_normal_scale);
  s.n = bent_normal(s, Slot::normal, s.material->normal_scale);
  s.nc = coat;
  return s;
}

}  // namespace relook
