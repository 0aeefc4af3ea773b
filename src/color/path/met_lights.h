// The light that a ray of a path brings of what it meets beside surfaces: shapes of lights that it crosses, and what
// surrounds the scene where it leaves it. Inside src/color/path.
#pragma once
#include <vector>

#include "color/path/light_terms.h"

namespace relook {

class MetLights {
 public:
  /// `scene` outlives it.
  explicit MetLights(const ColorScene& scene);

  /// Calls add(place, unit light) for each light whose shape the ray to a node crosses and that is_wanted(place).
  template <class IsWanted, class Add>
  void cross(const RayNode& node, const IsWanted& is_wanted, const Add& add) const {
    for (const std::uint32_t place : shapes_) {
      if (!is_wanted(place)) continue;
      const Light& light = light_at(place);
      if (!may_meet(node, scene_.light(place), light)) continue;
      if (const auto radiance = crossed(node, scene_.light(place), light)) add(place, Color(*radiance));
    }
  }

  /// What a ray that leaves the scene may be asked for, and what it brings of it.
  struct Surroundings {
    bool background = false, sky = false, suns = false;
  };
  struct UnitLight {
    Surroundings has;
    Color background, sky, suns;
  };
  [[nodiscard]] UnitLight surroundings(const RayNode& node, Surroundings wanted) const;
  /// The place of the suns.
  [[nodiscard]] std::uint32_t suns() const { return suns_; }

 private:
  [[nodiscard]] const Light& light_at(std::uint32_t place) const {
    return scene_.scene().light(scene_.light_order()[place]);
  }
  [[nodiscard]] Color background(const Direction& way) const;

  const ColorScene& scene_;
  std::vector<std::uint32_t> shapes_;  // places of lights with a shape
  std::uint32_t suns_ = 0;
};

}  // namespace relook
