// The camera: chosen once from the command line (choose_camera(), look/look.h), stored in the cache and never edited.
// camera_ray() makes the primary rays of a pixel's samples (image/sampling.h).
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "base/math.h"

namespace relook {

struct Camera {
  std::string name;  // of the camera or its node; "auto"; the command line's own words otherwise
  std::string node;  // look-document node it hangs on, "" when given by eye, target and angle
  bool orthographic = false;
  WidePoint eye{0, 0, 0};  // world; the origin of what is traced, so that numbers stay small far from the world's own
  Direction right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // unit, orthogonal
  float half_width = 1, half_height = 1;  // of the image plane at distance 1 (perspective), in metres (orthographic)
  float near = 0;                         // metres along forward: nothing nearer is seen
  float far = std::numeric_limits<float>::infinity();  // nor anything beyond
  std::uint32_t width = 0, height = 0;                 // pixels
};

inline constexpr float kLeastLens = 1e-9F, kMostLens = 1e9F;  // metres, of a lens that has a size

/// What puts a camera out of focus, metres: rays leave a disc about the eye and meet again where it is sharp.
struct Lens {
  float radius = 0;  // 0: all is sharp
  float focus = 1;   // along the camera's axis to the plane that is sharp; above 0
  bool operator==(const Lens&) const = default;
};
/// Of a size, and within what can be traced?
[[nodiscard]] inline bool is_lens(const Lens& lens) {
  const auto is_length = [](float metres) { return metres >= kLeastLens && metres <= kMostLens; };
  return is_length(lens.radius) && is_length(lens.focus);
}

struct CameraRay {
  Point origin;
  Direction direction;  // unit
  float spread;         // ray-cone angle of one pixel, radians (perspective), 0 (orthographic)
  float width;          // ray-cone width at the origin, metres (orthographic: a pixel's size)
  float start, end;     // metres along the ray, between the near and the far plane
};

/// The ray through image position (x, y) in pixels, (0, 0) the upper left corner of the upper left pixel; its origin
/// counts from the eye.
[[nodiscard]] inline CameraRay camera_ray(const Camera& camera, float x, float y) {
  const float across = (2.0F * x / static_cast<float>(camera.width) - 1.0F) * camera.half_width;
  const float down = (1.0F - 2.0F * y / static_cast<float>(camera.height)) * camera.half_height;
  const float pixel = 2.0F * camera.half_height / static_cast<float>(camera.height);
  const Direction offset = camera.right * across + camera.up * down;
  if (camera.orthographic) return {offset, camera.forward, 0, pixel, camera.near, camera.far};
  const Direction d = camera.forward + offset;
  const float scale = 1.0F / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  const float slant = 1.0F / (scale * d.dot(camera.forward));
  return {Point(0, 0, 0), d * scale, pixel, 0, camera.near * slant, camera.far * slant};
}

}  // namespace relook
