#include "color/surface/node_key.h"

namespace relook {

NodeKey restricted(NodeKey key, const ColorPart& part) {
  key.aspect = part.aspect;
  key.sources &= part.sources;
  key.children = key.children & part.branches;
  if (!part.all_lamps) std::erase_if(key.lights, [&](const VisibleLight& light) { return light.light != part.lamp; });
  return key;
}

std::vector<VisibleLight> asked_lights(std::span<const LightId> order) {
  std::vector<VisibleLight> lights;
  lights.reserve(order.size());
  for (std::uint32_t place = 0; place < order.size(); ++place) lights.push_back({order[place], place, true, true});
  return lights;
}

}  // namespace relook
