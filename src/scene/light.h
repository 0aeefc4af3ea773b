// Lights, compiled: those that nodes place (KHR_lights_punctual, EXT_lights_area), and under the integrator `path` the
// suns of the environment and the emission of each material, which are lights like any other. The table of their kinds:
// a kind is a row, and the schema, compilation, shadow segments, tunnels and colour expressions ask the row, never for
// a kind by name.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/id.h"
#include "base/math.h"
#include "scene/material.h"

namespace relook {

enum class LightKind : std::uint8_t { point, spot, directional, rect, disk, suns, emission, count };

/// What a kind of light has. One without a place is infinitely far away and needs a direction.
struct LightTraits {
  std::string_view word;  // in the look document
  bool has_place, has_direction, has_cone;
  bool has_radius, has_angle;  // extras.relook softens it
  bool has_size;               // is an area of its own: Light::right, up
  bool in_document;            // an entry of /lights, placed by a node; otherwise made by compilation
  bool path_only;              // brings no light under Integrator::whitted
};
inline constexpr std::size_t kLightKinds = static_cast<std::size_t>(LightKind::count);
inline constexpr std::array<LightTraits, kLightKinds> kLightTraits{{
    {.word = "point", .has_place = true, .has_direction = false, .has_cone = false, .has_radius = true,
     .has_angle = false, .has_size = false, .in_document = true, .path_only = false},
    {.word = "spot", .has_place = true, .has_direction = true, .has_cone = true, .has_radius = true,
     .has_angle = false, .has_size = false, .in_document = true, .path_only = false},
    {.word = "directional", .has_place = false, .has_direction = true, .has_cone = false, .has_radius = false,
     .has_angle = true, .has_size = false, .in_document = true, .path_only = false},
    {.word = "rect", .has_place = true, .has_direction = true, .has_cone = false, .has_radius = false,
     .has_angle = false, .has_size = true, .in_document = true, .path_only = true},
    {.word = "disk", .has_place = true, .has_direction = true, .has_cone = false, .has_radius = false,
     .has_angle = false, .has_size = true, .in_document = true, .path_only = true},
    {.word = "suns", .has_place = false, .has_direction = false, .has_cone = false, .has_radius = false,
     .has_angle = false, .has_size = false, .in_document = false, .path_only = true},
    {.word = "emission", .has_place = false, .has_direction = false, .has_cone = false, .has_radius = false,
     .has_angle = false, .has_size = false, .in_document = false, .path_only = true},
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
/// The first so many kinds are those of a look document.
inline constexpr std::size_t kDocumentLightKinds = static_cast<std::size_t>(LightKind::suns);

/// One light. What only the integrator `path` reads keeps its default under `whitted`.
struct Light {
  std::string node;            // node that places it; "" of suns and emission
  std::string light;           // /lights/<name>; of emission the material's name; "" of suns
  bool alive = true;           // false: deleted or hidden; emission: black
  LightKind kind = LightKind::point;
  Point position{0, 0, 0};     // where it has a place: from the camera's eye; of areas the middle
  Direction direction{0, 0, -1};  // where it has one: unit, the way the light travels; areas shine to this side alone
  Color color{1, 1, 1};        // temperature included; of suns the environment's, of emission the material's factor
  float intensity = 1;         // candela; lux of a light without a place; nits of areas; of suns the environment's
                               // intensity, of emission the material's strength
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = 0.785398F;  // radians

  float radius = 0;            // where it may have one: of the sphere that shines, metres; 0: a point
  float angle = 0;             // where it may have one: across the disc in the sky that shines, radians; 0: a direction
  Direction right{0, 0, 0}, up{0, 0, 0};  // of areas: half axes, at right angles to each other and to `direction`,
                                          // right x up against it; metres; none is zero in a light that lives
  bool visible = false;        // the camera sees it, too
  std::vector<ObjectId> excluded;  // increasing; objects that get nothing from it
  float rate = 1;              // (0, 1]; of its samples behind the first scattering
  std::string sum;             // of light, that it shares with all that name it; "": one of its own
  MaterialId material;         // of emission
  TextureSlot emission;        // of emission: the image that multiplies colour and intensity
  std::shared_ptr<const TexturePyramid> image;  // of suns: the environment's
  float rotation = 0;          // of suns: the environment's
  bool operator==(const Light&) const = default;

  [[nodiscard]] bool excludes(ObjectId object) const {
    return !excluded.empty() && std::ranges::binary_search(excluded, object);
  }
};

}  // namespace relook
