// Materials of plain optics, lights that shine one way and a picture of one ray, for tests of closed forms.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "test_scenes.h"

namespace relook {

/// What the ray from `eye` to `target` brings: the middle of a picture of one pixel.
[[nodiscard]] inline Rgba seen(SceneBuilder& scene, Point eye, Point target, std::uint32_t max_depth = 6) {
  scene.look_at(eye, target, 1, 1, 1);
  return rendered(scene.state().scene(), {1, max_depth}).pixels.at(0);
}

/// No highlight: specular 0 leaves base / pi.
[[nodiscard]] inline Json lambert(double albedo) {
  Json material = {{"pbrMetallicRoughness",
                    {{"baseColorFactor", {albedo, albedo, albedo, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  material["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  return material;
}

/// White, without a base.
[[nodiscard]] inline Json metal(double roughness) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 1}, {"roughnessFactor", roughness}}}};
}

/// A smooth dielectric interface of transmission 1; a volume when `thickness` > 0.
[[nodiscard]] inline Json glass(double ior, double thickness) {
  Json material = {
      {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}};
  material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  material["extensions"]["KHR_materials_ior"]["ior"] = ior;
  if (thickness > 0) material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = thickness;
  return material;
}

/// Its colour and nothing else.
[[nodiscard]] inline Json unlit(double r, double g, double b) {
  Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}}}};
  material["extensions"]["KHR_materials_unlit"] = Json::object();
  return material;
}

/// A node rotation that turns -z, the way a light shines, into `way`.
[[nodiscard]] inline Json shining(Imath::V3d way) {
  way.normalize();
  const Imath::V3d from(0, 0, -1), axis = from.cross(way);
  const double w = 1 + from.dot(way);
  if (w < 1e-9) return {0, 1, 0, 0};
  const double length = std::sqrt(axis.length2() + w * w);
  return {axis.x / length, axis.y / length, axis.z / length, w / length};
}

/// Within `relative` of a channel's value.
inline void expect_near(const Rgba& pixel, double r, double g, double b, double relative = 1e-4) {
  EXPECT_NEAR(pixel.r, r, relative * r + 1e-6);
  EXPECT_NEAR(pixel.g, g, relative * g + 1e-6);
  EXPECT_NEAR(pixel.b, b, relative * b + 1e-6);
}

}  // namespace relook
