// Rough boundaries of volumes: samples lie as their density says, and they bring the light that quadrature over
// microfacets finds, from outside and from inside. Bounds are five sigma.
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "half_vectors.h"
#include "physics/lobe_angles.h"
#include "physics/lobe_buckets.h"
#include "physics/rough_refraction.h"

namespace relook {
namespace {

using namespace test;

constexpr std::array kGlassAlphas{0.0045, 0.05, 0.25, 0.6, 1.0};
constexpr std::array kGlassCosines{1.0, 0.7, 0.2, 0.05};
constexpr std::array kEtas{1.5, 1 / 1.5, 1.05, 1 / 1.05, 2.4};

template <class F>
void for_each_boundary(const F& f) {
  for (const double alpha : kGlassAlphas)
    for (const double cosine : kGlassCosines)
      for (const double eta : kEtas) {
        SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cosine " << cosine << ", eta " << eta);
        f(Alphas{alpha, alpha}, view_at(cosine, 0.1), eta);
      }
}

/// Where a microfacet sends the view; none at total reflection.
std::optional<Wide> way_of(const Wide& view, const Wide& half, double eta) {
  const double vh = view.dot(half), left = 1 - (1 - vh * vh) / (eta * eta);
  if (vh <= 0 || left <= 0) return std::nullopt;
  return half * (vh / eta - std::sqrt(left)) - view / eta;
}
/// Solid angle of half vectors over that of ways.
double jacobian(const Wide& view, const Wide& half, const Wide& way, double eta) {
  return eta * eta * -way.dot(half) / std::pow(view.dot(half) + eta * way.dot(half), 2);
}

TEST(RoughRefraction, DensitiesAreThoseOfVisibleNormals) {
  for_each_boundary([](const Alphas& a, const Wide& view, double eta) {
    for (double t = 0.005; t < 1; t += 0.045)
      for (double turn = 0.013; turn < 1; turn += 0.041) {
        const Wide half = half_at(a, {t, turn});
        const auto way = way_of(view, half, eta);
        // Next to total reflection, and where both ways are alike, floats do not tell half vectors apart.
        if (!way || way->z >= -0.01 || way->dot(half) > -0.05) continue;
        const double expected = visible(a, view, half) * jacobian(view, half, *way, eta);
        const float found = ggx_refraction_density(static_cast<float>(a.x), narrow(view), narrow(way->normalized()),
                                                   static_cast<float>(eta));
        const double slack = 3e-3 + 2e-6 / (a.x * std::fabs(eta - 1));
        ASSERT_NEAR(double{found} / expected, 1, slack) << t << ' ' << turn;
      }
  });
}

TEST(RoughRefraction, SamplesOfABucketBringTheLightOfItsMembers) {
  constexpr int kSamples = 10000;
  for (const int k : {-8, -5, -3, -1})
    for (const float member : {1.0F, 1.95F})
      for (const double cosine : kGlassCosines)
        for (const double eta : {1.5, 1 / 1.5}) {
          const AlphaBucket bucket{static_cast<std::int8_t>(k)};
          const float alpha = bucket.lower() * member, q = bucket.representative(), bend = static_cast<float>(eta);
          SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cosine " << cosine << ", eta " << eta);
          const Wide view = view_at(cosine, 0.1);
          const Direction seen = narrow(view), up(0, 0, 1);
          Points points(static_cast<std::uint32_t>(k + 100));
          Mean mean;
          for (int i = 0; i < kSamples; ++i) {
            auto way = refracted_direction(seen, visible_normal(q, q, seen, points.next()), bend);
            if (way) *way = *way / std::sqrt(way->dot(*way));
            const float density = way ? ggx_refraction_density(q, seen, *way, bend) : 0.0F;
            if (!(density > 0)) {
              mean.add(0);
              continue;
            }
            const auto at = refracted_angles(up, seen, *way, bend, eta > 1);
            const Direction flat = at.half - up * at.nh;
            const float value = rough_refraction(alpha * alpha, at, flat.dot(flat), seen.z, bend);
            mean.add(double{value / density});
          }
          const Alphas a{double{alpha}, double{alpha}};
          const auto let_through = [&](const Wide& half, const Wide&) {
            const auto way = way_of(view, half, eta);
            return way && way->z < 0 ? visible(a, view, half) / (1 + hidden(a, *way)) : 0;
          };
          EXPECT_NEAR(mean.value(), integral(a, view, let_through, 150), mean.five_sigma() + 2e-3);
          EXPECT_LT(mean.value(), 1 + mean.five_sigma());
        }
}

TEST(RoughRefraction, NothingLeavesOnTheWrongSide) {
  const Direction view = narrow(view_at(0.6, 0));
  EXPECT_EQ(ggx_refraction_density(0.3F, view, narrow(view_at(0.5, 0.4)), 1.5F), 0);
  // From inside of glass at 45 degrees a smooth facet reflects all.
  EXPECT_FALSE(refracted_direction(narrow(view_at(0.7071, 0)), Direction(0, 0, 1), 1 / 1.5F));
  EXPECT_TRUE(refracted_direction(narrow(view_at(0.7071, 0)), Direction(0, 0, 1), 1.5F));
}

}  // namespace
}  // namespace relook
