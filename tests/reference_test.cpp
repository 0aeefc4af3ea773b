// The renderer against the reference tracer: the same picture to float accuracy.
#include <gtest/gtest.h>

#include <cmath>

#include "reference_tracer.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// Relative where a pixel is bright, absolute near black.
double error_of(const Rgba& ours, const Rgba& reference) {
  double error = 0;
  for (int channel = 0; channel < 4; ++channel) {
    const double difference = std::fabs(double{ours[channel]} - double{reference[channel]});
    error = std::max(error, difference / std::max(std::fabs(double{reference[channel]}), 0.05));
  }
  return error;
}

struct Agreement {
  std::size_t pixels = 0, beyond = 0;  // beyond 1e-3
  std::string worst;
};

Agreement compare_with_reference(const SceneState& state, std::uint32_t max_depth) {
  const Frame ours = rendered(state.scene(), {1, max_depth});
  const Frame reference = ReferenceTracer(state.scene(), max_depth).frame();
  Agreement agreement;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    ++agreement.pixels;
    if (error_of(ours.pixels[i], reference.pixels[i]) <= 1e-3) continue;
    ++agreement.beyond;
    if (agreement.beyond > 12) continue;
    const Rgba &a = ours.pixels[i], &b = reference.pixels[i];
    std::ostringstream line;
    line << "\n(" << i % reference.width << "," << i / reference.width << ") ours " << a.r << " " << a.g << " " << a.b
         << " " << a.a << " reference " << b.r << " " << b.g << " " << b.b << " " << b.a;
    agreement.worst += line.str();
  }
  return agreement;
}

/// Where single and double precision may part: a ray that passes an edge of a silhouette, a shadow or a facet within
/// the rounding error of its path takes the other side, and every refraction or reflection at a curved surface
/// multiplies that error. Such pixels are single ones; a wrong formula shows on every pixel of a surface.
void expect_agreement(const SceneState& state, std::uint32_t max_depth, double tolerated_share) {
  const Agreement agreement = compare_with_reference(state, max_depth);
  EXPECT_LE(static_cast<double>(agreement.beyond), tolerated_share * static_cast<double>(agreement.pixels))
      << agreement.beyond << " of " << agreement.pixels << agreement.worst;
}

TEST(Reference, SpheresPrimaryRaysOnly) { expect_agreement(spheres_scene(64, 48), 1, 0.002); }
TEST(Reference, CardsPrimaryRaysOnly) { expect_agreement(cards_scene(64, 48), 1, 0.002); }
TEST(Reference, StudyPrimaryRaysOnly) { expect_agreement(study_scene(64, 48), 1, 0.002); }
TEST(Reference, Spheres) { expect_agreement(spheres_scene(64, 48), 6, 0.01); }
TEST(Reference, Cards) { expect_agreement(cards_scene(64, 48), 6, 0.01); }
TEST(Reference, Study) { expect_agreement(study_scene(64, 48), 6, 0.01); }

}  // namespace
}  // namespace relook
