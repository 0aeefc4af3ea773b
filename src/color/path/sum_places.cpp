#include "color/path/sum_places.h"

#include <algorithm>

namespace relook {
namespace {

/// The colour with which a light's terms go into a sum that it shares.
Color color_of_terms(const Light& light) {
  const std::array<double, 3> color = color_of_light(light);
  return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}

}  // namespace

SumPlaces::SumPlaces(const Scene& scene, std::span<const LightSum> sums)
    : sum_of(scene.light_order.size() + 4),
      colors(sum_of.size(), Color(1, 1, 1)),
      sky(static_cast<std::uint32_t>(scene.light_order.size())),
      ambient(sky + 1),
      background(sky + 2),
      unlit(sky + 3),
      shares(lights(), 0),
      count(sums.size()) {
  for (std::uint32_t place = 0; place < sums.size(); ++place) {
    switch (sums[place].kind) {
      case LightSum::Kind::light: {
        const auto light = std::ranges::find(scene.light_order, sums[place].light);
        sum_of[static_cast<std::size_t>(light - scene.light_order.begin())] = place;
        break;
      }
      case LightSum::Kind::shared:
        place_members(scene, sums[place].shared, place);
        break;
      case LightSum::Kind::sky:
        sum_of[sky] = place;
        break;
      case LightSum::Kind::ambient:
        sum_of[ambient] = place;
        break;
      case LightSum::Kind::background:
        sum_of[background] = place;
        break;
      case LightSum::Kind::unlit:
        sum_of[unlit] = place;
        break;
    }
  }
}

void SumPlaces::place_members(const Scene& scene, const std::string& name, std::uint32_t sum) {
  for (std::size_t place = 0; place < scene.light_order.size(); ++place) {
    const Light& light = scene.light(scene.light_order[place]);
    if (light.sum != name) continue;
    sum_of[place] = sum;
    shares[place] = 1;
    colors[place] = color_of_terms(light);
  }
}

}  // namespace relook
