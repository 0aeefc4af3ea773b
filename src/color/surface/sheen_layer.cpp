#include "color/surface/sheen_layer.h"

#include "physics/lobe_angles.h"
#include "physics/sheen.h"

namespace relook {

SheenLayer::SheenLayer(SurfaceTerms& terms, const Triple& normal, Scalar nv)
    : color_(terms.textured3(Field::sheen_color, Slot::sheen_color)),
      roughness_(terms.textured(Field::sheen_roughness, Slot::sheen_roughness, 3)),
      normal_(normal),
      view_(terms.view()),
      nv_(nv) {}

Triple SheenLayer::reflected(const Triple& direction) {
  const Scalar inverse_alpha = inverse_sheen_alpha(roughness_);
  const LobeAngles<Triple> at = lobe_angles(normal_, view_, direction);
  return color_ * (sheen(inverse_alpha, at.nh, at.nl, nv_) * at.nl);
}

Scalar SheenLayer::passed() { return below_sheen(color_, nv_, roughness_); }

}  // namespace relook
