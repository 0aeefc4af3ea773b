#include "color/expression/field.h"

#include <cmath>
#include <limits>

namespace relook {

float slot_color(const TextureSlot& slot, unsigned component) {
  const Procedural& texture = slot.procedural;
  return component < 3 ? texture.color1[static_cast<int>(component)] : texture.color2[static_cast<int>(component - 3)];
}

float field_value(const Light& light, LightField field) {
  switch (field) {
    case LightField::red:
      return light.color.x;
    case LightField::green:
      return light.color.y;
    case LightField::blue:
      return light.color.z;
    case LightField::intensity:
      return light.intensity;
    case LightField::inverse_range:
      return std::isinf(light.range) ? 0.0F : 1.0F / light.range;
    case LightField::outer_versine: {
      const double half = std::sin(0.5 * double{light.outer_cone});
      return static_cast<float>(2 * half * half);
    }
    case LightField::inverse_cone_width: {
      const double inner = double{light.inner_cone}, outer = double{light.outer_cone};
      const double width = 2 * std::sin(0.5 * (outer + inner)) * std::sin(0.5 * (outer - inner));
      constexpr double kMost = std::numeric_limits<float>::max();
      return static_cast<float>(width > 1 / kMost ? 1 / width : kMost);
    }
    case LightField::x:
      return light.position.x;
    case LightField::y:
      return light.position.y;
    case LightField::z:
      return light.position.z;
    case LightField::dx:
      return light.direction.x;
    case LightField::dy:
      return light.direction.y;
    case LightField::dz:
      return light.direction.z;
  }
  return 0;
}

}  // namespace relook
