// sample_point() (point_set.h) for several hits side by side: the same bits, lane by lane.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "light/point_set.h"

namespace relook {

inline constexpr std::size_t kPointLanes = 16;

/// What points are known by. Lanes that are not in use may hold anything.
struct PointKeys {
  std::array<std::uint32_t, kPointLanes> pixel{}, sample{};
  std::array<std::uint64_t, kPointLanes> history{};

  void set(std::size_t lane, const SampleKey& key, std::uint64_t of_history) {
    pixel[lane] = key.pixel;
    sample[lane] = key.sample;
    history[lane] = of_history;
  }
};
struct PointLanes {
  std::array<float, kPointLanes> x, y;
  [[nodiscard]] Uv at(std::size_t lane) const { return {x[lane], y[lane]}; }
};
void sample_points(const PointKeys& keys, Purpose purpose, std::uint64_t name, PointLanes& points);

}  // namespace relook
