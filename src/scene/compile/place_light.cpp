#include "scene/compile/place_light.h"

#include <algorithm>
#include <cmath>

namespace relook {
namespace {

constexpr double kNoLength = 1e-12;

Imath::V3d row_of(const WideTransform& world, int axis) { return {world[axis][0], world[axis][1], world[axis][2]}; }
double length_of(const Imath::V3d& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

Direction floats_of(const Imath::V3d& v) {
  return {static_cast<float>(v.x) + 0.0F, static_cast<float>(v.y) + 0.0F, static_cast<float>(v.z) + 0.0F};
}

/// The part of `v` across the unit vector `axis`, unit; zero if there is next to none.
Imath::V3d unit_across(const Imath::V3d& v, const Imath::V3d& axis) {
  const double length = length_of(v);
  if (!(length > kNoLength)) return {0, 0, 0};
  const Imath::V3d unit = v / length;
  const Imath::V3d across = unit - axis * unit.dot(axis);
  const double rest = length_of(across);
  return rest > 1e-6 ? across / rest : Imath::V3d(0, 0, 0);
}

/// Some unit vector across a unit vector.
Imath::V3d any_across(const Imath::V3d& axis) {
  return unit_across(std::abs(axis.x) < 0.5 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0), axis);
}

float half_axis(float local, double scale) {
  return std::clamp(static_cast<float>(std::min(static_cast<double>(local) * scale, 1e30)), kSmallestLight,
                    kLargestLight);
}

/// Turns the half axes of an area. `back`: unit, against the light.
bool place_area(const WideTransform& world, const Imath::V3d& back, Light& light) {
  const double scale =
      std::max({length_of(row_of(world, 0)), length_of(row_of(world, 1)), length_of(row_of(world, 2))});
  if (!(scale > kNoLength)) return false;
  Imath::V3d right = unit_across(row_of(world, 0), back);
  if (length_of(right) == 0) right = unit_across(row_of(world, 1), back).cross(back);
  if (length_of(right) == 0) right = any_across(back);
  const Imath::V3d up = back.cross(right);
  light.right = floats_of(right * static_cast<double>(half_axis(light.right.x, scale)));
  light.up = floats_of(up * static_cast<double>(half_axis(light.up.y, scale)));
  return true;
}

}  // namespace

bool place_light(const WideTransform& world, const WidePoint& eye, Light& light) {
  const LightTraits& traits = traits_of(light.kind);
  Imath::V3d back = row_of(world, 2);
  if (traits.has_size && !(length_of(back) > kNoLength)) back = row_of(world, 0).cross(row_of(world, 1));
  const double length = length_of(back);
  const bool has_direction = length > kNoLength;
  if (traits.has_direction && has_direction) light.direction = floats_of(-back / length);
  if (traits.has_place)
    for (int axis = 0; axis < 3; ++axis)
      light.position[axis] = static_cast<float>(world[3][axis] - eye[axis]) + 0.0F;
  if (traits.has_direction && !has_direction) return false;
  return !traits.has_size || place_area(world, back / length, light);
}

Color temperature_color(double kelvin) {
  const double t = kelvin, tt = t * t;
  const double u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * tt) /
                   (1.0 + 8.42420235e-4 * t + 7.08145163e-7 * tt);
  const double v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * tt) /
                   (1.0 - 2.89741816e-5 * t + 1.61456053e-7 * tt);
  const double scale = 1.0 / (2.0 * u - 8.0 * v + 4.0);
  const double x = 3.0 * u * scale, y = 2.0 * v * scale;
  const double large_x = x / y, large_z = (1.0 - x - y) / y;  // XYZ of Y = 1
  const double red = std::max(3.2406 * large_x - 1.5372 - 0.4986 * large_z, 0.0);
  const double green = std::max(-0.9689 * large_x + 1.8758 + 0.0415 * large_z, 0.0);
  const double blue = std::max(0.0557 * large_x - 0.2040 + 1.0570 * large_z, 0.0);
  const double luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  return {static_cast<float>(red / luminance), static_cast<float>(green / luminance),
          static_cast<float>(blue / luminance)};
}

}  // namespace relook
