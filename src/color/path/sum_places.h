// Where in a frame's sums of light the terms of a path go: the places of light_sums() by what they are of.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scene/light_sums.h"

namespace relook {

struct SumPlaces {
  /// `sums`: light_sums() of the scene.
  SumPlaces(const Scene& scene, std::span<const LightSum> sums);

  // By place in the light order: its sum; is it one that lights share; what multiplies the terms, 1 in a sum of its own.
  std::vector<std::uint32_t> of_light;
  std::vector<std::uint8_t> shares;
  std::vector<Color> colors;
  std::uint32_t sky = 0, ambient = 0, background = 0, unlit = 0;
  std::size_t count = 0;

 private:
  void place_members(const Scene& scene, const std::string& name, std::uint32_t sum);
};

}  // namespace relook
