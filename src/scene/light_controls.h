// What of a look document scales which sums of light: for each light, or group of lights that share a sum, the values
// that its colour and intensity have and the pointers at which an edit changes them. A frame of Integrator::path is the
// sum over its sums of colour times sum (scene/light_sums.h), so whoever has the sums can show such an edit without a
// ray. Used for relighting in a run's page.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/compile/state.h"
#include "scene/light_sums.h"

namespace relook {

/// Where a colour and an intensity stand in the look document, and their values there or, where it has none, what these
/// are then; "replace" is what changes them. The light's colour is color x intensity x LightControl::unit.
struct LightSetting {
  std::string color_pointer, intensity_pointer;  // "": there is none, its value is 1
  std::array<double, 3> color{1, 1, 1};          // linear RGB
  double intensity = 1;                          // in the light's own unit
};

struct LightControl {
  enum class Kind : std::uint8_t {
    light,
    shared,
    environment,
    emission,
    ambient,
    background,
    fixed
  } kind = Kind::light;
  std::string name;                     // of the light, the shared sum or the material; "" of the others
  std::vector<std::size_t> sums;        // by place in light_sums()
  std::array<double, 3> unit{1, 1, 1};  // of all its settings: linear RGB of a light's temperature
  std::vector<LightSetting> settings;   // one; of a shared sum one a light, of which only changes scale the sum; fixed:
                                        // none, no edit of a colour scales it as a whole
};
[[nodiscard]] std::string_view control_kind_name(LightControl::Kind kind);

/// Of all sums that give light, and of lamps, areas and images around the scene also where they are black: in the order
/// of their first sums. `state`: of Integrator::path. `sums`: of its scene.
[[nodiscard]] std::vector<LightControl> light_controls(const SceneState& state, const std::vector<LightSum>& sums);

}  // namespace relook
