// Shafts between two boxes (paper 3.4.2): what they hold, which boxes their planes reject, and how large their surface
// is, against random segments and closed forms.
#include "region/shaft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace relook {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  Point point(const Box& box) {
    return Point(number(box.min.x, box.max.x), number(box.min.y, box.max.y), number(box.min.z, box.max.z));
  }
  Box box(float largest) {
    const Point corner(number(-4, 4), number(-4, 4), number(-4, 4));
    return Box(corner, corner + Point(number(0, largest), number(0, largest), number(0, largest)));
  }
  Box box_in(const Box& outer) {
    Box box;
    box.extendBy(point(outer));
    box.extendBy(point(outer));
    return box;
  }
  /// Ends of all kinds: boxes, flat ones, points.
  Shaft shaft() {
    const float sizes[] = {0, 0.5F, 3};
    return {box(sizes[engine_() % 3]), box(sizes[engine_() % 3])};
  }

 private:
  std::mt19937 engine_;
};

// The paper's test (3.4.2): trivial rejections by the planes of the shaft.

bool is_clear_of_bounds(const Shaft& shaft, const Box& box) {
  Box around = shaft.from;
  around.extendBy(shaft.to);
  return !around.intersects(box);
}

double bound(const Box& box, int axis, bool upper) {
  return static_cast<double>(upper ? box.max[axis] : box.min[axis]);
}

/// The plane along the third axis through the corners (i_upper, j_upper) of both boxes' rectangles, if each box holds
/// one of the two faces that meet there: does it have all of `box` outside?
bool rejects(const Shaft& shaft, const Box& box, int i, int j, bool i_upper, bool j_upper) {
  const double fi = bound(shaft.from, i, i_upper), fj = bound(shaft.from, j, j_upper);
  const double ti = bound(shaft.to, i, i_upper), tj = bound(shaft.to, j, j_upper);
  const bool from_is_outer_in_i = i_upper ? fi > ti : fi < ti, from_is_outer_in_j = j_upper ? fj > tj : fj < tj;
  if (fi == ti || fj == tj || from_is_outer_in_i == from_is_outer_in_j) return false;
  // The normal, across the line from one corner to the other, on the side of the corner that both leave out.
  double ni = tj - fj, nj = fi - ti;
  const double outward_i = i_upper ? 1 : -1;
  if (ni * outward_i < 0) {
    ni = -ni;
    nj = -nj;
  }
  const double nearest = ni * bound(box, i, ni < 0) + nj * bound(box, j, nj < 0);
  return nearest > ni * fi + nj * fj;
}

bool is_rejected_by_planes(const Shaft& shaft, const Box& box) {
  if (is_clear_of_bounds(shaft, box)) return true;
  for (int axis = 0; axis < 3; ++axis)
    for (unsigned corner = 0; corner < 4; ++corner)
      if (rejects(shaft, box, axis, (axis + 1) % 3, (corner & 1U) != 0, (corner & 2U) != 0)) return true;
  return false;
}

TEST(Shaft, EverySegmentBetweenTheBoxesIsInside) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Shaft shaft = random.shaft();
    for (int k = 0; k < 10; ++k) {
      const Point a = random.point(shaft.from), b = random.point(shaft.to);
      const Point at = a + (b - a) * random.number(0, 1), around(1e-5F, 1e-5F, 1e-5F);
      const Box box(at - around, at + around);
      EXPECT_TRUE(touches(shaft, box));
      EXPECT_FALSE(is_rejected_by_planes(shaft, box));
    }
  }
}

/// Is there a point of the box that lies between points of the shaft's ends, for one of many t?
bool has_common_point(const Shaft& shaft, const Box& box) {
  constexpr int kSteps = 4000;
  for (int k = 0; k <= kSteps; ++k) {
    const float t = static_cast<float>(k) / kSteps;
    const Box at(shaft.from.min * (1 - t) + shaft.to.min * t, shaft.from.max * (1 - t) + shaft.to.max * t);
    if (at.intersects(box)) return true;
  }
  return false;
}

TEST(Shaft, TheExactTestIsExact) {
  Random random(2);
  int touched = 0, clear = 0;
  for (int i = 0; i < 1500; ++i) {
    const Shaft shaft = random.shaft();
    const Box box = random.box(1.5F);
    const Point around(4e-3F, 4e-3F, 4e-3F);  // what the steps may miss
    if (has_common_point(shaft, box)) {
      ++touched;
      EXPECT_TRUE(touches(shaft, box));
    } else if (touches(shaft, box)) {
      EXPECT_TRUE(has_common_point(shaft, Box(box.min - around, box.max + around)));
    } else {
      ++clear;
    }
  }
  EXPECT_GT(touched, 50);
  EXPECT_GT(clear, 50);
}

TEST(Shaft, TheShaftsPlanesRejectTheSameBoxes) {
  Random random(3);
  int rejected_though_near = 0;
  for (int i = 0; i < 50000; ++i) {
    const Shaft shaft = random.shaft();
    const Box box = random.box(2);
    EXPECT_EQ(is_rejected_by_planes(shaft, box), !touches(shaft, box));
    rejected_though_near += !is_clear_of_bounds(shaft, box) && !touches(shaft, box) ? 1 : 0;
  }
  EXPECT_GT(rejected_though_near, 1000);
}

TEST(Shaft, ThatOfSubBoxesLiesInThatOfTheBoxes) {
  Random random(4);
  int touched = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shaft shaft = random.shaft();
    const Shaft inner{random.box_in(shaft.from), random.box_in(shaft.to)};
    const Box box = random.box(1);
    if (!touches(inner, box)) continue;
    ++touched;
    EXPECT_TRUE(touches(shaft, box));
    EXPECT_FALSE(is_rejected_by_planes(shaft, box));
  }
  EXPECT_GT(touched, 100);
}

TEST(Shaft, ExtrudedHoldsAllRaysOfTheDirections) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Box from = random.box(1);
    Box directions;
    Direction rays[3];
    for (Direction& ray : rays) {
      ray = Direction(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1)).normalized();
      directions.extendBy(ray);
    }
    const Shaft shaft = extruded(from, directions, 20);
    for (const Direction& ray : rays) {
      const Point at = random.point(from) + ray * random.number(0, 20), around(1e-4F, 1e-4F, 1e-4F);
      EXPECT_TRUE(touches(shaft, Box(at - around, at + around)));
    }
  }
}

TEST(Shaft, APyramidNarrowsTowardsItsApex) {
  const Shaft pyramid{Box(Point(0, 0, 0)), Box(Point(-1, -1, -10), Point(1, 1, -10))};
  EXPECT_TRUE(touches(pyramid, Box(Point(0.4F, -0.1F, -5), Point(0.6F, 0.1F, -5))));
  EXPECT_FALSE(touches(pyramid, Box(Point(0.6F, -0.1F, -5), Point(0.8F, 0.1F, -5))));
  EXPECT_TRUE(is_rejected_by_planes(pyramid, Box(Point(0.6F, -0.1F, -5), Point(0.8F, 0.1F, -5))));
  EXPECT_FALSE(touches(pyramid, Box(Point(-1, -1, 1), Point(1, 1, 2))));
}

/// By Cauchy: the mean area of its shadows, times four. A shadow is the hull of those of both boxes.
double area_of_shadow(const Shaft& shaft, const Imath::V3d& direction) {
  const Imath::V3d some = std::abs(direction.x) < 0.5 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0);
  const Imath::V3d u = direction.cross(some).normalized(), v = direction.cross(u);
  std::vector<Imath::V2d> points;
  for (const Box* box : {&shaft.from, &shaft.to})
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Imath::V3d at((corner & 1U) != 0 ? box->max.x : box->min.x, (corner & 2U) != 0 ? box->max.y : box->min.y,
                          (corner & 4U) != 0 ? box->max.z : box->min.z);
      points.emplace_back(at.dot(u), at.dot(v));
    }
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Imath::V2d> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const Imath::V2d& p : points) {
      while (hull.size() >= first + 2) {
        const Imath::V2d a = hull[hull.size() - 2], b = hull.back();
        if ((b - a).cross(p - a) > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  double twice = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) twice += hull[i].cross(hull[(i + 1) % hull.size()]);
  return twice / 2;
}

TEST(Shaft, ItsSurfaceIsFourTimesItsMeanShadow) {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const Shaft shaft = random.shaft();
    double sum = 0;
    constexpr int kDirections = 4000;  // evenly over the sphere
    for (int i = 0; i < kDirections; ++i) {
      const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * 2.399963229728653, r = std::sqrt(1 - z * z);
      sum += area_of_shadow(shaft, {r * std::cos(turn), r * std::sin(turn), z});
    }
    const double expected = 4 * sum / kDirections;
    EXPECT_NEAR(surface_area(shaft), expected, 2e-3 * expected + 1e-9);
  }
}

TEST(Shaft, TheSurfaceOfSimpleShapes) {
  const Box unit(Point(0, 0, 0), Point(1, 1, 1));
  EXPECT_DOUBLE_EQ(surface_area({unit, unit}), 6);
  EXPECT_DOUBLE_EQ(surface_area({unit, Box(Point(4, 0, 0), Point(5, 1, 1))}), 2 + 4 * 5) << "a beam";
  EXPECT_DOUBLE_EQ(surface_area({Box(Point(0, 0, 0)), Box(Point(0, 3, 4))}), 0) << "a line";
  const double slope = std::hypot(1, 10);
  EXPECT_NEAR(surface_area({Box(Point(0, 0, 0)), Box(Point(-1, -1, -10), Point(1, 1, -10))}), 4 + 4 * slope, 1e-9)
      << "a pyramid";
}

}  // namespace
}  // namespace relook
