// What decides where a ray goes on: bases, buckets, shares and weights.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "half_vectors.h"
#include "physics/basis.h"
#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "physics/lobe_shares.h"
#include "physics/mirror.h"
#include "physics/power_heuristic.h"

namespace relook {
namespace {

void expect_orthonormal(const Basis& basis) {
  for (const Direction& axis : {basis.x, basis.y, basis.z}) EXPECT_NEAR(axis.dot(axis), 1, 2e-6F);
  EXPECT_TRUE(basis.x.cross(basis.y).equalWithAbsError(basis.z, 2e-6F)) << basis.z;
  const Direction d(0.3F, -0.5F, 0.7F);
  EXPECT_TRUE(basis.to_world(basis.to_local(d)).equalWithAbsError(d, 4e-6F)) << basis.z;
  EXPECT_TRUE(basis.to_local(basis.z).equalWithAbsError(Direction(0, 0, 1), 2e-6F)) << basis.z;
}

TEST(LobeChoice, BasesAreOrthonormal) {
  for (const Normal& n : {Normal(0, 0, 1), Normal(0, 0, -1), Normal(1, 0, 0.0F), Normal(1, 0, -0.0F), Normal(0, -1, 0),
                          unit(Normal(1e-4F, 0, -1)), unit(Normal(1e-20F, 1e-20F, -1))})
    expect_orthonormal(basis_about(n));
  test::Points points(1);
  for (int i = 0; i < 10000; ++i) {
    const Uv a = points.next(), b = points.next();
    const Normal n = unit(Normal(a.x - 0.5F, a.y - 0.5F, b.x - 0.5F));
    expect_orthonormal(basis_about(n));
    const Direction along(b.y, a.x - 0.3F, 0.4F);
    const Basis brushed = basis_along(n, along);
    expect_orthonormal(brushed);
    EXPECT_NEAR(brushed.to_local(along).y, 0, 1e-5F);
  }
}

TEST(LobeChoice, ABrushAlongTheNormalIsNone) {
  const Normal n = unit(Normal(0.3F, 0.2F, 0.9F));
  for (const Direction& along : {n * 3.0F, n * -1.0F, Direction(0, 0, 0)}) expect_orthonormal(basis_along(n, along));
}

TEST(LobeChoice, BucketsOfAlphaDoubleAtTheirBorders) {
  for (int k = AlphaBucket::kLowest; k <= AlphaBucket::kHighest; ++k) {
    const AlphaBucket bucket{static_cast<std::int8_t>(k)};
    EXPECT_EQ(bucket.lower(), std::ldexp(1.0F, k));
    EXPECT_FLOAT_EQ(bucket.representative(), std::exp2(static_cast<float>(k) + 0.5F));
    EXPECT_EQ(bucket_of_alpha(bucket.lower()), bucket);
    EXPECT_EQ(bucket_of_alpha(bucket.representative()), bucket);
    EXPECT_EQ(bucket_of_alpha(std::nextafter(bucket.lower() * 2, 0.0F)), bucket);
    EXPECT_EQ(bucket_of_alpha(std::nextafter(bucket.lower(), 0.0F)).k, std::max(k - 1, AlphaBucket::kLowest));
  }
  EXPECT_EQ(bucket_of_alpha(1.0F).k, AlphaBucket::kHighest);
  EXPECT_EQ(bucket_of_alpha(7.0F).k, AlphaBucket::kHighest);
  for (const float narrow : {0.0F, -1.0F, 1e-40F, std::numeric_limits<float>::quiet_NaN(), alpha_of(0.0F)})
    EXPECT_EQ(bucket_of_alpha(narrow).k, AlphaBucket::kLowest);
}

TEST(LobeChoice, AFlooredRoughnessLiesInTheBucketOfItsFloor) {
  for (int k = AlphaBucket::kLowest + 1; k <= AlphaBucket::kHighest; ++k) {
    const AlphaBucket bucket{static_cast<std::int8_t>(k)};
    const float floor = alpha_floor_behind(bucket);
    EXPECT_EQ(floor, std::min(bucket.lower(), 0.25F));
    EXPECT_EQ(bucket_of_alpha(alpha_of(floored(0.05F, floor))), bucket_of_alpha(floor));
    EXPECT_NEAR(alpha_of(floored(0.05F, floor)), floor, floor * 1e-6F);
  }
  EXPECT_EQ(floored(0.8F, kAlphaFloorBehindDiffuse), 0.8F);
  EXPECT_EQ(floored(0.0F, 0.0F), 0);
}

TEST(LobeChoice, BucketsOfShininessDoubleAtTheirBorders) {
  for (int k = 0; k < 14; ++k) {
    const float lower = std::ldexp(1.0F, k);
    EXPECT_EQ(bucket_of_shininess(lower).k, k);
    EXPECT_EQ(bucket_of_shininess(lower).representative(), lower);
    EXPECT_EQ(bucket_of_shininess(std::nextafter(lower, 0.0F)).k, k - 1);
    // 2 / (n + 2) of the upper end.
    EXPECT_EQ(bucket_of_shininess(lower).as_alpha(), bucket_of_alpha(std::sqrt(1 / (lower + 1))));
  }
  EXPECT_EQ(bucket_of_shininess(0).representative(), 0);
  EXPECT_EQ(floored_shininess(1000.0F, 0.0F), 1000);
  EXPECT_EQ(floored_shininess(1000.0F, 0.25F), 30);
  EXPECT_EQ(floored_shininess(3.0F, 0.25F), 3);
}

TEST(LobeChoice, BucketsOfMetallicAreThree) {
  EXPECT_EQ(bucket_of_metallic(0), MetallicBucket::dielectric);
  EXPECT_EQ(bucket_of_metallic(0.0156F), MetallicBucket::dielectric);
  EXPECT_EQ(bucket_of_metallic(1.0F / 64), MetallicBucket::mixed);
  EXPECT_EQ(bucket_of_metallic(63.0F / 64), MetallicBucket::mixed);
  EXPECT_EQ(bucket_of_metallic(0.985F), MetallicBucket::metal);
  EXPECT_EQ(bucket_of_metallic(1), MetallicBucket::metal);
}

template <class F>
void for_each_shares(const F& f) {
  for (int bits = 1; bits < 16; ++bits)
    for (const MetallicBucket metallic : {MetallicBucket::dielectric, MetallicBucket::mixed, MetallicBucket::metal})
      for (const float reflectance : {0.0F, 0.04F, 0.3F, 0.9F, 1.0F})
        for (const float coat : {0.04F, 0.5F, 1.0F}) {
          const LobeSet lobes{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
          f(lobes, lobe_shares(lobes, metallic, reflectance, coat));
        }
}

TEST(LobeChoice, SharesAreAtLeastATenthAndSumToOne) {
  for_each_shares([](const LobeSet& lobes, const LobeShares& shares) {
    EXPECT_NEAR(shares.diffuse + shares.specular + shares.coat + shares.transmission, 1, 3e-7F);
    const auto expect_share = [](bool is_there, float share) {
      if (is_there) {
        EXPECT_GE(share, kLeastShare - 2e-7F);
      } else {
        EXPECT_EQ(share, 0);
      }
    };
    expect_share(lobes.diffuse, shares.diffuse);
    expect_share(lobes.specular, shares.specular);
    expect_share(lobes.coat, shares.coat);
    expect_share(lobes.transmission, shares.transmission);
  });
  const LobeShares none = lobe_shares({false, false, false}, MetallicBucket::mixed, 0.5F, 0.5F);
  EXPECT_EQ(none.diffuse + none.specular + none.coat, 0);
}

TEST(LobeChoice, SharesFollowWhatIsReflected) {
  const LobeSet both{true, true, false};
  // F / (F + (1 - F) / 2) of 0.04 is 0.077, of 0.3 it is 0.46.
  EXPECT_EQ(lobe_shares(both, MetallicBucket::dielectric, 0.04F, 0).specular, kLeastSpecularShare);
  EXPECT_NEAR(lobe_shares(both, MetallicBucket::dielectric, 0.3F, 0).specular, 0.3 / 0.65, 1e-6);
  EXPECT_NEAR(lobe_shares(both, MetallicBucket::dielectric, 1, 0).specular, 0.9, 1e-6);
  EXPECT_EQ(lobe_shares(both, MetallicBucket::mixed, 0.04F, 0).specular, 0.5F);
  EXPECT_NEAR(lobe_shares(both, MetallicBucket::metal, 0.04F, 0).specular, 0.9, 1e-6);
  EXPECT_EQ(lobe_shares({false, true, false}, MetallicBucket::dielectric, 0.04F, 0).specular, 1);
  EXPECT_NEAR(lobe_shares({true, true, true}, MetallicBucket::mixed, 0.04F, 1).coat, 0.8, 1e-6);
  // All of what a body of glass does not reflect goes through.
  const LobeShares glass = lobe_shares({false, true, false, true}, MetallicBucket::dielectric, 0.3F, 0);
  EXPECT_NEAR(glass.specular, 0.3, 1e-6);
  EXPECT_NEAR(glass.transmission, 0.7, 1e-6);
  const LobeShares milky = lobe_shares({true, true, false, true}, MetallicBucket::dielectric, 0.3F, 0);
  EXPECT_NEAR(milky.diffuse, 0.35, 1e-6);
  EXPECT_NEAR(milky.transmission, 0.35, 1e-6);
}

TEST(LobeChoice, LobesAreChosenAsOftenAsTheirSharesSay) {
  for_each_shares([](const LobeSet&, const LobeShares& shares) {
    constexpr int kSteps = 2000;
    std::array<int, 4> found{};
    std::array<double, 4> sums{};
    for (int i = 0; i < kSteps; ++i) {
      const LobeChoice choice = chosen_lobe(shares, (static_cast<float>(i) + 0.5F) / kSteps);
      ASSERT_TRUE(choice.u >= 0 && choice.u < 1);
      ++found[static_cast<std::size_t>(choice.lobe)];
      sums[static_cast<std::size_t>(choice.lobe)] += double{choice.u};
    }
    for (const Lobe lobe : {Lobe::diffuse, Lobe::specular, Lobe::coat, Lobe::transmission}) {
      const int count = found[static_cast<std::size_t>(lobe)];
      EXPECT_NEAR(static_cast<float>(count) / kSteps, shares.of(lobe), 1.01F / kSteps);
      // What is left of the number is spread evenly.
      if (count > 0) {
        EXPECT_NEAR(sums[static_cast<std::size_t>(lobe)] / count, 0.5, 0.01);
      }
    }
    for (const float u : {0.0F, 0x1.fffffep-1F}) {
      const LobeChoice choice = chosen_lobe(shares, u);
      EXPECT_GT(shares.of(choice.lobe), 0);
      EXPECT_TRUE(choice.u >= 0 && choice.u < 1);
    }
  });
}

TEST(LobeChoice, WeightsOfTwoTechniquesSumToOne) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr std::array kDensities{0.0F, 1e-45F, 1e-30F, 0.5F, 1.0F, 3.0F, 1e30F, 3e38F, kInfinity};
  for (const float a : kDensities)
    for (const float b : kDensities) {
      if (a == 0 && b == 0) continue;
      EXPECT_NEAR(weight_of(a, b) + weight_of(b, a), 1, 1.2e-7F) << a << ' ' << b;
      EXPECT_TRUE(weight_of(a, b) >= 0 && weight_of(a, b) <= 1) << a << ' ' << b;
    }
  EXPECT_EQ(weight_of(0, 0), 0);
  EXPECT_EQ(weight_of(2, 0), 1);
  EXPECT_EQ(weight_of(kInfinity, 1), 1);
  EXPECT_FLOAT_EQ(weight_of(3, 1), 0.9F);
}

}  // namespace
}  // namespace relook
