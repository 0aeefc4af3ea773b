// Images, materials and nodes that several of the test scenes have.
#pragma once
#include <cmath>
#include <cstdint>

#include "test_scenes.h"

namespace relook {

/// Is it an odd cell of a checkerboard whose cells have so many texels a side?
inline bool odd_cell(std::uint32_t x, std::uint32_t y, std::uint32_t cell) { return ((x / cell + y / cell) & 1U) != 0; }

inline Rgba second_picture_texel(std::uint32_t x, std::uint32_t y) {
  return odd_cell(x, y, 4) ? Rgba(0.1F, 0.3F, 0.7F, 1) : Rgba(0.9F, 0.8F, 0.3F, 1);
}
inline Rgba veil_texel(std::uint32_t x, std::uint32_t y) {
  return Rgba(0.9F, 0.5F, 0.3F, odd_cell(x, y, 4) ? 0.35F : 0.8F);
}
inline Rgba bump_texel(std::uint32_t x, std::uint32_t y) {
  const auto wave = [](std::uint32_t i) { return 0.5F + 0.12F * std::sin(static_cast<float>(i) * 0.785398F); };
  return Rgba(wave(x), wave(y + 3), 0.95F, 1);
}
inline Rgba second_bump_texel(std::uint32_t x, std::uint32_t y) {
  const Rgba bump = bump_texel(y * 2, x);
  return Rgba(bump.g, bump.r, 0.9F, 1);
}

/// Of metallic-roughness, without textures.
inline Json plain(float r, float g, float b, float metallic, float roughness) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}}}};
}

/// A node turned by `degrees` about +y.
inline Json placed(int mesh, float x, float y, float z, float degrees = 0) {
  const float half = degrees * 0.00872665F;
  return {{"mesh", mesh}, {"translation", {x, y, z}}, {"rotation", {0, std::sin(half), 0, std::cos(half)}}};
}

}  // namespace relook
