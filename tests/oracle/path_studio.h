// Scenes for measuring pictures of the integrator `path`: pixels are samples of their own, so what a number may be off
// by follows from how they differ. Points are fixed, so no test flickers.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reference_tracer.h"
#include "test_scenes.h"

namespace relook {

/// A mean of independent values, by channel.
struct Measured {
  Vec mean{0, 0, 0};
  Vec error{0, 0, 0};  // standard deviation of the mean
};
[[nodiscard]] Measured measured(std::span<const Vec> values);
[[nodiscard]] std::vector<Vec> colors_of(const Frame& frame);

/// Is a mean, within 5 of its errors and `slack` of the value, `expected`? Fails the test if not.
void expect_measured(const Measured& value, const Vec& expected, const std::string& what, double slack = 1e-3);
/// Are two means equal, within 5 of their errors and `slack` of the second?
void expect_alike(const Measured& a, const Measured& b, const std::string& what, double slack = 1e-3);
/// Is it at most 1?
void expect_no_gain(const Measured& value, const std::string& what);

/// A scene builder that has area lights and pictures of environments, too.
class PathStudio : public SceneBuilder {
 public:
  /// A light of EXT_lights_area and the node that places it, of the same name.
  void area(const std::string& name, Json light, Json placement);
  /// The environment's image, of image(); environment() is to be called before.
  void sky_image(const std::string& name);

  [[nodiscard]] SceneState path_state() const;
  [[nodiscard]] Frame frame(std::uint32_t samples, std::uint32_t max_depth = 6, std::uint32_t diffuse_depth = 0) const;
  /// Of 16 x 16 pixels that all show what the ray from `eye` to `target` brings.
  [[nodiscard]] Measured seen(Point eye, Point target, std::uint32_t samples = 64, std::uint32_t max_depth = 6,
                              std::uint32_t diffuse_depth = 0);

 private:
  Json edits_ = Json::array();
};

/// A sky of one colour, of radiance 1.
void add_white_sky(SceneBuilder& scene);

}  // namespace relook
