#include "path_studio.h"

#include <gtest/gtest.h>

#include <cmath>

#include "edit/apply.h"
#include "frame/image.h"

namespace relook {

Measured measured(std::span<const Vec> values) {
  Measured result;
  const auto n = static_cast<double>(values.size());
  for (const Vec& value : values) result.mean += value / n;
  for (const Vec& value : values)
    for (int c = 0; c < 3; ++c) result.error[c] += std::pow(value[c] - result.mean[c], 2);
  for (int c = 0; c < 3; ++c) result.error[c] = std::sqrt(result.error[c] / (n * (n - 1)));
  return result;
}

std::vector<Vec> colors_of(const Frame& frame) {
  std::vector<Vec> colors;
  for (const Rgba& pixel : frame.pixels) colors.emplace_back(pixel.r, pixel.g, pixel.b);
  return colors;
}

void expect_measured(const Measured& value, const Vec& expected, const std::string& what, double slack) {
  expect_alike(value, {expected, Vec(0, 0, 0)}, what, slack);
}

void expect_alike(const Measured& a, const Measured& b, const std::string& what, double slack) {
  for (int c = 0; c < 3; ++c) {
    const double error = std::sqrt(a.error[c] * a.error[c] + b.error[c] * b.error[c]);
    EXPECT_NEAR(a.mean[c], b.mean[c], 5 * error + slack * std::fabs(b.mean[c]) + 1e-6)
        << what << ", channel " << c << ", error " << error;
  }
}

void expect_no_gain(const Measured& value, const std::string& what) {
  // Specular lobes at V.H over a base at N.V give up to 1.0008.
  for (int c = 0; c < 3; ++c) EXPECT_LE(value.mean[c], 1.001 + 5 * value.error[c]) << what << ", channel " << c;
}

void PathStudio::area(const std::string& name, Json light, Json placement) {
  placement["extensions"]["EXT_lights_area"]["light"] = name;
  edits_.push_back({{"op", "add"}, {"path", "/lights/" + name}, {"value", std::move(light)}});
  edits_.push_back({{"op", "add"}, {"path", "/nodes/" + name}, {"value", std::move(placement)}});
}

void PathStudio::sky_image(const std::string& name) {
  edits_.push_back({{"op", "add"}, {"path", "/scene/extras/relook/environment/image"}, {"value", name}});
}

SceneState PathStudio::path_state() const {
  const SceneState whitted = state();
  SceneState path(whitted.document(), camera(), whitted.pyramids(), Integrator::path);
  if (!edits_.empty()) apply_edit(path, parsed_edit(edits_.dump()), "studio", ".");
  return path;
}

Frame PathStudio::frame(std::uint32_t samples, std::uint32_t max_depth, std::uint32_t diffuse_depth) const {
  ViewOptions view;
  view.samples = samples;
  view.max_depth = max_depth;
  view.diffuse_depth = diffuse_depth;
  view.integrator = Integrator::path;
  return rendered(path_state().scene(), view);
}

Measured PathStudio::seen(Point eye, Point target, std::uint32_t samples, std::uint32_t max_depth,
                          std::uint32_t diffuse_depth) {
  look_at(eye, target, 0.02F, 16, 16);
  return measured(colors_of(frame(samples, max_depth, diffuse_depth)));
}

void add_white_sky(SceneBuilder& scene) { scene.environment({{"color", {1, 1, 1}}}); }

}  // namespace relook
