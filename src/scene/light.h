// Lights as the look document says them, compiled (KHR_lights_punctual), and the table of their kinds: a kind is a row,
// and the schema, compilation, shadow segments, tunnels and colour expressions ask the row, never for a kind by name.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "base/math.h"

namespace relook {

enum class LightKind : std::uint8_t { point, spot, directional, count };

/// What a kind of light has. One without a place is infinitely far away and needs a direction.
struct LightTraits {
  std::string_view word;  // in the look document
  bool has_place, has_direction, has_cone;
};
inline constexpr std::size_t kLightKinds = static_cast<std::size_t>(LightKind::count);
inline constexpr std::array<LightTraits, kLightKinds> kLightTraits{{
    {.word = "point", .has_place = true, .has_direction = false, .has_cone = false},
    {.word = "spot", .has_place = true, .has_direction = true, .has_cone = true},
    {.word = "directional", .has_place = false, .has_direction = true, .has_cone = false},
}};
[[nodiscard]] constexpr const LightTraits& traits_of(LightKind kind) {
  return kLightTraits[static_cast<std::size_t>(kind)];
}
/// By LightKind.
[[nodiscard]] constexpr std::array<std::string_view, kLightKinds> light_words() {
  std::array<std::string_view, kLightKinds> words;
  for (std::size_t kind = 0; kind < kLightKinds; ++kind) words[kind] = kLightTraits[kind].word;
  return words;
}

/// One placed light.
struct Light {
  std::string node;            // node that places it
  std::string light;           // /lights/<name>
  bool alive = true;           // false: deleted or hidden
  LightKind kind = LightKind::point;
  Point position{0, 0, 0};     // where it has a place: from the camera's eye
  Direction direction{0, 0, -1};  // where it has one: unit, the way the light travels
  Color color{1, 1, 1};
  float intensity = 1;         // candela; lux of a light without a place
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = 0.785398F;  // radians
  bool operator==(const Light&) const = default;
};

}  // namespace relook
