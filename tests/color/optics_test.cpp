// The formulas of src/physics: floats and expressions give equal bits, and both agree with closed forms.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "color/expression/expression.h"
#include "color/expression/lanes.h"
#include "physics/brushed_ggx.h"
#include "physics/dispersion.h"
#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "physics/lambert.h"
#include "physics/lobe_angles.h"
#include "physics/lobe_buckets.h"
#include "physics/mirror.h"
#include "physics/normal_map.h"
#include "physics/phong.h"
#include "physics/sheen.h"
#include "physics/thin_film.h"
#include "pi.h"

namespace relook {
namespace {

template <class S>
using Vector = std::conditional_t<std::is_same_v<S, float>, Direction, Triple>;

/// Values of variables for many hits: what the inputs of a kernel read.
struct Hits {
  std::vector<std::vector<float>> values;  // [variable][hit]

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const {
    const float* from = values[step.payload.which()].data() + first;
    std::copy(from, from + lanes, scratch.own(step.out));
  }
};

struct Range {
  float low, high;
};
constexpr Range kCosine{0, 1}, kSigned{-1, 1}, kShare{0, 1}, kIor{1, 3};

/// A formula takes an array of N scalars and gives an array of them.
template <std::size_t N, class Formula>
void expect_equal_bits(const std::array<Range, N>& ranges, const Formula& formula) {
  constexpr std::size_t kHits = 1000;
  std::mt19937 random(5);
  Hits hits{std::vector(N, std::vector<float>(kHits))};
  for (std::size_t i = 0; i < N; ++i)
    for (float& value : hits.values[i]) {
      const auto draw = static_cast<unsigned>(random());  // one in eight is an end of the range
      const float share = draw % 16 == 0 ? 0.0F : draw % 16 == 1 ? 1.0F : static_cast<float>(draw >> 8) * 0x1p-24F;
      value = ranges[i].low + (ranges[i].high - ranges[i].low) * share;
    }
  const Scene scene;
  ExpressionBuilder builder(scene, {});
  const auto variables = [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{Scalar{&builder, builder.input(Input::position, 0, I)}...};
  }
  (std::make_index_sequence<N>());
  std::vector<Value> outputs;
  for (const Scalar& result : formula(variables)) outputs.push_back(result.value);
  const Kernel kernel = make_kernel(builder.code(), outputs);
  Scratch scratch;
  const Parameters parameters{scene, {}};
  KernelRun run(kernel, parameters, hits, kHits, scratch);
  for (std::size_t first = 0; first < kHits; first += kLanes) {
    const std::size_t lanes = std::min(kLanes, kHits - first);
    run.run(first, lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::array<float, N> given;
      for (std::size_t i = 0; i < N; ++i) given[i] = hits.values[i][first + lane];
      const auto expected = formula(given);
      for (std::size_t k = 0; k < outputs.size(); ++k)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(run.output(k)[lane]), std::bit_cast<std::uint32_t>(expected[k]))
            << "result " << k << " of " << testing::PrintToString(given) << ": " << run.output(k)[lane] << " and "
            << expected[k];
    }
  }
}

template <class A>
using Of = typename std::remove_cvref_t<A>::value_type;
template <std::size_t First, class A>
Vector<Of<A>> vector(const A& v) {
  return {v[First], v[First + 1], v[First + 2]};
}
template <class V>
std::array<ScalarOf<V>, 3> components(const V& v) {
  return {v.x, v.y, v.z};
}

TEST(Optics, ReflectancesHaveEqualBits) {
  expect_equal_bits<3>({kCosine, kIor, kIor}, [](const auto& v) {
    const auto sin2 = sin2_behind(v[0], v[1]);
    return std::array{sin2,
                      normal_reflectance(v[1], v[2]),
                      normal_reflectance(v[1], 1.0F),
                      schlick(v[0]),
                      coat_reflectance(schlick(v[0])),
                      boundary_reflectance(v[0], sqrt(1.0F - sin2), v[1]),
                      reflectance_between(v[0], 1.0F, schlick(v[0]))};
  });
  for (const bool is_inside : {false, true})
    expect_equal_bits<2>({kCosine, Range{0, 3}},
                         [&](const auto& v) { return std::array{exact_weight(v[1], is_inside, v[0])}; });
}

TEST(Optics, IndicesOfChannelsHaveEqualBits) {
  expect_equal_bits<2>({Range{0, 3}, Range{0, 30}}, [](const auto& v) {
    return std::array{red_ior(v[0], v[1]), blue_ior(v[0], v[1])};
  });
}

TEST(Optics, MappedNormalsHaveEqualBits) {
  for (const bool is_inside : {false, true})
    expect_equal_bits<16>({kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned,
                           kSigned, kSigned, kShare, kShare, kShare, Range{-2, 2}},
                          [&](const auto& v) {
                            using V = Vector<Of<decltype(v)>>;
                            const MapAxes<V> axes{vector<0>(v), vector<3>(v)};
                            const UnmappedNormals<V> normals{vector<6>(v), vector<9>(v), is_inside};
                            return components(mapped_normal(axes, normals, vector<12>(v), v[15],
                                                            [](const V& bent, const V&) { return normalized(bent); }));
                          });
}

TEST(Optics, LobesHaveEqualBits) {
  expect_equal_bits<9>(
      {kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned, kSigned}, [](const auto& v) {
        const auto at = lobe_angles(vector<0>(v), vector<3>(v), vector<6>(v));
        return std::array{at.half.x, at.half.y, at.half.z, at.nl, at.nh, at.vh, half_sine2(vector<0>(v), at)};
      });
  expect_equal_bits<4>({kShare, kCosine, kCosine, Range{kLeastCosine, 1}}, [](const auto& v) {
    return std::array{ggx(square(alpha_of(v[0])), v[1], v[2], v[3]),
                      precise_ggx(square(alpha_of(v[0])), v[1], v[2], v[2], v[3]),
                      sheen(inverse_sheen_alpha(v[0]), v[1], v[2], v[3]),
                      lambert(v[1]),
                      phong_scale(v[0]) * phong_lobe(v[0] * 100.0F, max(v[1], 1e-7F)),
                      mirror_fade(v[0], 0.25F),
                      floored(v[0], 0.125F),
                      floored(v[0], v[1])};
  });
  expect_equal_bits<5>({kShare, kShare, kShare, kCosine, kShare},
                       [](const auto& v) { return std::array{below_sheen(vector<0>(v), v[3], v[4])}; });
  expect_equal_bits<11>(
      {kShare, kShare, kSigned, kSigned, kCosine, kSigned, kSigned, kCosine, kSigned, kSigned, kCosine},
      [](const auto& v) {
        using S = Of<decltype(v)>;
        const S alpha = alpha_of(v[0]);
        return std::array{brushed_ggx(widened(alpha, v[1]), alpha, Brushed<S>{v[2], v[3], v[4]},
                                      Brushed<S>{v[5], v[6], v[7]}, Brushed<S>{v[8], v[9], v[10]})};
      });
}

TEST(Optics, FilmsHaveEqualBits) {
  expect_equal_bits<6>({kShare, kShare, kShare, kIor, Range{0, 1200}, kCosine}, [](const auto& v) {
    return components(film_reflectance({v[3], v[4]}, vector<0>(v), v[5]));
  });
}

TEST(Optics, ReflectancesOfDielectricsAreFresnels) {
  for (const float ior : {1.1F, 1.33F, 1.5F, 2.4F}) {
    const double n = double{ior}, root = (n - 1) / (n + 1);
    EXPECT_NEAR(dielectric_reflectance(1, ior), root * root, 1e-6);
    EXPECT_NEAR(dielectric_reflectance(1, 1 / ior), root * root, 1e-6);
    EXPECT_NEAR(dielectric_reflectance(0, ior), 1, 1e-6);
    // At Brewster's angle, tan = n, light of one polarisation passes: of the other (1 - n^2) / (1 + n^2) comes back.
    const double brewster = (1 - n * n) / (1 + n * n);
    EXPECT_NEAR(dielectric_reflectance(static_cast<float>(1 / std::sqrt(1 + n * n)), ior), brewster * brewster / 2,
                1e-5);
    // From inside, nothing leaves beyond the angle whose sine is 1 / n.
    const double critical = std::sqrt(1 - 1 / (n * n));
    EXPECT_EQ(dielectric_reflectance(static_cast<float>(critical - 1e-3), 1 / ior), 1);
    EXPECT_LT(dielectric_reflectance(static_cast<float>(critical + 1e-3), 1 / ior), 1);
    EXPECT_EQ(exact_weight(ior, true, static_cast<float>(critical - 1e-3)), 1);
    EXPECT_NEAR(exact_weight(ior, false, 1.0F), 0, 1e-6);
    // The weight between r0 and 1 gives the reflectance back.
    const float r0 = normal_reflectance(ior, 1.0F);
    for (const float cosine : {0.05F, 0.3F, 0.8F})
      EXPECT_NEAR(reflectance_between(r0, 1.0F, exact_weight(ior, false, cosine)), dielectric_reflectance(cosine, ior),
                  1e-6);
  }
  EXPECT_FLOAT_EQ(coat_reflectance(schlick(1.0F)), 0.04F);
  EXPECT_FLOAT_EQ(coat_reflectance(schlick(0.0F)), 1);
}

TEST(Optics, BlueIsRefractedMoreThanRed) {
  for (const float ior : {1.0F, 1.2F, 1.7F})
    for (const float dispersion : {0.0F, 0.5F, 5.0F}) {
      // KHR_materials_dispersion: the indices differ by (n - 1) / (Abbe number), dispersion = 20 / (Abbe number).
      EXPECT_NEAR(blue_ior(ior, dispersion) - red_ior(ior, dispersion), (ior - 1) * dispersion / 20, 1e-6);
      EXPECT_NEAR(blue_ior(ior, dispersion) + red_ior(ior, dispersion), 2 * ior, 1e-6);
    }
  EXPECT_EQ(red_ior(1.5F, 1000.0F), 1);
  EXPECT_EQ(red_ior(0.0F, 5.0F), 0);
  EXPECT_EQ(blue_ior(0.0F, 5.0F), 0);
}

/// Over the hemisphere, by midpoints: of f(direction), +z up, times the cosine.
template <class F>
double integral(const F& f) {
  constexpr int kRows = 1000, kColumns = 200;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    const double polar = (row + 0.5) / kRows * kPi / 2, up = std::cos(polar), out = std::sin(polar);
    for (int column = 0; column < kColumns; ++column) {
      const double around = (column + 0.5) / kColumns * 2 * kPi;
      sum += double{f(Direction(static_cast<float>(out * std::cos(around)), static_cast<float>(out * std::sin(around)),
                                static_cast<float>(up)))} *
             up * out;
    }
  }
  return sum * (kPi / 2 / kRows) * (2 * kPi / kColumns);
}

TEST(Optics, DistributionsCoverTheSurfaceOnce) {
  for (const float alpha : {0.1F, 0.4F, 1.0F}) {
    EXPECT_NEAR(integral([&](const Direction& h) { return ggx_distribution(alpha * alpha, h.z); }), 1, 2e-3);
    EXPECT_NEAR(integral([&](const Direction& h) { return charlie_distribution(1 / alpha, h.z); }), 1, 2e-3);
    EXPECT_NEAR(integral([&](const Direction& h) {
                  return brushed_distribution(widened(alpha, 0.3F), alpha, Brushed<float>{h.x, h.y, h.z});
                }),
                1, 2e-3);
  }
  EXPECT_NEAR(integral([](const Direction&) { return lambert(0.7F); }), 0.7, 1e-5);
}

TEST(Optics, LobesReflectNoMoreThanComes) {
  const Direction up(0, 0, 1);
  for (const float nv : {0.2F, 0.6F, 1.0F}) {
    const Direction view(std::sqrt(1 - nv * nv), 0, nv);
    for (const float roughness : {0.3F, 0.6F, 1.0F}) {
      const float alpha2 = square(alpha_of(roughness));
      const double albedo = integral([&](const Direction& light) {
        const LobeAngles<Direction> at = lobe_angles(up, view, light);
        return ggx(alpha2, at.nh, at.nl, nv);
      });
      EXPECT_LT(albedo, 1.001) << nv << ' ' << roughness;
      EXPECT_GT(albedo, roughness < 0.5F ? 0.9 : 0.3) << nv << ' ' << roughness;
    }
  }
}

TEST(Optics, ABrushThatIsAsRoughBothWaysIsNone) {
  const Direction up(0, 0, 1), view(0.6F, 0, 0.8F);
  for (const Direction& light : {Direction(0, 0.6F, 0.8F), Direction(-0.48F, 0.36F, 0.8F)}) {
    const LobeAngles<Direction> at = lobe_angles(up, view, light);
    const auto seen = [](const Direction& d) { return Brushed<float>{d.x, d.y, d.z}; };
    EXPECT_NEAR(brushed_ggx(0.3F, 0.3F, seen(at.half), seen(light), seen(view)), ggx(0.3F * 0.3F, at.nh, at.nl, view.z),
                1e-4);
  }
}

TEST(Optics, AThickFilmHasNoColours) {
  // What interferes is averaged out; the geometric series of reflections within the film is left.
  const float ior = 1.4F;
  const Direction seen = film_reflectance({ior, 1e6F}, Direction(0.5F, 0.5F, 0.5F), 1.0F);
  const double base_root = std::sqrt(0.5), base_ior = (1 + base_root) / (1 - base_root);
  const double r12 = std::pow((double{ior} - 1) / (double{ior} + 1), 2),
               r23 = std::pow((base_ior - double{ior}) / (base_ior + double{ior}), 2);
  const double expected = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(seen[channel], expected, 1e-3);
}

TEST(Optics, MirrorsReturnWhatComesAtTheSameAngle) {
  const Normal n(0, 0.6F, 0.8F), up(0, 0, 1);
  const Direction d = unit(Direction(0.5F, 0.1F, -1));
  const Direction r = mirrored(d, n, up);
  EXPECT_NEAR(r.dot(n), -d.dot(n), 1e-6);
  EXPECT_NEAR(r.dot(d.cross(n)), 0, 1e-6);
  // A bent normal may send the ray below the surface: it is mirrored back.
  EXPECT_GT(mirrored(unit(Direction(0, 1, -0.05F)), unit(Normal(0, 0.5F, 0.5F)), up).z, 0);
  EXPECT_EQ(mirror_fade(0.0F, 0.25F), 1);
  EXPECT_EQ(mirror_fade(0.125F, 0.25F), 0.5F);
  EXPECT_EQ(mirror_fade(0.25F, 0.25F), 0);
  EXPECT_EQ(mirror_fade(1.0F, 0.25F), 0);
}

TEST(Optics, AFlatTexelLeavesTheNormal) {
  const auto mapped = [](bool is_inside, const Direction& texel, float scale) {
    const Normal smooth(0, 0, is_inside ? -1.0F : 1.0F);
    return mapped_normal(MapAxes<Direction>{Direction(1, 0, 0), Direction(0, 1, 0)},
                         UnmappedNormals<Direction>{smooth, smooth, is_inside}, texel, scale,
                         [](const Direction& bent, const Direction&) { return unit(bent); });
  };
  EXPECT_EQ(mapped(false, Direction(0.5F, 0.5F, 1), 1), Direction(0, 0, 1));
  EXPECT_EQ(mapped(true, Direction(0.5F, 0.5F, 1), 1), Direction(0, 0, -1));
  EXPECT_EQ(mapped(false, Direction(1, 0.5F, 1), 0), Direction(0, 0, 1));
  const float half = std::sqrt(0.5F);
  EXPECT_TRUE(mapped(false, Direction(1, 0.5F, 1), 1).equalWithAbsError(Direction(half, 0, half), 1e-6F));
  // Seen from behind, the front's normal is turned round as a whole.
  EXPECT_TRUE(mapped(true, Direction(1, 0.5F, 1), 1).equalWithAbsError(Direction(-half, 0, -half), 1e-6F));
  // A texel that points into the surface counts for nothing.
  EXPECT_EQ(mapped(false, Direction(1, 0.5F, 0), 1), Direction(0, 0, 1));
}

}  // namespace
}  // namespace relook
