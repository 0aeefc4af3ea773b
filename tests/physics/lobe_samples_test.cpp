// Samples of lobes lie as their densities say, and densities are those of visible normals: against doubles, for narrow
// and wide lobes, from above and at grazing angles. Seeds are fixed; bounds are five sigma.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "half_vectors.h"
#include "physics/basis.h"
#include "physics/brushed_ggx.h"
#include "physics/ggx.h"
#include "physics/glossy_lobe.h"
#include "physics/lobe_angles.h"
#include "physics/lobe_buckets.h"
#include "physics/phong_sample.h"
#include "physics/sheen.h"

namespace relook {
namespace {

using namespace test;

constexpr std::array kAlphas{Alphas{0.0025, 0.0025}, Alphas{0.01, 0.01}, Alphas{0.05, 0.05}, Alphas{0.25, 0.25},
                             Alphas{0.6, 0.6},       Alphas{1, 1},       Alphas{0.3, 0.02},  Alphas{0.9, 0.3}};
constexpr std::array kCosines{1.0, 0.7, 0.2, 0.02};

template <class F>
void for_each_lobe(const F& f) {
  for (const Alphas& a : kAlphas)
    for (const double cosine : kCosines) {
      SCOPED_TRACE(testing::Message() << "alpha " << a.x << ", " << a.y << ", cosine " << cosine);
      f(a, view_at(cosine, 0.1));
    }
}
GlossyLobe lobe_of(const Alphas& a) { return {static_cast<float>(a.x), static_cast<float>(a.y)}; }
Wide wide(const Direction& d) { return Wide(d.x, d.y, d.z); }

TEST(LobeSamples, DensitiesAreThoseOfVisibleNormals) {
  for_each_lobe([](const Alphas& a, const Wide& view) {
    const GlossyLobe sampled = lobe_of(a);
    for (double t = 0.005; t < 1; t += 0.045)
      for (double turn = 0.013; turn < 1; turn += 0.041) {
        const Wide half = half_at(a, {t, turn});
        const double vh = view.dot(half);
        const Wide way = half * (2 * vh) - view;
        if (vh <= 0 || way.z <= 0.01) continue;
        const double share = double{sampled.cosine_share()};
        const double expected = share * way.z / kPi + (1 - share) * visible(a, view, half) / (4 * vh);
        ASSERT_NEAR(double{sampled.density(narrow(view), narrow(way))} / expected, 1, 3e-3) << t << ' ' << turn;
      }
  });
}

TEST(LobeSamples, DensitiesCoverTheDirectionsOnce) {
  for_each_lobe([](const Alphas& a, const Wide& view) {
    const GlossyLobe sampled = lobe_of(a);
    const auto above = [&](const Wide& half, const Wide& way) {
      return double{sampled.density(narrow(view), narrow(way))} * 4 * view.dot(half);
    };
    const auto below = [&](const Wide& half, const Wide& way) { return way.z > 0 ? 0 : visible(a, view, half); };
    const double lost = integral(a, view, below, 300) * (1 - double{sampled.cosine_share()});
    EXPECT_NEAR(integral(a, view, above, 300) + lost, 1, 4e-3);
  });
}

TEST(LobeSamples, SamplesLieAsTheirDensitySays) {
  constexpr int kSamples = 20000, kSide = 8, kSteps = 16;
  for_each_lobe([](const Alphas& a, const Wide& view) {
    const GlossyLobe sampled = lobe_of(a);
    const Direction seen = narrow(view);
    std::vector<double> found(kSide * kSide + 1), expected(kSide * kSide + 1);  // the last: below the surface
    Points points(7);
    for (int i = 0; i < kSamples; ++i) {
      const std::optional<Direction> way = sampled.sample(seen, points.next());
      if (!way) {
        ++found.back();
        continue;
      }
      ASSERT_NEAR(way->dot(*way), 1, 1e-5F);
      ASSERT_GT(sampled.density(seen, *way), 0);
      const HalfPlace at = place_of(a, (view + wide(*way)).normalized());
      const int row = std::min(static_cast<int>(at.t * kSide), kSide - 1);
      const int column = std::min(static_cast<int>(at.turn * kSide), kSide - 1);
      ++found[static_cast<std::size_t>(row * kSide + column)];
    }
    const auto above = [&](const Wide& half, const Wide& way) {
      return double{sampled.density(seen, narrow(way))} * 4 * view.dot(half);
    };
    expected.back() = kSamples;
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column) {
        const HalfPlace from{double(row) / kSide, double(column) / kSide};
        const HalfPlace to{from.t + 1.0 / kSide, from.turn + 1.0 / kSide};
        double& bin = expected[static_cast<std::size_t>(row * kSide + column)];
        bin = kSamples * integral(a, view, above, kSteps, from, to);
        expected.back() -= bin;
      }
    double chi2 = 0, bins = 0, rare_found = 0, rare_expected = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (expected[i] < 20) {
        rare_found += found[i], rare_expected += expected[i];
        continue;
      }
      chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i];
      ++bins;
    }
    EXPECT_LT(chi2, bins + 5 * std::sqrt(2 * bins));
    EXPECT_NEAR(rare_found, rare_expected, 5 * std::sqrt(rare_expected + 1) + 2e-3 * kSamples);
  });
}

TEST(LobeSamples, AnotherMemberOfTheBucketGivesTheSameLight) {
  constexpr int kSamples = 10000;
  for (int k = AlphaBucket::kLowest + 1; k <= AlphaBucket::kHighest; ++k)
    for (const float member : {1.0F, 1.3F, 1.95F})
      for (const double cosine : kCosines) {
        const AlphaBucket bucket{static_cast<std::int8_t>(k)};
        const float alpha = bucket.lower() * member;
        ASSERT_EQ(bucket_of_alpha(alpha), bucket);
        SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cosine " << cosine);
        const GlossyLobe sampled{bucket.representative(), bucket.representative()};
        const Wide view = view_at(cosine, 0.1);
        const Direction seen = narrow(view);
        Points points(static_cast<std::uint32_t>(k + 100));
        Mean mean;
        for (int i = 0; i < kSamples; ++i) {
          const std::optional<Direction> way = sampled.sample(seen, points.next());
          if (!way) {
            mean.add(0);
            continue;
          }
          const Direction half = normalized(*way + seen);
          const float value =
              brushed_ggx(alpha, alpha, {half.x, half.y, half.z}, {way->x, way->y, way->z}, {seen.x, seen.y, seen.z});
          mean.add(double{value * way->z / sampled.density(seen, *way)});
        }
        const Alphas a{double{alpha}, double{alpha}};
        const auto reflected = [&](const Wide& half, const Wide& way) {
          return way.z > 0 ? lobe(a, view, way, half) * way.z * 4 * view.dot(half) : 0;
        };
        EXPECT_NEAR(mean.value(), integral(a, view, reflected, 150), mean.five_sigma() + 1e-3);
        EXPECT_LT(mean.value(), 1 + mean.five_sigma());
      }
}

TEST(LobeSamples, NarrowLobesKeepTheirLightInTheWorld) {
  const Basis basis = basis_about(normalized(Direction(0.3F, 0.5F, 0.8F)));
  for (const float alpha : {0.0025F, 0.01F, 0.1F})
    for (const double cosine : kCosines) {
      SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cosine " << cosine);
      const GlossyLobe sampled{alpha, alpha};
      const Wide view = view_at(cosine, 0.1);
      const Direction seen = narrow(view);
      Points points(9);
      Mean mean;
      for (int i = 0; i < 10000; ++i) {
        const std::optional<Direction> way = sampled.sample(seen, points.next());
        if (!way) {
          mean.add(0);
          continue;
        }
        const LobeAngles<Direction> at = lobe_angles(basis.z, basis.to_world(seen), basis.to_world(*way));
        const float value = precise_ggx(alpha * alpha, at.nh, half_sine2(basis.z, at), at.nl, seen.z);
        mean.add(double{value * at.nl / sampled.density(seen, *way)});
      }
      const Alphas a{double{alpha}, double{alpha}};
      const auto reflected = [&](const Wide& half, const Wide& way) {
        return way.z > 0 ? lobe(a, view, way, half) * way.z * 4 * view.dot(half) : 0;
      };
      EXPECT_NEAR(mean.value(), integral(a, view, reflected, 150), mean.five_sigma() + 1e-3);
    }
}

TEST(LobeSamples, ViewsFromBelowAreSampledAtGrazingAngles) {
  const Direction below = normalized(Direction(0.5F, 0.2F, -0.7F));
  EXPECT_GE(facing(below).z, kLeastCosine);
  EXPECT_NEAR(facing(below).dot(facing(below)), 1, 1e-6F);
  const Direction edge(1, 0, 0);
  for (const Direction& view : {below, edge, Direction(0, 0, -1), Direction(0, 0, 1)})
    for (const float alpha : {0.0025F, 0.1F, 1.0F})
      for (const float x : {0.0F, 0.05F, 0.5F, 0x1.fffffep-1F})
        for (const float y : {0.0F, 0.5F, 0x1.fffffep-1F}) {
          const GlossyLobe sampled{alpha, alpha};
          const std::optional<Direction> way = sampled.sample(view, {x, y});
          if (!way) continue;
          EXPECT_NEAR(way->dot(*way), 1, 1e-5F);
          const float density = sampled.density(view, *way);
          EXPECT_TRUE(density > 0 && std::isfinite(density)) << view << alpha << ' ' << x << ' ' << y;
        }
}

/// Are directions even over the hemisphere where height(z) is even over [0, 1]? `direction`: of a point of the square.
template <class Sample, class Height>
void expect_even(Points points, const Sample& direction, const Height& height) {
  constexpr int kSamples = 100000, kSide = 8;
  std::array<int, kSide * kSide> found{};
  for (int i = 0; i < kSamples; ++i) {
    const Direction way = direction(points.next());
    ASSERT_NEAR(way.dot(way), 1, 1e-5F);
    const double around = std::atan2(double{way.y}, double{way.x}) / (2 * kPi) + 0.5;
    const int row = std::min(static_cast<int>(height(way.z) * kSide), kSide - 1);
    const int column = std::min(static_cast<int>(around * kSide), kSide - 1);
    ++found[static_cast<std::size_t>(row * kSide + column)];
  }
  const double expected = double{kSamples} / (kSide * kSide);
  double chi2 = 0;
  for (const int count : found) chi2 += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chi2, kSide * kSide + 5 * std::sqrt(2.0 * kSide * kSide));
}

TEST(LobeSamples, DiffuseDirectionsGoByTheirCosine) {
  // The squared cosine is spread evenly.
  expect_even(Points(3), [](Uv u) { return cosine_direction(u); }, [](float z) { return z * z; });
  EXPECT_NEAR(cosine_density(0.5F), 0.5 / kPi, 1e-6);
  EXPECT_EQ(cosine_density(-0.5F), 0);
  for (const float x : {0.0F, 0.5F, 1.0F})
    for (const float y : {0.0F, 0.5F, 1.0F}) {
      const Direction way = cosine_direction({x, y});
      EXPECT_GE(way.z, kLeastCosine * 0.999F);
      EXPECT_NEAR(way.dot(way), 1, 1e-5F);
    }
}

TEST(LobeSamples, NeighboursInTheSquareStayNeighbours) {
  constexpr float kStep = 1e-4F;
  for (float x = kStep; x < 0.99F; x += 0.0111F)
    for (float y = kStep; y < 0.99F; y += 0.0111F) {
      const Direction way = cosine_direction({x, y});
      for (const Uv& near : {Uv(x + kStep, y), Uv(x, y + kStep), Uv(x + kStep, y - kStep)}) {
        const Direction step = cosine_direction(near) - way;
        ASSERT_LT(std::hypot(step.x, step.y), 4 * kStep) << x << ' ' << y;
      }
    }
}

TEST(LobeSamples, EvenDirectionsCoverTheHemisphere) {
  // The height is even over [0, 1].
  expect_even(Points(4), [](Uv u) { return even_direction(u); }, [](float z) { return z; });
}

TEST(LobeSamples, SheenReflectsItsAlbedo) {
  for (const float roughness : {0.2F, 0.6F, 1.0F})
    for (const float nv : {0.9F, 0.5F, 0.2F}) {
      const Direction view = narrow(view_at(double{nv}, 0));
      Points points(11);
      Mean mean;
      for (int i = 0; i < 40000; ++i) {
        const DiffuseDirections cloth{true};
        const Direction way = cloth.sample(points.next());
        const float nh = min(normalized(view + way).z, 1.0F);
        mean.add(double{sheen(inverse_sheen_alpha(roughness), nh, way.z, nv) * way.z / cloth.density(way.z)});
      }
      // The table has ten columns, and clamps.
      EXPECT_NEAR(std::min(mean.value(), 1.0), double{sheen_albedo(nv, roughness)}, mean.five_sigma() + 0.02)
          << roughness << ' ' << nv;
    }
}

TEST(LobeSamples, PowerLobesAreSampledByTheirHalfVectors) {
  for (const float shininess : {1.0F, 20.0F, 1000.0F})
    for (const double cosine : {1.0, 0.5, 0.1}) {
      SCOPED_TRACE(testing::Message() << shininess << ' ' << cosine);
      const Wide view = view_at(cosine, 0.3);
      const Direction seen = narrow(view);
      // N.H alone follows (n + 1) c^n; its mean is (n + 1) / (n + 2).
      Mean heights, above;
      Points points(5);
      for (int i = 0; i < 40000; ++i) {
        const Direction half = phong_half(shininess, points.next());
        ASSERT_NEAR(half.dot(half), 1, 1e-5F);
        heights.add(double{half.z});
        const Direction way = reflected_direction(seen, half);
        above.add(way.z > 0 && seen.dot(half) > 0 ? 1 : 0);
      }
      EXPECT_NEAR(heights.value(), double{(shininess + 1) / (shininess + 2)}, heights.five_sigma() + 1e-6);
      const double alpha = std::sqrt(2 / (double{shininess} + 2));
      const auto density = [&](const Wide& half, const Wide& way) {
        return double{phong_reflection_density(shininess, seen, narrow(way))} * 4 * view.dot(half);
      };
      EXPECT_NEAR(integral({alpha, alpha}, view, density, 300), above.value(), above.five_sigma() + 4e-3);
    }
}

}  // namespace
}  // namespace relook
