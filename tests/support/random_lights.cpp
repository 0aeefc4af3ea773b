#include "random_lights.h"

#include <algorithm>

namespace relook {
namespace {

const std::vector<std::string> kLights = {"Lamp", "Spot", "Sun", "Window", "Dish"};
const std::vector<std::string> kEmitting = {"Glow", "Cloth", "Matte", "Glass"};
const std::vector<std::string> kSkies = {"SkyImage", "SecondSkyImage", "EvenSkyImage", "PictureImage"};

bool has(const Json& look, const std::string& pointer) { return look.contains(Json::json_pointer(pointer)); }

/// Names of the nodes that place lights.
std::vector<std::string> light_nodes(const Json& look) {
  std::vector<std::string> nodes;
  for (const auto& [name, node] : look.at("nodes").items())
    if (node.contains("extensions") && (node["extensions"].contains("KHR_lights_punctual") ||
                                        node["extensions"].contains("EXT_lights_area")))
      nodes.push_back(name);
  return nodes;
}

/// Sets a member of extras.relook, which may not be there yet.
void set_extra(Change& change, const Json& look, const std::string& owner, const std::string& key, Json value) {
  if (has(look, owner + "/extras/relook")) return change.set(look, owner + "/extras/relook/" + key, std::move(value));
  change.set(look, owner + "/extras", {{"relook", {{key, std::move(value)}}}});
}

void change_gift(Change& change, const Json& look, Dice& dice) {
  const std::string light = "/lights/" + dice.one_of(kLights);
  if (!has(look, light)) return;
  switch (dice.below(6)) {
    case 0:
      return change.set(look, light + "/color", dice.color());
    case 1:
      return change.set(look, light + "/intensity", dice.chance(0.2) ? 0.0 : dice.between(0, 30));
    case 2:
      return set_extra(change, look, light, "temperature", dice.chance(0.3) ? 0.0 : dice.between(2000, 9000));
    case 3:
      return change.set(look, "/lights/Lamp/range", dice.between(3, 9));
    case 4:
      return change.set(look, "/lights/Spot/spot/outerConeAngle", dice.between(0.3, 0.9));
    default:
      return change.set(look, "/scene/extras/relook/ambient", dice.color());
  }
}

void change_shape(Change& change, const Json& look, Dice& dice) {
  const double size = dice.chance(0.3) ? 0.0 : dice.between(0.05, 0.5);
  switch (dice.below(6)) {
    case 0:
      return set_extra(change, look, "/lights/" + dice.one_of(std::vector<std::string>{"Lamp", "Spot"}), "radius", size);
    case 1:
      return set_extra(change, look, "/lights/Sun", "angle", size);
    case 2:
      return change.set(look, "/lights/" + dice.one_of(std::vector<std::string>{"Window", "Dish"}) + "/size",
                        size + 0.25);
    case 3:
      return change.set(look, "/lights/Window/rect", {{"aspect", dice.between(0.25, 4)}});
    case 4:
      return change.set(look, "/lights/Window/type", dice.one_of(std::vector<std::string>{"rect", "disk"}));
    default:
      return set_extra(change, look, "/lights/" + dice.one_of(kLights), "rate", dice.between(0.25, 1));
  }
}

void change_place(Change& change, const Json& look, Dice& dice) {
  const std::vector<std::string> nodes = light_nodes(look);
  const Json place = {dice.between(-2, 2), dice.between(1, 4), dice.between(-1, 3)};
  const std::string extra = "/nodes/" + dice.one_of(std::vector<std::string>{"A0", "M0", "Z0"});
  if (has(look, extra) && dice.chance(0.5)) return change.remove(look, extra);
  if (nodes.empty() || dice.chance(0.2)) {
    const std::string light = dice.one_of(kLights);
    const bool is_area = light == "Window" || light == "Dish";
    Json node = {{"translation", place}, {"rotation", {-0.5, 0, 0, 0.8660254}}};
    node["extensions"][is_area ? "EXT_lights_area" : "KHR_lights_punctual"]["light"] = light;
    return change.set(look, extra, node);
  }
  const std::string node = "/nodes/" + dice.one_of(nodes);
  switch (dice.below(6)) {
    case 0:
    case 1:
      return change.set(look, node + "/translation", place);
    case 2:
      return change.set(look, node + "/rotation", {dice.between(-0.7, -0.1), dice.between(-0.4, 0.4), 0, 0.8});
    case 3:
      return change.set(look, node + "/extensions/KHR_node_visibility/visible", dice.chance(0.6));
    case 4:
      return set_extra(change, look, node, "visible", dice.chance(0.5));
    default:
      return set_extra(change, look, node, "excludes",
                       dice.chance(0.4) ? Json::array()
                                        : Json::array({dice.one_of(std::vector<std::string>{"Ball", "Ground"})}));
  }
}

void change_sky(Change& change, const Json& look, Dice& dice) {
  const std::string sky = "/scene/extras/relook/environment";
  switch (dice.below(6)) {
    case 0:
      return change.set(look, sky + "/color", dice.color());
    case 1:
      return change.set(look, sky + "/intensity", dice.between(0, 2));
    case 2:
      return change.set(look, sky + "/rotation", dice.between(-3, 3));
    case 3:
      if (has(look, sky + "/image") && dice.chance(0.3)) return change.remove(look, sky + "/image");
      return change.set(look, sky + "/image", dice.one_of(kSkies));
    case 4:
      return change.set(look, sky + "/background",
                        dice.chance(0.5) ? Json() : Json{{"color", dice.color()}, {"rotation", dice.between(0, 1)}});
    default:
      return change.set(look, sky + "/background", {{"image", dice.one_of(kSkies)}, {"intensity", dice.between(0, 1)}});
  }
}

void change_emission(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kEmitting);
  if (!has(look, material)) return;
  switch (dice.below(4)) {
    case 0:
    case 1:
      return change.set(look, material + "/emissiveFactor", dice.chance(0.4) ? Json{0, 0, 0} : dice.color());
    case 2:
      return change.set(look, material + "/emissiveTexture",
                        {{"index", dice.one_of(std::vector<std::string>{"Picture", "Second"})}});
    default:
      if (!has(look, "/nodes/Glow")) return;
      return change.set(look, "/nodes/Glow/translation", {dice.between(-1, 1), dice.between(0.2, 1.5), 1.5});
  }
}

}  // namespace

Change random_light_change(const Json& look, Dice& dice) {
  for (;;) {
    Change change;
    switch (dice.below(5)) {
      case 0:
        change_gift(change, look, dice);
        break;
      case 1:
        change_shape(change, look, dice);
        break;
      case 2:
        change_place(change, look, dice);
        break;
      case 3:
        change_sky(change, look, dice);
        break;
      default:
        change_emission(change, look, dice);
    }
    if (!change.forward.empty()) return change;
  }
}

Change random_path_change(const Json& look, Dice& dice) {
  if (dice.chance(0.35)) return random_change(look, dice);
  Change change = random_light_change(look, dice);
  if (!dice.chance(0.3)) return change;
  const Change other = random_change(look, dice);
  const auto starts = [](const Json& a, const Json& b) {
    return a["path"].get<std::string>().starts_with(b["path"].get<std::string>());
  };
  for (const Json& mine : change.forward)
    for (const Json& theirs : other.forward)
      if (starts(mine, theirs) || starts(theirs, mine)) return change;
  change.forward.insert(change.forward.end(), other.forward.begin(), other.forward.end());
  change.backward.insert(change.backward.begin(), other.backward.begin(), other.backward.end());
  return change;
}

}  // namespace relook
