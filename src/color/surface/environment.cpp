// The surroundings, as a ray that leaves the scene meets them.
#include "color/surface/models.h"

namespace relook {

Triple environment_color(SurfaceTerms& terms) {
  if (terms.key().aspect != Aspect::color || !terms.counts(kEnvironmentSource)) return terms.grey(0);
  ExpressionBuilder& b = terms.builder();
  Triple color{{&b, b.environment(0)}, {&b, b.environment(1)}, {&b, b.environment(2)}};
  if (b.scene().environment.image) {
    const Triple direction = terms.view() * terms.number(-1);
    const Value lookup = b.environment_map(direction.x.value, direction.y.value, direction.z.value);
    color = color * Triple{{&b, lookup}, {&b, b.channel(lookup, 1)}, {&b, b.channel(lookup, 2)}};
  }
  return color;
}

}  // namespace relook
