// The oracle of the integrator `path`: a small path tracer of its own, after src/color/PATH.md but by other techniques.
// Double precision, brute force over triangles, random numbers, no buckets: half vectors of a lobe's own alpha, all
// lobes equally likely. Lights with a size are found by samples alone for wide lobes and by rays alone for narrow ones;
// suns by rays alone. Materials without textures: metallic-roughness without sheen, film, brush and dispersion, and
// unlit.
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "reference_tracer.h"

namespace relook {

class PathReference {
 public:
  explicit PathReference(const Scene& scene, unsigned diffuse_depth = 0, unsigned max_depth = 6, unsigned glossy_depth = 4);

  struct Pixel {
    Vec mean{0, 0, 0};
    Vec variance{0, 0, 0};  // of the mean
  };
  /// From so many samples at random places in each, row by row.
  [[nodiscard]] std::vector<Pixel> pixels(unsigned samples, std::uint64_t seed) const;

 protected:
  struct Ray {
    Vec origin, way;
    unsigned generation = 1, glossy = 0, diffuse = 0;
    unsigned straight = 0;  // rays by coverage, the eye's or those behind the first scattering
    double fresnel = 1, floor = 0;
    const Object* from = nullptr;      // that scattered it last
    const Material* within = nullptr;  // the volume that it runs in
    bool is_eye = true;                // nothing has turned it
    bool meets_lights = true;          // its lobe is narrow, or none sent it
    bool gathers = false;
    bool has_lamps = false;            // segments of what sent it reach lamps through all that transmits
  };
  struct Found {
    const WorldTriangle* triangle = nullptr;
    double t = 0, u = 0, v = 0;
  };
  struct Surface;
  using Random = std::mt19937_64;

  [[nodiscard]] bool is_met(const WorldTriangle& triangle, const Vec& way) const;
  [[nodiscard]] Ray eye_ray(double across, double down) const;
  [[nodiscard]] Found nearest(const Vec& origin, const Vec& way) const;
  [[nodiscard]] Surface surface_at(const Found& found, const Vec& way, double floor) const;
  /// What the straight way to a light lets through.
  /// `is_sized`: single-sided surfaces are met as a ray meets them, else as the light of a lamp does.
  [[nodiscard]] Vec passed(const Vec& from, const Vec& way, double distance, bool is_sized) const;

  [[nodiscard]] Vec surroundings(const Ray& ray) const;
  /// Where a segment to a light at `way` leaves a surface.
  [[nodiscard]] static Vec segment_origin(const Surface& s, const Vec& way);

  const Scene& scene_;
  unsigned diffuse_depth_, max_depth_, glossy_depth_;

 private:
  /// Some triangles of an object, [first, end), and a sphere around them.
  struct Part {
    std::size_t first, end;
    Vec middle;
    double radius2;
  };
  template <class Visitor>
  void visit_crossings(const Vec& origin, const Vec& way, const Visitor& visit) const;

  [[nodiscard]] Vec radiance(const Ray& ray, Random& random) const;
  [[nodiscard]] Vec crossed(const Ray& ray, double end) const;
  [[nodiscard]] Vec gathered(const Surface& s, const Ray& ray, Random& random) const;
  [[nodiscard]] Vec of_light(const Light& light, const Surface& s, const Ray& ray, Random& random) const;
  [[nodiscard]] Vec scattered(const Surface& s, const Ray& ray, Random& random) const;
  [[nodiscard]] Vec refracted(const Surface& s, const Ray& ray, Random& random) const;

  std::vector<WorldTriangle> triangles_;
  std::vector<Part> parts_;
};

}  // namespace relook
