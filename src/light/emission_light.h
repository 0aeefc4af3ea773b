// The triangles of an emitting material as a light: points on them, chosen by area times mean luminance of the emission
// image, one in ten by area alone, and then evenly over the triangle. Plain data, no rays, no materials. Pure
// functions, with the same bits on every machine.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/math.h"
#include "light/table_sampling.h"
#include "scene/texture/texture.h"

namespace relook {

struct EmissionTriangle {
  std::array<Point, 3> at;  // world; counter-clockwise from where it shines
  float mean = 1;           // luminance of the emission image, at least 0; factors ignored
  bool two_sided = false;   // the back shines, too
};

class EmissionLight {
 public:
  /// A point on a triangle, seen from somewhere.
  struct Emitter {
    std::uint32_t triangle = 0;
    float b1 = 0, b2 = 0;  // barycentrics of the second and the third corner
    Point at;              // world
    Direction way;         // unit, towards it
    float distance = 0;    // metres
    float density = 0;     // per steradian
  };

  /// Triangles without area, or with corners that are not finite, are never chosen.
  explicit EmissionLight(std::vector<EmissionTriangle> triangles);

  [[nodiscard]] bool empty() const { return choice_.empty(); }
  /// For a point of the unit square. None: the chosen point shows `from` its dark back, its edge, or is where it is.
  [[nodiscard]] std::optional<Emitter> sample(const Point& from, Uv u) const;
  /// The density per steradian with which sample() gives the point that a ray from `from` along the unit `way` meets
  /// after `distance`; 0 where it gives none.
  [[nodiscard]] float density(std::uint32_t triangle, const Point& from, const Direction& way, float distance) const;

 private:
  /// Per triangle what densities need.
  struct Facet {
    Normal normal;       // unit, on the side that shines; 0 where never chosen
    float per_area = 0;  // density per square metre
  };
  std::vector<EmissionTriangle> triangles_;
  std::vector<Facet> facets_;
  DiscreteDistribution choice_;
};

/// About the mean luminance of an image over a triangle of texture coordinates: the mean of four lookups, in the
/// middles of its quarters, at the level whose texels are about as large as a quarter. Negative values count as 0. It
/// only steers what is sampled.
[[nodiscard]] float mean_luminance(const TexturePyramid& pyramid, const std::array<Uv, 3>& uv,
                                   const TextureSampler& sampler);

}  // namespace relook
