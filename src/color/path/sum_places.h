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

  // By source of light: the places of the light order, and behind these the four below. Into which sum its terms go;
  // what multiplies them, 1 in a sum of its own.
  std::vector<std::uint32_t> sum_of;
  std::vector<Color> colors;
  std::uint32_t sky, ambient, background, unlit;
  std::vector<std::uint8_t> shares;  // by place in the light order: is its sum one that lights share?
  std::size_t count = 0;             // of sums

  [[nodiscard]] std::uint32_t lights() const { return sky; }

 private:
  void place_members(const Scene& scene, const std::string& name, std::uint32_t sum);
};

}  // namespace relook
