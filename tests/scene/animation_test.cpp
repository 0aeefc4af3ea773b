// Animations: interpolation against closed forms (glTF 2.0 appendix C), and files whose animations are wrong.
#include "scene/gltf/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "gltf_writer.h"
#include "run_program.h"

namespace relook {
namespace {

AnimationChannel channel(Interpolation interpolation, std::size_t width, std::vector<float> times,
                         std::vector<float> values) {
  AnimationChannel made;
  made.interpolation = interpolation;
  made.width = width;
  made.times = std::move(times);
  made.values = std::move(values);
  return made;
}

TEST(Animation, linear_values_lie_between_keyframes_and_rest_outside_them) {
  const AnimationChannel line = channel(Interpolation::linear, 2, {1, 3}, {0, 10, 4, 30});
  EXPECT_EQ(value_at(line, 0), (std::vector<double>{0, 10}));
  EXPECT_EQ(value_at(line, 1.5), (std::vector<double>{1, 15}));
  EXPECT_EQ(value_at(line, 3), (std::vector<double>{4, 30}));
  EXPECT_EQ(value_at(line, 9), (std::vector<double>{4, 30}));
}

TEST(Animation, a_step_holds_until_the_next_keyframe) {
  const AnimationChannel steps = channel(Interpolation::step, 1, {0, 1, 2}, {5, 6, 7});
  EXPECT_EQ(value_at(steps, 0.999).front(), 5);
  EXPECT_EQ(value_at(steps, 1).front(), 6);
  EXPECT_EQ(value_at(steps, 5).front(), 7);
}

/// Keyframes of t^3 - 2t at 1 and 3 with its own slopes: a cubic is met exactly.
TEST(Animation, a_cubic_spline_is_the_cubic_through_its_values_and_tangents) {
  const auto f = [](double t) { return t * t * t - 2 * t; };
  const AnimationChannel spline = channel(Interpolation::cubic_spline, 1, {1, 3}, {99, -1, 1, 25, 21, 99});
  for (const double t : {1.0, 1.25, 2.0, 2.9, 3.0}) EXPECT_NEAR(value_at(spline, t).front(), f(t), 1e-12) << t;
}

/// A quarter turn about y and its negative are one rotation: both ways the angle grows evenly, by the shorter way.
TEST(Animation, rotations_turn_at_an_even_speed_by_the_shorter_way) {
  const auto half = static_cast<float>(std::sqrt(0.5));
  for (const float sign : {1.0F, -1.0F}) {
    AnimationChannel turn = channel(Interpolation::linear, 4, {0, 1}, {0, 0, 0, 1, 0, sign * half, 0, sign * half});
    turn.is_rotation = true;
    for (const double t : {0.1, 1.0 / 3, 0.75}) {
      const std::vector<double> q = value_at(turn, t);
      EXPECT_NEAR(q[1], std::sin(t * M_PI / 4), 1e-7) << t;
      EXPECT_NEAR(q[3], std::cos(t * M_PI / 4), 1e-7) << t;
    }
  }
}

TEST(Animation, a_spline_of_rotations_gives_unit_quaternions) {
  AnimationChannel turn = channel(Interpolation::cubic_spline, 4, {0, 2},
                                  {0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  turn.is_rotation = true;
  for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0}) {
    double length = 0;
    for (const double component : value_at(turn, t)) length += component * component;
    EXPECT_NEAR(length, 1, 1e-12) << t;
  }
}

/// A square with an animation of its light's node, to be spoilt.
SceneFile animated() {
  SceneFile file = square();
  const std::size_t times = file.floats({0, 1}, "SCALAR", 1), values = file.floats({0, 0, 1, 1, 0, 1}, "VEC3", 3);
  file.gltf["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}},
                              {"samplers", {{{"input", times}, {"output", values}}}}}};
  return file;
}

std::string refusal(const SceneFile& file) {
  const ScratchFolder folder("animation");
  const auto path = folder / "scene.glb";
  std::ofstream(path, std::ios::binary) << file.glb();
  try {
    (void)import_animations(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Animation, wrong_files_are_refused_with_their_place) {
  EXPECT_EQ(refusal(animated()), "accepted");
  const auto expect = [](const std::string& part, const auto& spoil) {
    SceneFile file = animated();
    spoil(file, file.gltf["animations"][0]);
    EXPECT_NE(refusal(file).find(part), std::string::npos) << refusal(file);
  };
  expect("/animations/0/channels/0/sampler: there is no sampler 3",
         [](SceneFile&, Json& animation) { animation["channels"][0]["sampler"] = 3; });
  expect("/animations/0/channels/0/target/node: there is no node 9",
         [](SceneFile&, Json& animation) { animation["channels"][0]["target"]["node"] = 9; });
  expect("/animations/0/channels/0/target/path: ",
         [](SceneFile&, Json& animation) { animation["channels"][0]["target"]["path"] = "translate"; });
  expect("/animations/0/samplers/0/interpolation: ",
         [](SceneFile&, Json& animation) { animation["samplers"][0]["interpolation"] = "CUBIC"; });
  expect("/animations/0/samplers/0/output: 2 values do not fit 2 times",
         [](SceneFile&, Json& animation) { animation["samplers"][0]["interpolation"] = "CUBICSPLINE"; });
  expect("/animations/0/samplers/0/output: a rotation has four numbers",
         [](SceneFile&, Json& animation) { animation["channels"][0]["target"]["path"] = "rotation"; });
  expect("/animations/0/samplers/0/input: time 1 is negative, not finite, or not later",
         [](SceneFile& file, Json& animation) {
           animation["samplers"][0]["input"] = file.floats({1, 1}, "SCALAR", 1);
         });
  expect("/animations/0/samplers/0/output: number 4 is not finite", [](SceneFile& file, Json& animation) {
    animation["samplers"][0]["output"] = file.floats({0, 0, 1, 1, NAN, 1}, "VEC3", 3);
  });
}

}  // namespace
}  // namespace relook
