#include "scene/light_controls.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "base/json.h"
#include "scene/compile/place_light.h"

namespace relook {
namespace {

using Kind = LightControl::Kind;
using Path = std::initializer_list<std::string_view>;

std::string pointer_of(Path path) {
  std::string pointer;
  for (const std::string_view token : path) pointer.append("/").append(escape_token(token));
  return pointer;
}

/// Null: the document has no such value.
const Json* value_at(const Json& look, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  return look.contains(place) ? &look.at(place) : nullptr;
}

LightSetting setting_at(const Json& look, std::string color_pointer, std::string intensity_pointer) {
  LightSetting setting;
  if (const Json* color = value_at(look, color_pointer))
    for (std::size_t i = 0; i < setting.color.size(); ++i) setting.color[i] = color->at(i).get<double>();
  if (!intensity_pointer.empty())
    if (const Json* intensity = value_at(look, intensity_pointer)) setting.intensity = intensity->get<double>();
  setting.color_pointer = std::move(color_pointer);
  setting.intensity_pointer = std::move(intensity_pointer);
  return setting;
}

class ControlList {
 public:
  ControlList(const SceneState& state, const std::vector<LightSum>& sums)
      : look_(state.document().look), scene_(state.scene()), sums_(sums) {}

  std::vector<LightControl> all() {
    for (std::size_t i = 0; i < sums_.size(); ++i) add(i);
    return std::move(controls_);
  }

 private:
  void add(std::size_t sum);
  void add_lamp(std::size_t sum, const Light& light);
  void add_shared(std::size_t sum);
  void add_environment(std::size_t sum);
  [[nodiscard]] LightSetting light_setting(const std::string& light) const {
    return setting_at(look_, pointer_of({"lights", light, "color"}), pointer_of({"lights", light, "intensity"}));
  }
  LightControl& make(Kind kind, std::string name, std::size_t sum) {
    return controls_.emplace_back(LightControl{kind, std::move(name), {sum}, {1, 1, 1}, {}});
  }

  const Json& look_;
  const Scene& scene_;
  const std::vector<LightSum>& sums_;
  std::vector<LightControl> controls_;
  std::map<std::string, std::size_t> lamps_;  // places in controls_, by light
};

void ControlList::add(std::size_t sum) {
  const LightSum& light_sum = sums_[sum];
  const bool is_black = light_sum.color == std::array<double, 3>{0, 0, 0};
  switch (light_sum.kind) {
    case LightSum::Kind::light: {
      const Light& light = scene_.light(light_sum.light);
      if (light.kind == LightKind::suns) {
        if (light.image != nullptr) controls_.back().sums.push_back(sum);  // behind the sky
      } else if (light.kind == LightKind::emission) {
        make(Kind::emission, light.light, sum)
            .settings.push_back(setting_at(look_, pointer_of({"materials", light.light, "emissiveFactor"}),
                                           pointer_of({"materials", light.light, "extensions",
                                                       "KHR_materials_emissive_strength", "emissiveStrength"})));
      } else {
        add_lamp(sum, light);
      }
      break;
    }
    case LightSum::Kind::shared:
      add_shared(sum);
      break;
    case LightSum::Kind::sky:
      if (!is_black || scene_.environment.image != nullptr) add_environment(sum);
      break;
    case LightSum::Kind::ambient:
      if (!is_black)
        make(Kind::ambient, "", sum)
            .settings.push_back(setting_at(look_, pointer_of({"scene", "extras", "relook", "ambient"}), ""));
      break;
    case LightSum::Kind::background:
      if (!is_black) {
        const std::string place = pointer_of({"scene", "extras", "relook", "environment", "background"});
        make(Kind::background, "", sum).settings.push_back(setting_at(look_, place + "/color", place + "/intensity"));
      }
      break;
    case LightSum::Kind::unlit: {
      const auto is_seen = [&](const Object& object) {
        return object.alive && scene_.material(object.material).model == IlluminationModel::unlit;
      };
      if (std::ranges::any_of(scene_.objects, is_seen)) make(Kind::fixed, "", sum);
      break;
    }
  }
}

/// Nodes that place the same light have one control.
void ControlList::add_lamp(std::size_t sum, const Light& light) {
  const auto [place, is_new] = lamps_.emplace(light.light, controls_.size());
  if (!is_new) {
    controls_[place->second].sums.push_back(sum);
    return;
  }
  LightControl& control = make(Kind::light, light.light, sum);
  control.settings.push_back(light_setting(light.light));
  const Json* kelvin = value_at(look_, pointer_of({"lights", light.light, "extras", "relook", "temperature"}));
  if (kelvin == nullptr || kelvin->get<double>() <= 0) return;
  const Color color = temperature_color(kelvin->get<double>());
  control.unit = {color.x, color.y, color.z};
}

void ControlList::add_shared(std::size_t sum) {
  LightControl& control = make(Kind::shared, sums_[sum].shared, sum);
  std::set<std::string> lights;
  for (const LightId id : scene_.light_order)
    if (const Light& light = scene_.light(id); light.sum == sums_[sum].shared) lights.insert(light.light);
  for (const std::string& light : lights) control.settings.push_back(light_setting(light));
}

/// Without a colour an image stands as it is.
void ControlList::add_environment(std::size_t sum) {
  const std::string place = pointer_of({"scene", "extras", "relook", "environment"});
  make(Kind::environment, "", sum).settings.push_back(setting_at(look_, place + "/color", place + "/intensity"));
}

}  // namespace

std::string_view control_kind_name(LightControl::Kind kind) {
  constexpr std::array<std::string_view, 7> kNames{"light",   "shared",     "environment", "emission",
                                                   "ambient", "background", "fixed"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<LightControl> light_controls(const SceneState& state, const std::vector<LightSum>& sums) {
  return ControlList(state, sums).all();
}

}  // namespace relook
