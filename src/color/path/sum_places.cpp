#include "color/path/sum_places.h"

#include <algorithm>

namespace relook {

SumPlaces::SumPlaces(const Scene& scene, std::span<const LightSum> sums)
    : of_light(scene.light_order.size()), count(sums.size()) {
  for (std::uint32_t place = 0; place < sums.size(); ++place) {
    switch (sums[place].kind) {
      case LightSum::Kind::light: {
        const auto light = std::ranges::find(scene.light_order, sums[place].light);
        of_light[static_cast<std::size_t>(light - scene.light_order.begin())] = place;
        break;
      }
      case LightSum::Kind::sky:
        sky = place;
        break;
      case LightSum::Kind::ambient:
        ambient = place;
        break;
      case LightSum::Kind::background:
        background = place;
        break;
      case LightSum::Kind::unlit:
        unlit = place;
        break;
    }
  }
}

}  // namespace relook
