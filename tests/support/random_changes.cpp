#include "random_changes.h"

#include <algorithm>
#include <cstdlib>

namespace relook {

std::uint64_t seed_of_run() {
  const char* given = std::getenv("RELOOK_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : 1996;
}

namespace {

const std::vector<std::string> kMaterials = {"Matte", "Mirror", "Glass", "Ground"};
const std::vector<std::string> kImages = {"PictureImage", "SecondImage", "BumpImage", "LeafImage", "VeilImage"};

void change_color(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  const auto brush = [&] { return material + "/extensions/KHR_materials_anisotropy"; };
  switch (dice.below(15)) {
    case 0: {
      Json color = dice.color();
      color.push_back(dice.between(0.2, 1));
      return change.set(look, material + "/pbrMetallicRoughness/baseColorFactor", color);
    }
    case 1:
      return change.set(look, material + "/pbrMetallicRoughness/metallicFactor", dice.between(0, 1));
    case 2:
      return change.set(look, material + "/emissiveFactor", dice.color());
    case 3:
      return change.set(look, material + "/extensions/KHR_materials_sheen/sheenColorFactor", dice.color());
    case 4:
      return change.set(look, "/lights/Lamp/intensity", dice.between(0, 80));
    case 5:
      return change.set(look, "/lights/Lamp/color", dice.color());
    case 6:
      return change.set(look, "/scene/extras/relook/ambient", dice.color());
    case 7:
      return change.set(look, "/scene/extras/relook/environment/color", dice.color());
    case 8:
      return change.set(look, "/textures/Marble/extras/relook/procedural/kind",
                        dice.one_of(std::vector<std::string>{"marble", "wood", "checker", "noise"}));
    case 9:
      return change.set(look, "/textures/Marble/extras/relook/procedural/scale", dice.between(0.5, 4));
    case 10:
      return change.set(look, "/textures/Picture/source", dice.one_of(kImages));
    case 11:
      return change.set(look, brush() + "/anisotropyStrength", dice.chance(0.3) ? 0.0 : dice.between(0, 1));
    case 12:
      return change.set(look, brush() + "/anisotropyRotation", dice.between(-4, 4));
    case 13:
      return change.set(look, brush() + "/anisotropyTexture", {{"index", "Bumps"}});
    default:
      return change.set(look, material + "/extras/relook/diffuse", dice.color());
  }
}

void change_optics(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  const auto weight = [&] { return dice.chance(0.4) ? 0.0 : dice.between(0, 1); };
  const Json bumps = {{"index", "Bumps"}, {"scale", dice.between(0, 1)}};
  switch (dice.below(14)) {
    case 0:
      return change.set(look, material + "/pbrMetallicRoughness/roughnessFactor", dice.between(0, 0.5));
    case 1:
      return change.set(look, material + "/extensions/KHR_materials_transmission/transmissionFactor", weight());
    case 2:
      return change.set(look, material + "/extensions/KHR_materials_volume/thicknessFactor", weight());
    case 3:
      return change.set(look, material + "/extensions/KHR_materials_ior/ior", dice.between(1, 2.5));
    case 4:
      return change.set(look, material + "/extensions/KHR_materials_clearcoat/clearcoatFactor", weight());
    case 5:
      return change.set(look, material + "/normalTexture", bumps);
    case 6:
      return change.set(look, material + "/extras/relook/model",
                        dice.one_of(std::vector<std::string>{"metallic-roughness", "blinn-phong", "unlit"}));
    case 7:
      return change.set(look, material + "/extras/relook/reflection", weight());
    case 8:
      return change.set(look, material + "/extras/relook/refraction", weight());
    case 9:
      return change.set(look, material + "/extras/relook/transparency", weight());
    case 10:
      return change.set(look, material + "/extensions/KHR_materials_iridescence/iridescenceFactor", weight());
    case 11:
      return change.set(look, material + "/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum",
                        dice.between(100, 900));
    case 12:
      return change.set(look, material + "/extensions/KHR_materials_dispersion/dispersion", 8 * weight());
    default:
      return change.set(look, material + "/extensions/KHR_materials_specular/specularFactor", weight());
  }
}

void change_geometry(Change& change, const Json& look, Dice& dice) {
  const std::string material = "/materials/" + dice.one_of(kMaterials);
  const std::string ball = dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall"});
  const std::string extra = "/nodes/Extra" + std::to_string(dice.below(4));
  const Json place = {dice.between(-1.5, 1.5), dice.between(0.3, 1.2), dice.between(-1, 1.5)};
  switch (dice.below(9)) {
    case 0:
      return change.set(look, "/nodes/" + ball + "/translation", place);
    case 1:
      return change.set(look, "/nodes/" + ball + "/scale", {dice.between(0.5, 1.3), dice.between(-1, -0.5), 1});
    case 2:
      return change.set(look, "/nodes/" + ball + "/extensions/KHR_node_visibility/visible", dice.chance(0.6));
    case 3:
      return change.set(look, "/nodes/Lamp/translation", {dice.between(-3, 3), dice.between(2, 5), dice.between(0, 4)});
    case 4: {
      if (look.contains(Json::json_pointer(extra))) return change.remove(look, extra);
      if (dice.chance(0.3))
        return change.set(look, extra,
                          {{"translation", place}, {"extensions", {{"KHR_lights_punctual", {{"light", "Lamp"}}}}}});
      if (dice.chance(0.4)) {  // the same surface in the same place: ties
        const Json& twin = look.at(Json::json_pointer("/nodes/" + ball));
        return change.set(look, extra,
                          {{"mesh", ball},
                           {"translation", twin.at("translation")},
                           {"rotation", twin.at("rotation")},
                           {"scale", twin.at("scale")}});
      }
      return change.set(look, extra, {{"mesh", ball}, {"translation", place}, {"scale", {0.5, 0.5, 0.5}}});
    }
    case 5: {
      const std::string displacement = "/nodes/Ball/extras/relook/displacement";
      if (look.contains(Json::json_pointer(displacement)) && dice.chance(0.5)) return change.remove(look, displacement);
      if (!look.contains(Json::json_pointer("/nodes/Ball/extras/relook")))
        change.set(look, "/nodes/Ball/extras", {{"relook", Json::object()}});
      return change.set(look, displacement, {{"texture", "Picture"}, {"scale", dice.between(-0.2, 0.2)}});
    }
    case 6:
      return change.set(look, "/meshes/" + ball + "/primitives/0/material", dice.one_of(kMaterials));
    case 7:
      if (dice.chance(0.4)) return change.set(look, material + "/doubleSided", dice.chance(0.5));
      return change.set(look, material + "/alphaMode",
                        dice.one_of(std::vector<std::string>{"OPAQUE", "MASK", "BLEND"}));
    default:
      return change.set(look, material + "/pbrMetallicRoughness/baseColorTexture",
                        {{"index", dice.one_of(std::vector<std::string>{"Picture", "Leaves", "Veil", "Marble"})}});
  }
}

}  // namespace

Json random_deformation(Dice& dice) {
  Json edit = Json::array();
  const auto set = [&](const std::string& pointer, Json value) {
    edit.push_back({{"op", "replace"}, {"path", pointer}, {"value", std::move(value)}});
  };
  const std::size_t count = 1 + dice.below(3);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string joint = "/nodes/" + dice.one_of(std::vector<std::string>{"Rig", "Hip", "Chest"});
    const std::string morphed =
        "/nodes/" + dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall", "Post"});
    switch (dice.below(5)) {
      case 0:
        set(joint + "/translation", {dice.between(-0.5, 0.5), dice.between(-0.2, 0.8), dice.between(-0.5, 0.5)});
        break;
      case 1:
        set(joint + "/rotation", {dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1), 1});
        break;
      case 2:
        set(joint + "/scale", {dice.between(0.6, 1.3), dice.between(-1, 1), 1});
        break;
      default:
        set(morphed + "/weights/" + std::to_string(dice.below(2)), dice.chance(0.3) ? 0.0 : dice.between(-1, 1));
    }
  }
  return edit;
}

Change random_change(const Json& look, Dice& dice) {
  Change change;
  const std::size_t count = dice.chance(0.7) ? 1 : 2 + dice.below(2);
  for (std::size_t i = 0; i < count; ++i) {
    Change next;
    const double kind = dice.between(0, 1);
    if (kind < 0.35)
      change_color(next, look, dice);
    else if (kind < 0.6)
      change_optics(next, look, dice);
    else
      change_geometry(next, look, dice);
    const auto touches = [&](const Json& other) { return other["path"] == next.forward.front()["path"]; };
    if (std::any_of(change.forward.begin(), change.forward.end(), touches)) continue;
    change.forward.insert(change.forward.end(), next.forward.begin(), next.forward.end());
    change.backward.insert(change.backward.begin(), next.backward.begin(), next.backward.end());
  }
  return change;
}

Edit edit_of_list(const std::vector<Json>& operations) { return edit_of(Json(operations)); }

Change random_movement(const Json& look, const std::string& node, Dice& dice) {
  Change change;
  const std::string pointer = "/nodes/" + node;
  if (dice.chance(0.15))
    change.set(look, pointer + "/extensions/KHR_node_visibility/visible", dice.chance(0.5));
  else if (dice.chance(0.3))
    change.set(look, pointer + "/scale", {dice.between(0.5, 1.3), dice.between(0.5, 1), 1});
  else
    change.set(look, pointer + "/translation", {dice.between(-1.5, 1.5), dice.between(0.3, 3), dice.between(-1, 1.5)});
  return change;
}

SceneState small_scene(TestScene scene, const ViewOptions& view) {
  return view.samples == 1 ? test_scene(scene, 80, 60) : test_scene(scene, 36, 27);
}

Replayer replayer_of(TestScene scene, ViewOptions view, const RegionOptions& regions,
                     const ResidencyOptions& residency) {
  SceneState state = small_scene(scene, view);
  Image image = preprocessed(state.scene(), view);
  return Replayer(std::move(state), std::move(image), regions, std::make_unique<Residency>(residency));
}

}  // namespace relook
