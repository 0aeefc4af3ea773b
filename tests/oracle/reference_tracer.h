// The oracle of the picture: src/color/SHADING.md once more, slow and obvious. Double precision, brute force over all
// triangles, recursive, one sample in the middle of each pixel. Shares no code with the renderer beyond what the
// specification takes as given: texture and procedural values, camera rays, surface_optics, deformed and displaced
// meshes.
#pragma once
#include <ImathVec.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "frame/image.h"
#include "scene/scene.h"
#include "scene/surface_optics.h"

namespace relook {

using Vec = Imath::V3d;  // also a colour: Imath multiplies componentwise

[[nodiscard]] inline Vec color_of(Color c) { return {c.x, c.y, c.z}; }
[[nodiscard]] inline Vec grey(double x) { return {x, x, x}; }
[[nodiscard]] inline double largest(const Vec& c) { return std::max({c.x, c.y, c.z}); }

/// A triangle of a living object in world space.
struct WorldTriangle {
  Vec a, b, c;
  std::uint32_t object = 0, primitive = 0;
};

/// The mesh of an object, deformed and displaced.
[[nodiscard]] Mesh shaped_mesh(const Scene& scene, const Object& object);
/// Triangles of one object, deformed and displaced, in world space.
[[nodiscard]] std::vector<WorldTriangle> world_triangles(const Scene& scene, std::uint32_t object);

/// Where the line origin + t * direction meets the triangle's plane; `inside` when the barycentrics are >= -slack.
struct LineHit {
  bool inside = false;
  double t = 0, u = 0, v = 0;  // u, v: weights of b and c
};
[[nodiscard]] LineHit intersect(const WorldTriangle& triangle, Vec origin, Vec direction, double slack = 0);

class ReferenceTracer {
 public:
  ReferenceTracer(const Scene& scene, std::uint32_t max_depth);

  struct Ray {
    Vec origin, direction;
    double width = 0, spread = 0;  // of the ray cone
    std::uint32_t generation = 1;
    double fresnel = 1;  // product of the dielectric Fresnel terms so far
    int channel = -1;    // of the light that counts; -1: all
  };
  struct Answer {
    Vec color{0, 0, 0};
    double alpha = 0;
    double distance = 0;  // to the hit; 0 where the ray left the scene
  };
  [[nodiscard]] Answer trace(const Ray& ray) const;
  [[nodiscard]] Frame frame() const;

 private:
  /// Everything that a hit knows.
  struct Surface {
    const WorldTriangle* triangle;
    const Object* object;
    const Mesh* mesh;
    const Material* material;
    SurfaceOptics optics;
    double u, v, width, incidence;  // incidence: |d . Ng|
    bool inside, with_level;
    Vec p, ng, n, nc, view;
    Vec smooth, lift;  // the interpolated normal; towards the surface that the vertex normals stand for
    // from the textures
    Vec base;
    double alpha, coverage, metallic, roughness, occlusion, transmission;
  };
  struct Found {
    const WorldTriangle* triangle = nullptr;
    double t = 0, u = 0, v = 0;
  };

  [[nodiscard]] bool is_hole(const WorldTriangle& triangle, double u, double v) const;
  /// Is there a surface for a ray in this direction?
  [[nodiscard]] bool is_met(const WorldTriangle& triangle, const LineHit& hit, Vec direction) const;
  [[nodiscard]] Found nearest(Vec origin, Vec direction) const;
  [[nodiscard]] Surface surface_at(const Found& found, const Ray& ray) const;
  [[nodiscard]] Imath::V4d texture(const Surface& s, Slot slot) const;
  struct Axes {
    Vec tangent, bitangent;
  };
  /// Of a map, for the front of the surface.
  [[nodiscard]] std::optional<Axes> axes(const Surface& s, Slot slot) const;
  [[nodiscard]] Vec bent_normal(const Surface& s, Slot slot, double scale) const;
  /// D V of the base layer, and the roughness that fades its mirror.
  [[nodiscard]] double specular_lobe(const Surface& s, Vec toward, double nl, double nv) const;
  [[nodiscard]] double mirror_roughness(const Surface& s) const;
  void read_material(Surface& s) const;

  [[nodiscard]] Vec tint_of(const Found& crossing, Vec direction, double inside_length, double footprint) const;
  /// What reaches `p` from a light through the tinted crossings; 0 behind an opaque blocker.
  [[nodiscard]] Vec visibility(Vec p, Vec toward, double distance, double footprint) const;
  struct Arriving {
    Vec toward, irradiance;
  };
  [[nodiscard]] std::vector<Arriving> lamps(const Surface& s) const;

  [[nodiscard]] Answer spawn(const Surface& s, const Ray& ray, Vec direction, double fresnel) const;
  [[nodiscard]] Vec beer(const Surface& s, bool runs_inside, const Answer& answer) const;
  [[nodiscard]] Vec environment(Vec direction) const;
  [[nodiscard]] Vec reflected(const Surface& s, Vec normal) const;
  [[nodiscard]] Vec metallic_roughness(const Surface& s, const Ray& ray) const;
  /// The same as if the index of refraction were that of one channel; -1: of the middle.
  [[nodiscard]] Vec metallic_roughness_of(int channel, const Surface& s, const Ray& ray) const;
  /// The refracted direction, if any: about the triangle's own normal where, inside, the bent one lets no light out.
  [[nodiscard]] static std::optional<Vec> refracted_way(const Surface& s, double ior);
  [[nodiscard]] Vec blinn_phong(const Surface& s, const Ray& ray) const;

  const Scene& scene_;
  std::uint32_t max_depth_;
  std::vector<WorldTriangle> triangles_;
  std::map<std::uint32_t, Mesh> shaped_;  // by object: deformed and displaced

  [[nodiscard]] const Mesh& mesh_of(std::uint32_t object) const;
};

/// Directional albedo of the sheen lobe, at most 1: integrated over the hemisphere at the nodes of a grid of 10 x 10
/// over sqrt(cosine) and roughness, linear in between.
[[nodiscard]] double sheen_albedo(double cosine, double roughness);

}  // namespace relook
