// Points on lights: their densities are densities, agree with those of rays that cross, and give the closed forms.
#include "light/light_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "light/point_set.h"
#include "pi.h"

namespace relook {
namespace {

/// Sums of a mean whose error is estimated from the values themselves.
struct Mean {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    n += 1;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double value() const { return sum / n; }
  [[nodiscard]] double deviation() const { return std::sqrt(std::max(0.0, squares / n - value() * value()) / n); }
};

/// Independent points, one of each pixel.
Uv random_point(std::uint32_t i) { return sample_point({pixel_key(i, 77), 0}, 3, Purpose::light); }
/// Points 0.. of one sequence.
Uv even_point(std::uint32_t i) { return sample_point({5, i}, 3, Purpose::light); }

struct Case {
  std::string name;
  LightShape shape;
  Point from;
  bool is_planar = true;
};

std::vector<Case> cases() {
  const RectShape rect({0.5F, 2, -1}, {0.8F, 0, 0}, {0, 0, 0.5F});  // shines down
  const DiskShape disk({0, 2, 0}, {0.7F, 0, 0}, {0, 0, 0.7F});
  const Point a(-1, 2, -1), b(1, 2.5F, -1), c(0, 2, 1);
  return {
      {"sphere", SphereShape({1, 2, 3}, 1.5F), {0, 0, 0}, false},
      {"sphere, nearly touched", SphereShape({1, 2, 3}, 1.5F), {1, 0.499F, 3}, false},
      {"sphere, from inside", SphereShape({1, 2, 3}, 1.5F), {1.2F, 2.5F, 3.9F}, false},
      {"sphere, from its center", SphereShape({1, 2, 3}, 1.5F), {1, 2, 3}, false},
      {"rect", rect, {0, 0, 0}},
      {"rect, from next to it", rect, {0.4F, 1.99F, -1.1F}},
      {"rect, from above a side", rect, {1.3F, 1.5F, -1.2F}},
      {"rect, at a slant", rect, {-2, 1.8F, 1}},
      {"rect, turned", RectShape({0, 0, -3}, {1, 1, 0}, {-0.5F, 0.5F, 0.5F}), {0.3F, 0.2F, 1}},
      {"rect, skewed", RectShape({0, 0, -3}, {1, 0.4F, 0}, {0, 1, 0}), {0.3F, 0.2F, 0}},
      {"disk", disk, {0.2F, 0.5F, -0.3F}},
      {"ellipse", DiskShape({0, 2, 0}, {0.7F, 0, 0.1F}, {0, 0, 0.4F}), {0.9F, 0, 0}},
      {"triangle", TriangleShape(a, b, c, Sides::front), {0.2F, 0.5F, -0.3F}},
      {"triangle, from behind", TriangleShape(a, b, c, Sides::both), {0.2F, 4, -0.3F}},
      {"sky disc", SkyDisc({1, 2, -0.5F}, versine_of(0.4F)), {1, 2, 3}, false},
      {"half of the sky", SkyDisc({0, 0, -1}, 1), {1, 2, 3}, false},
  };
}

TEST(LightShape, DensityIntegratesToOne) {
  const ShapeFrame any = shape_frame_around({0, 0, 1});
  for (const Case& it : cases()) {
    Mean mean;
    for (std::uint32_t i = 0; i < 200000; ++i) {
      const Direction way = narrow(cone_direction(any, 2, random_point(i)));
      mean.add(cross(it.shape, it.from, way) ? density(it.shape, it.from, way) * 4 * kPi : 0.0);
    }
    EXPECT_NEAR(mean.value(), 1, 5 * mean.deviation() + 1e-4) << it.name;
  }
}

TEST(LightShape, SamplesAreWhereRaysCross) {
  for (const Case& it : cases()) {
    int missed = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const std::optional<LightPoint> point = sample(it.shape, it.from, even_point(i));
      ASSERT_TRUE(point) << it.name;
      EXPECT_NEAR(point->direction.dot(point->direction), 1, 3e-7F);
      EXPECT_EQ(point->density, density(it.shape, it.from, point->direction)) << it.name;
      const std::optional<float> distance = cross(it.shape, it.from, point->direction);
      if (!distance)
        ++missed;  // rounded over an edge
      else if (std::isinf(*distance))
        EXPECT_EQ(*distance, point->distance);
      else
        EXPECT_NEAR(*distance, point->distance, (it.is_planar ? 1e-5F : 1e-3F) * *distance) << it.name;
    }
    EXPECT_LE(missed, 2) << it.name;
  }
}

TEST(LightShape, WhatCannotFaceAPlaceHasNoSampleAboveItsHorizon) {
  const ShapeFrame any = shape_frame_around({0, 0, 1});
  int below = 0, dark = 0;
  for (const Case& it : cases())
    for (std::uint32_t i = 0; i < 4000; ++i) {
      const Direction normal = narrow(cone_direction(any, 2, random_point(i)));
      const Uv at = random_point(i + 4000), height = random_point(i + 8000);
      const Point from = it.from + Point(at.x - 0.5F, at.y - 0.5F, height.x - 0.5F) * (i % 2 == 0 ? 0.01F : 6.0F);
      const auto point = sample(it.shape, from, even_point(i));
      dark += shines_at(it.shape, from) ? 0 : 1;
      below += is_below(it.shape, from, normal) ? 1 : 0;
      EXPECT_TRUE(!point || shines_at(it.shape, from)) << it.name;
      EXPECT_TRUE(!point || !is_below(it.shape, from, normal) || normal.dot(point->direction) <= 0) << it.name;
    }
  EXPECT_GT(below, 10000);
  EXPECT_GT(dark, 3000);
}

TEST(LightShape, SamplesHaveTheirDensity) {
  // Of directions, the share that falls into a half space and a cone must be what the density says.
  const ShapeFrame any = shape_frame_around({0, 0, 1});
  for (const Case& it : cases()) {
    const std::optional<LightPoint> middle = sample(it.shape, it.from, {0.4F, 0.35F});
    ASSERT_TRUE(middle);
    const Direction tilted = Direction(0.1F, -0.05F, 0.08F) + middle->direction;
    const auto is_inside = [&](const Direction& way) {
      return way.cross(tilted).x > 0 || way.dot(middle->direction) > 0.98F;
    };
    Mean sampled, integrated;
    for (std::uint32_t i = 0; i < 200000; ++i) {
      const Direction way = narrow(cone_direction(any, 2, random_point(i)));
      const bool counts = is_inside(way) && cross(it.shape, it.from, way);
      integrated.add(counts ? density(it.shape, it.from, way) * 4 * kPi : 0.0);
      const std::optional<LightPoint> point = sample(it.shape, it.from, random_point(i + 1000000));
      ASSERT_TRUE(point);
      sampled.add(is_inside(point->direction) ? 1 : 0);
    }
    EXPECT_NEAR(sampled.value(), integrated.value(), 5 * std::hypot(sampled.deviation(), integrated.deviation()) + 1e-4)
        << it.name;
  }
}

/// Of a surface at the origin under light of radiance 1: the mean of cosine / density over 65536 points must be this,
/// by independent points within 5 deviations, by even ones within 1e-3.
void expect_irradiance(const LightShape& shape, const Normal& normal, double expected, const std::string& name) {
  constexpr std::uint32_t kPoints = 1U << 16U;
  const Point origin(0, 0, 0);
  Mean random, even;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    for (const bool is_even : {false, true}) {
      const std::optional<LightPoint> point = sample(shape, origin, is_even ? even_point(i) : random_point(i));
      const double value = point ? std::max(0.0F, normal.dot(point->direction)) / double{point->density} : 0.0;
      (is_even ? even : random).add(value);
    }
  }
  EXPECT_NEAR(random.value(), expected, 5 * random.deviation() + 1e-6 * expected) << name;
  EXPECT_NEAR(even.value(), expected, 1e-3 * expected) << name;
}

/// Lambert's formula for a polygon above the horizon: half the sum over the edges of their angle times the cosine of
/// the normal of the plane through edge and place.
double polygon_irradiance(const std::vector<Wide>& corners, const Normal& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Wide &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const Wide both = a.cross(b);
    sum += std::atan2(length_of(both), a.dot(b)) * (both * (1 / length_of(both))).dot(wide(normal));
  }
  return std::fabs(sum) / 2;
}

TEST(LightShape, RectanglesGiveLambertsIrradiance) {
  const Normal up(0, 1, 0), slanted = Normal(0.2F, 1, -0.1F).normalized();
  const auto expect = [&](const Point& c, const Direction& x, const Direction& y, const Normal& n, const char* name) {
    expect_irradiance(RectShape(c, x, y), n,
                      polygon_irradiance({wide(c + x + y), wide(c - x + y), wide(c - x - y), wide(c + x - y)}, n),
                      name);
  };
  expect({0, 1, 0}, {0.5F, 0, 0}, {0, 0, 0.5F}, up, "above");
  expect({0.2F, 0.05F, 0.3F}, {0.5F, 0, 0}, {0, 0, 0.5F}, up, "close");
  expect({3, 2, 1}, {0.5F, 0, 0}, {0, 0, 1.5F}, slanted, "aside");
  expect({3, 2, 1}, {0.5F, -0.5F, 0}, {0, 0, 1.5F}, up, "turned");
  expect({0, 300, 40}, {0.1F, 0, 0}, {0, 0, 0.2F}, slanted, "far");
  // Its solid angle is next to that from which on it is sampled by area.
  expect({0, 1000, 0}, {0.49F, 0, 0}, {0, 0, 0.5F}, up, "below the limit");
  expect({0, 1000, 0}, {0.51F, 0, 0}, {0, 0, 0.5F}, up, "above the limit");
}

TEST(LightShape, RectanglesHaveTheirSolidAngle) {
  // A face of a cube, from its center: a sixth of all directions.
  const RectShape face({0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(1 / face.density({0, 0, 0}, {0, 1, 0}), 4 * kPi / 6, 1e-6);
  // An unbounded plane: half of them.
  const RectShape plane({0, 1, 0}, {9e4F, 0, 0}, {0, 0, 9e4F});
  EXPECT_NEAR(1 / plane.density({0, 0, 0}, {0, 1, 0}), 2 * kPi, 1e-4);
}

TEST(LightShape, TrianglesGiveLambertsIrradiance) {
  const Normal up(0, 1, 0);
  const Point a(-1, 2, -1), b(1, 2.5F, -1), c(0, 2, 1);
  for (const Sides sides : {Sides::front, Sides::both})
    expect_irradiance(TriangleShape(a, b, c, sides), up, polygon_irradiance({wide(a), wide(b), wide(c)}, up), "down");
  expect_irradiance(TriangleShape(a, c, b, Sides::front), up, 0, "front away");
  expect_irradiance(TriangleShape(a, c, b, Sides::both), up, polygon_irradiance({wide(a), wide(b), wide(c)}, up),
                    "both");
}

TEST(LightShape, DisksGiveTheirFormFactor) {
  const Normal up(0, 1, 0);
  const auto disk = [](float aside, float height, float radius) {
    return DiskShape({aside, height, 0}, {radius, 0, 0}, {0, 0, radius});
  };
  for (const float height : {0.5F, 1.0F, 20.0F})
    expect_irradiance(disk(0, height, 0.7F), up, kPi * 0.49 / (0.49 + square(double{height})), "above");
  // Aside by a: with H = h/a, R = r/a, Z = 1 + H^2 + R^2 the form factor is (1 - (Z - 2 R^2) / sqrt(Z^2 - 4 R^2)) / 2
  // (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-13).
  for (const double aside : {0.5, 2.0}) {
    const double r2 = square(0.75 / aside), z = 1 + square(1.5 / aside) + r2;
    expect_irradiance(disk(static_cast<float>(aside), 1.5F, 0.75F), up,
                      kPi / 2 * (1 - (z - 2 * r2) / std::sqrt(z * z - 4 * r2)), "aside");
  }
}

TEST(LightShape, SpheresGiveTheirFormFactor) {
  const Normal up(0, 1, 0);
  for (const Point& center : {Point(0, 2, 0), Point(1, 2, 0.5F), Point(0, 1.01F, 0), Point(3e4F, 5e4F, 0)})
    expect_irradiance(SphereShape(center, 1), up,
                      kPi / wide(center).dot(wide(center)) * center.y / length_of(wide(center)), "sphere");
  // From inside, radiance 1 from everywhere.
  expect_irradiance(SphereShape({0.1F, 0.5F, 0.2F}, 1), up, kPi, "inside");
}

TEST(LightShape, SkyDiscsGiveTheirFormFactor) {
  const Normal up(0, 1, 0);
  for (const float angle : {0.00465F, 0.3F, 0.9F})
    expect_irradiance(SkyDisc({0.2F, 1, -0.1F}, versine_of(angle)), up,
                      kPi * square(std::sin(double{angle})) / std::sqrt(1.05), "sky disc");
}

TEST(LightShape, ShinesFromItsFrontOnly) {
  const Point above(0, 3, 0), below(0, 1, 0), beside(5, 2, 0);
  const Direction up(0, 1, 0), down(0, -1, 0);
  const std::vector<LightShape> shapes{RectShape({0, 2, 0}, {1, 0, 0}, {0, 0, 1}),
                                       DiskShape({0, 2, 0}, {1, 0, 0}, {0, 0, 1}),
                                       TriangleShape({-1, 2, -1}, {1, 2, -1}, {0, 2, 1}, Sides::front)};
  for (const LightShape& shape : shapes) {
    EXPECT_TRUE(sample(shape, below, {0.3F, 0.6F}));
    EXPECT_GT(density(shape, below, up), 0);
    ASSERT_TRUE(cross(shape, below, up));
    EXPECT_FLOAT_EQ(*cross(shape, below, up), 1);
    EXPECT_FALSE(cross(shape, below, down));
    for (const Point& from : {above, beside}) {
      EXPECT_FALSE(sample(shape, from, {0.3F, 0.6F}));
      EXPECT_EQ(density(shape, from, down), 0);
      EXPECT_FALSE(cross(shape, from, down));
    }
  }
  const LightShape both = TriangleShape({-1, 2, -1}, {1, 2, -1}, {0, 2, 1}, Sides::both);
  EXPECT_TRUE(sample(both, above, {0.3F, 0.6F}));
  EXPECT_TRUE(cross(both, above, down));
  EXPECT_FALSE(sample(both, beside, {0.3F, 0.6F}));
}

TEST(LightShape, CrossesAreWithinTheOutline) {
  const Point origin(0, 0, 0);
  const auto crosses = [&](const LightShape& shape, const Point& through) {
    return cross(shape, origin, through.normalized()).has_value();
  };
  const RectShape rect({1, 2, 0}, {1, 0, 0}, {0, 0, 0.5F});
  EXPECT_TRUE(crosses(rect, {1.99F, 2, 0.49F}));
  EXPECT_FALSE(crosses(rect, {2.01F, 2, 0.49F}));
  EXPECT_FALSE(crosses(rect, {1.99F, 2, 0.51F}));
  const DiskShape disk({1, 2, 0}, {1, 0, 0}, {0, 0, 0.5F});
  EXPECT_TRUE(crosses(disk, {1.7F, 2, 0.35F}));
  EXPECT_FALSE(crosses(disk, {1.72F, 2, 0.36F}));
  const TriangleShape triangle({-1, 2, -1}, {1, 2, -1}, {0, 2, 1}, Sides::front);
  EXPECT_TRUE(crosses(triangle, {0.49F, 2, 0}));
  EXPECT_FALSE(crosses(triangle, {0.51F, 2, 0}));
  const SphereShape sphere({0, 4, 0}, 2);
  EXPECT_TRUE(crosses(sphere, {0.99F, std::sqrt(3.0F), 0}));
  EXPECT_FALSE(crosses(sphere, {1.01F, std::sqrt(3.0F), 0}));
  EXPECT_FALSE(crosses(sphere, {0, -1, 0}));
  const SkyDisc sun({0, 1, 0}, versine_of(0.005F));
  EXPECT_TRUE(crosses(sun, {0.00499F, 1, 0}));
  EXPECT_FALSE(crosses(sun, {0.00501F, 1, 0}));
}

TEST(LightShape, DegenerateOnesGiveNoneOrNumbers) {
  std::vector<LightShape> shapes;
  for (const float size : {0.0F, 1e-30F, 1e-6F, 1.0F, 1e6F, 1e15F, 1e30F})
    for (const float far : {0.0F, 1e-20F, 1.0F, 1e9F, 1e30F}) {
      const Point center(far, 0, 0);
      shapes.emplace_back(SphereShape(center, size));
      shapes.emplace_back(RectShape(center, {size, 0, 0}, {0, 0, size}));
      shapes.emplace_back(RectShape(center, {size, 0, 0}, {size, 0, 0}));
      shapes.emplace_back(RectShape(center, {0, 0, 0}, {0, 0, size}));
      shapes.emplace_back(DiskShape(center, {size, 0, 0}, {0, 0, 2 * size}));
      for (const Sides sides : {Sides::front, Sides::both}) {
        shapes.emplace_back(TriangleShape(center, center + Point(size, 0, 0), center + Point(0, 0, size), sides));
        shapes.emplace_back(TriangleShape(center, center, center, sides));
      }
    }
  for (const float versine : {0.0F, 1e-40F, 1e-12F, 1.0F, 2.0F}) shapes.emplace_back(SkyDisc({0, 0, 2}, versine));
  std::size_t points = 0;
  for (const LightShape& shape : shapes)
    for (const float y : {0.0F, 1e-40F, -1e-30F, -1e-6F, -1.0F, 1.0F, -1e10F, 1e30F})
      for (const float x : {0.0F, 0.3F, 1e10F})
        for (const Uv& u : {Uv(0, 0), Uv(0.5F, 0.5F), Uv(0x1.fffffep-1F, 0.3F), Uv(0.25F, 0x1.fffffep-1F)}) {
          const Point from(x, y, x / 3);
          const std::optional<LightPoint> point = sample(shape, from, u);
          for (const Direction& way : {Direction(0, 1, 0), Direction(0.6F, -0.8F, 0), Direction(0, 0, 1)}) {
            const float at = density(shape, from, way);
            EXPECT_TRUE(at >= 0 && std::isfinite(at));
            const std::optional<float> distance = cross(shape, from, way);
            EXPECT_FALSE(distance && !(*distance >= 0));
          }
          if (!point) continue;
          ++points;
          EXPECT_NEAR(point->direction.dot(point->direction), 1, 1e-6F);
          EXPECT_TRUE(point->density > 0 && std::isfinite(point->density));
          EXPECT_GE(point->distance, 0);
          EXPECT_EQ(point->density, density(shape, from, point->direction));
        }
  EXPECT_GT(points, 1000U);
}

TEST(LightShape, SmallAndFarOnesKeepTheirDigits) {
  // The sun as a sphere: 1.5e11 m away, of radius 7e8 m; and a pinhead a hundred kilometres away.
  const double sine2 = square(7e8 / 1.5e11);
  const double sun = 1 / (2 * kPi * (1 - std::sqrt(1 - sine2)));
  EXPECT_NEAR(SphereShape({0, 1.5e11F, 0}, 7e8F).density({0, 0, 0}, {0, 1, 0}), sun, 1e-5 * sun);
  EXPECT_NEAR(SkyDisc({0, 1, 0}, versine_of(static_cast<float>(std::asin(7e8 / 1.5e11)))).density({}, {0, 1, 0}), sun,
              1e-5 * sun);
  const double pinhead = 1e10 / (kPi * 1e-6);
  const SphereShape sphere({0, 1e5F, 0}, 1e-3F);
  EXPECT_NEAR(sphere.density({0, 0, 0}, {0, 1, 0}), pinhead, 1e-5 * pinhead);
  ASSERT_TRUE(sphere.cross({0, 0, 0}, {0, 1, 0}));
  EXPECT_FLOAT_EQ(*sphere.cross({0, 0, 0}, {0, 1, 0}), 1e5F);
}

}  // namespace
}  // namespace relook
