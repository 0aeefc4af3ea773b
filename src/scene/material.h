// A material as the look document says it, compiled: plain values, compared as a whole to find out what an edit
// changed. glTF 2.0 section 5.19 and the KHR_materials_* extensions; extras.relook for what glTF lacks.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "base/math.h"
#include "scene/texture/texture.h"

namespace relook {

enum class IlluminationModel : std::uint8_t { metallic_roughness, blinn_phong, unlit };
enum class AlphaMode : std::uint8_t { opaque, mask, blend };
enum class ProceduralKind : std::uint8_t { marble, wood, checker, noise };
/// Where a texture takes its coordinates from. `solid` hands the object-space position to a procedural texture.
enum class Mapping : std::uint8_t { uv, planar, spherical, cylindrical, solid };

/// A solid (3D) texture: evaluated at the object-space position, or at (u, v, 0).
struct Procedural {
  ProceduralKind kind = ProceduralKind::noise;
  float scale = 1;           // cycles per unit of the coordinate
  float turbulence = 1;      // strength of the distortion (marble, wood); contrast (noise)
  std::int32_t octaves = 4;  // 1..16
  Color color1{0, 0, 0}, color2{1, 1, 1};
  bool operator==(const Procedural&) const = default;
};

enum class TextureKind : std::uint8_t { none, image, procedural };

/// One texture slot of a material, resolved: no names left.
struct TextureSlot {
  TextureKind kind = TextureKind::none;
  std::shared_ptr<const TexturePyramid> pyramid;  // kind image
  Procedural procedural;                          // kind procedural
  TextureSampler sampler;                         // kind image
  Mapping mapping = Mapping::uv;
  std::uint8_t axis = 1;                          // of planar, spherical, cylindrical: 0 x, 1 y, 2 z
  std::uint8_t texcoord = 0;                      // 0 or 1
  Imath::V2f offset{0, 0}, scale{1, 1};           // KHR_texture_transform
  float rotation = 0;                             // radians, counter-clockwise in uv
  bool operator==(const TextureSlot&) const = default;
};

/// In the order in which sentences name them.
enum class Slot : std::uint8_t {
  base_color, metallic_roughness, normal, occlusion, emissive,
  transmission, thickness, specular, specular_color,
  clearcoat, clearcoat_roughness, clearcoat_normal, sheen_color, sheen_roughness,
  anisotropy, iridescence, iridescence_thickness,
  count
};
inline constexpr std::size_t kSlotCount = static_cast<std::size_t>(Slot::count);

/// What a look document calls its members, and all else there is to know of them: material_fields.h.
struct Material {
  std::string name;
  IlluminationModel model = IlluminationModel::metallic_roughness;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false;

  Rgba base_color{1, 1, 1, 1};
  float metallic = 1, roughness = 1;
  float normal_scale = 1, occlusion_strength = 1;
  Color emissive{0, 0, 0};                 // emissiveFactor
  float emissive_strength = 1;
  float ior = 1.5F;                        // KHR_materials_ior; also of blinn-phong refraction
  float dispersion = 0;                    // 20 / Abbe number; of a volume
  float transmission = 0;
  float thickness = 0;                     // > 0: a volume, otherwise thin-walled
  float attenuation_distance = std::numeric_limits<float>::infinity();  // metres
  Color attenuation_color{1, 1, 1};
  float specular = 1;
  Color specular_color{1, 1, 1};
  float clearcoat = 0, clearcoat_roughness = 0, clearcoat_normal_scale = 1;
  Color sheen_color{0, 0, 0};
  float sheen_roughness = 0;
  float anisotropy = 0;           // anisotropyStrength
  float anisotropy_rotation = 0;  // radians, counter-clockwise from the tangent
  float iridescence = 0, iridescence_ior = 1.3F;
  float iridescence_minimum = 100, iridescence_maximum = 400;  // thickness of the film, nanometres

  // extras.relook, model blinn-phong: coefficients multiply the base colour (ambient, diffuse) or the light (specular).
  Color phong_ambient{1, 1, 1}, phong_diffuse{1, 1, 1}, phong_specular{0.5F, 0.5F, 0.5F};
  float shininess = 32;
  float reflection = 0, refraction = 0, transparency = 0;  // proportions in [0, 1]

  std::array<TextureSlot, kSlotCount> slots;

  [[nodiscard]] const TextureSlot& slot(Slot s) const { return slots[static_cast<std::size_t>(s)]; }
  [[nodiscard]] TextureSlot& slot(Slot s) { return slots[static_cast<std::size_t>(s)]; }
  bool operator==(const Material&) const = default;
};

}  // namespace relook
