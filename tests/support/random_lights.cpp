#include "random_lights.h"

#include <algorithm>

namespace relook {
namespace {

const std::vector<std::string> kLights = {"Lamp", "Spot", "Sun", "Window", "Dish"};
const std::vector<std::string> kEmitting = {"Glow", "Cloth", "Matte", "Glass"};
const std::vector<std::string> kSkies = {"SkyImage", "SecondSkyImage", "EvenSkyImage", "PictureImage"};

bool has(const Json& look, const std::string& pointer) { return look.contains(Json::json_pointer(pointer)); }

/// Those of the names that a section has.
std::vector<std::string> known(const Json& look, const char* section, std::vector<std::string> names) {
  std::erase_if(names, [&](const std::string& name) { return !look.at(section).contains(name); });
  return names;
}

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
  const std::string light = "/lights/" + dice.one_of(known(look, "lights", kLights));
  switch (dice.below(7)) {
    case 0:
      return change.set(look, light + "/color", dice.color());
    case 1:
      return change.set(look, light + "/intensity", dice.chance(0.2) ? 0.0 : dice.between(0, 30));
    case 2:
      return set_extra(change, look, light, "temperature", dice.chance(0.3) ? 0.0 : dice.between(2000, 9000));
    case 3:
      return change.set(look, "/lights/Lamp/range", dice.between(3, 9));
    case 4:
      return set_extra(change, look, light, "sum", dice.one_of(std::vector<std::string>{"", "set", "others"}));
    case 5:
      if (!has(look, "/lights/Spot")) return;
      return change.set(look, "/lights/Spot/spot/outerConeAngle", dice.between(0.3, 0.9));
    default:
      return change.set(look, "/scene/extras/relook/ambient", dice.color());
  }
}

void change_shape(Change& change, const Json& look, Dice& dice) {
  const double size = dice.chance(0.3) ? 0.0 : dice.between(0.05, 0.5);
  const std::string name = dice.one_of(known(look, "lights", kLights)), light = "/lights/" + name;
  if (dice.chance(0.2)) return set_extra(change, look, light, "rate", dice.between(0.25, 1));
  if (name == "Sun") return set_extra(change, look, light, "angle", size);
  if (name == "Lamp" || name == "Spot") return set_extra(change, look, light, "radius", size);
  switch (name == "Window" ? dice.below(3) : 0) {
    case 0:
      return change.set(look, light + "/size", size + 0.25);
    case 1:
      return change.set(look, light + "/rect", {{"aspect", dice.between(0.25, 4)}});
    default:
      return change.set(look, light + "/type", dice.one_of(std::vector<std::string>{"rect", "disk"}));
  }
}

void change_place(Change& change, const Json& look, Dice& dice) {
  const std::vector<std::string> nodes = light_nodes(look);
  const Json place = {dice.between(-2, 2), dice.between(1, 4), dice.between(-1, 3)};
  const std::string extra = "/nodes/" + dice.one_of(std::vector<std::string>{"A0", "M0", "Z0"});
  if (has(look, extra) && dice.chance(0.5)) return change.remove(look, extra);
  if (nodes.empty() || dice.chance(0.2)) {
    const std::string light = dice.one_of(known(look, "lights", kLights));
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
  const std::string image = dice.one_of(known(look, "images", kSkies));
  switch (dice.below(6)) {
    case 0:
      return change.set(look, sky + "/color", dice.color());
    case 1:
      return change.set(look, sky + "/intensity", dice.between(0, 2));
    case 2:
      return change.set(look, sky + "/rotation", dice.between(-3, 3));
    case 3:
      if (has(look, sky + "/image") && dice.chance(0.3)) return change.remove(look, sky + "/image");
      return change.set(look, sky + "/image", image);
    case 4:
      if (has(look, sky + "/background")) return change.remove(look, sky + "/background");
      return change.set(look, sky + "/background", {{"color", dice.color()}, {"rotation", dice.between(0, 1)}});
    default:
      return change.set(look, sky + "/background", {{"image", image}, {"intensity", dice.between(0, 1)}});
  }
}

void change_emission(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(known(look, "materials", kEmitting));
  switch (dice.below(4)) {
    case 0:
    case 1:
      return change.set(look, material + "/emissiveFactor", dice.chance(0.4) ? Json{0, 0, 0} : dice.color());
    case 2:
      return change.set(look, material + "/emissiveTexture",
                        {{"index", dice.one_of(known(look, "textures", {"Picture", "Second"}))}});
    default:
      for (const std::string node : {"/nodes/Glow", "/nodes/Glowing"})
        if (has(look, node))
          change.set(look, node + "/translation", {dice.between(-1, 1), dice.between(0.2, 1.5), 1.5});
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
