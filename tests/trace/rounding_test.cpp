// Where rounding is large, a moved object must still be found: meshes far from their own origin, and long thin
// triangles on which a hit is known badly.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/render.h"
#include "region_checks.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

 private:
  std::mt19937 engine_;
};

Json matte() { return {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.5, 0.4, 1}}, {"metallicFactor", 0}}}}; }

Edit moved_to(const std::string& node, const Json& place) {
  return parsed_edit(
      Json::array({{{"op", "replace"}, {"path", "/nodes/" + node + "/translation"}, {"value", place}}}).dump());
}

/// Moves a node of the scene; true if the frame is that of a full render, with tunnels and without.
bool is_found(const SceneBuilder& scene, const Edit& edit, bool& changed) {
  for (const std::size_t tunnels : {1U, 0U}) {
    const ViewOptions view{1, 2};
    SceneState state = scene.state();
    Image image = preprocessed(state.scene(), view);
    RegionOptions options;
    options.tunnels = tunnels;
    Replayer replayer(std::move(state), std::move(image), options);
    changed = !replayer.step(edit, "rounding", ".").changed_pixels.empty();
    const SceneState again = compiled_again(replayer.state());
    if (!different_pixels(replayer.image().frame, rendered(again.scene(), view)).empty()) return false;
  }
  return true;
}

/// A unit quaternion and the matrix that it stands for.
struct Rotation {
  double x, y, z, w;
  explicit Rotation(Random& random)
      : x(random.number(-1, 1)), y(random.number(-1, 1)), z(random.number(-1, 1)), w(random.number(-1, 1)) {
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    for (double* part : {&x, &y, &z, &w}) *part /= length;
  }
  [[nodiscard]] Imath::V3d turned(const Imath::V3d& v) const {
    const Imath::V3d axis(x, y, z), t = axis.cross(v) * 2.0;
    return v + t * w + axis.cross(t);
  }
};

TEST(Rounding, MeshesFarFromTheirOriginAreFound) {
  std::size_t seen = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    Mesh mesh = box_mesh(Point(0.5F, 0.5F, 0.5F));
    const auto far = [&] { return static_cast<float>(std::round(random.number(-1e5, 1e5))); };
    const Point center(far(), far(), far());
    for (Point& point : mesh.positions) point += center;
    const Rotation rotation(random);
    const Imath::V3d back = rotation.turned(Imath::V3d(center)) * -1.0;
    Imath::V3d corner(-1e9, 0, 0);  // of the turned box, as far along x as possible: seen in the middle
    for (const Point& point : mesh.positions) {
      const Imath::V3d at = rotation.turned(Imath::V3d(point)) + back;
      if (at.x > corner.x) corner = at;
    }
    SceneBuilder scene;
    const int material = scene.material("Matte", matte());
    scene.node("Far", {{"mesh", scene.mesh("Far", mesh, material)},
                       {"rotation", {rotation.x, rotation.y, rotation.z, rotation.w}},
                       {"translation", {back.x + 500, back.y, back.z}}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 60}}, {{"translation", {2, 4, 3}}});
    scene.environment({{"color", {0.2, 0.3, 0.5}}});
    scene.ambient(Color(0.3F, 0.3F, 0.3F));
    const Point target(corner);
    scene.look_at(target + Point(0.004F, -0.006F, 3), target, 0.6F, 48, 48);
    bool changed = false;
    EXPECT_TRUE(is_found(scene, moved_to("Far", {back.x, back.y, back.z}), changed)) << "seed " << seed;
    seen += changed ? 1 : 0;
  }
  EXPECT_GT(seen, 75U);
}

TEST(Rounding, WhatStandsOnLongThinTrianglesIsFound) {
  std::size_t seen = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const double half_width = random.number(0.001, 0.05), half_length = random.number(100, 1000);
    const double height = random.number(1, 200), angle = random.number(0, 3.14);
    const auto at = [&](double along, double across) {
      return Point(static_cast<float>(along * std::cos(angle) - across * std::sin(angle)), 0,
                   static_cast<float>(along * std::sin(angle) + across * std::cos(angle)));
    };
    Mesh strip;
    strip.positions = {at(-half_length, -half_width), at(-half_length, half_width), at(half_length, half_width),
                       at(half_length, -half_width)};
    strip.triangles = {{0, 1, 2}, {0, 2, 3}};
    const double along = random.number(-0.8, 0.8) * half_length, across = random.number(-0.9, 0.9) * half_width;
    const Point target = at(along, across);
    Point eye = at(along + random.number(-1, 1) * height, across + random.number(-0.2, 0.2) * height);
    eye.y = static_cast<float>(height);
    const double radius = 0.002 * height * random.number(0.01, 0.3);
    SceneBuilder scene;
    const int material = scene.material("Matte", matte());
    scene.node("Strip", {{"mesh", scene.mesh("Strip", strip, material)}});
    scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(static_cast<float>(radius), 8, 6), material)},
                        {"translation", {0, 5000, 0}}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 60000}}, {{"translation", {2, 400, 3}}});
    scene.environment({{"color", {0.2, 0.3, 0.5}}});
    scene.look_at(eye, target, 0.05F, 1, 1);
    const Direction back = (eye - target).normalized();
    const Point place = target + back * static_cast<float>(1.5 * radius / std::max(1e-3, static_cast<double>(back.y)));
    bool changed = false;
    EXPECT_TRUE(is_found(scene, moved_to("Ball", {place.x, place.y, place.z}), changed)) << "seed " << seed;
    seen += changed ? 1 : 0;
  }
  EXPECT_GT(seen, 150U);
}

}  // namespace
}  // namespace relook
