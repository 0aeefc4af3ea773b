#include "color/surface/node_key.h"

namespace relook {

NodeKey restricted(NodeKey key, const ColorPart& part) {
  key.aspect = part.aspect;
  key.sources &= part.sources;
  key.children = key.children & part.branches;
  if (part.all_lamps) return key;
  key.sums = false;
  std::erase_if(key.lights, [&](const VisibleLight& light) { return light.light != part.lamp; });
  return key;
}

}  // namespace relook
