#include "edit/draft/draft_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "edit/draft/draft_moves.h"
#include "edit/draft/placement.h"
#include "scene/look/look_bounds.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

/// One light, in radii of the target's bounds.
struct RigLight {
  std::string_view name;
  double azimuth, elevation;  // degrees, see AimOptions
  double distance;
  double height, aspect;  // aspect 0: a disk
  double level;           // share of the key's on a surface that faces it
  std::array<double, 3> color;
};

constexpr std::array<double, 3> kWarm{1.0, 0.95, 0.88}, kNeutral{1.0, 1.0, 1.0}, kCool{0.88, 0.94, 1.0};

std::vector<RigLight> lights_of(std::string_view style) {
  if (style == "softboxes")
    return {{"Key", -60, 25, 3.2, 2.6, 0.7, 1, kNeutral},
            {"Fill", 60, 20, 3.6, 2.6, 0.7, 0.45, kNeutral},
            {"Top", 180, 75, 3.2, 2.2, 1.4, 0.6, kNeutral}};
  if (style == "rim")
    return {{"RimLeft", -145, 25, 3.2, 2.6, 0.3, 1, kNeutral},
            {"RimRight", 145, 25, 3.2, 2.6, 0.3, 0.8, kNeutral},
            {"Fill", 10, 20, 4.5, 2.5, 1, 0.06, kCool}};
  if (style == "product")
    return {{"Top", 180, 72, 3, 2.2, 1.6, 1, kNeutral},
            {"StripLeft", -80, 15, 3, 3, 0.2, 0.6, kNeutral},
            {"StripRight", 100, 15, 3, 3, 0.2, 0.4, kNeutral},
            {"Fill", 15, 10, 4.5, 3, 1, 0.15, kNeutral}};
  return {{"Key", -42, 35, 3.5, 1.5, 1, 1, kWarm},
          {"Fill", 52, 15, 4, 2.4, 1.5, 0.22, kCool},
          {"Rim", 158, 42, 3.5, 1, 0, 0.9, kNeutral}};
}

/// The light as a document has it, at `distance` metres from a target of `radius` metres.
Json light_json(const RigLight& light, double distance, double radius, double level, bool is_lamp) {
  const double illuminance = level * light.level * std::numbers::pi;  // a diffuse surface reflects 1 / pi of it
  Json json{{"color", light.color}};
  const auto number = [](double x) { return short_real(static_cast<float>(x)); };
  if (is_lamp) {
    const double cone = std::min(std::atan(1.4 * radius / distance), 1.5);
    json["type"] = "spot";
    json["intensity"] = number(illuminance * distance * distance);
    json["spot"] = {{"innerConeAngle", number(cone * 0.7)}, {"outerConeAngle", number(cone)}};
    return json;
  }
  const double height = light.height * radius;
  const double area = light.aspect > 0 ? height * height * light.aspect : height * height * std::numbers::pi / 4;
  json["type"] = light.aspect > 0 ? "rect" : "disk";
  json["size"] = number(height);
  if (light.aspect > 0) json["rect"] = {{"aspect", light.aspect}};
  // Of a disk that faces a surface on its axis, and nearly so of a rectangle: pi R^2 / (R^2 + d^2) of its radiance.
  json["intensity"] = number(illuminance * (distance * distance + area / std::numbers::pi) / area);
  return json;
}

/// Operations that put out what shines in a document, but for what emits and `spared` lights.
Json darkening(const Json& lights, const LookDocument& document, const std::string& spared) {
  Json edit = Json::array();
  for (const auto& [name, light] : lights.items())
    if (name != spared && light.at("intensity") != 0)
      edit.push_back(replace_operation("/lights/" + escape_token(name) + "/intensity", 0));
  const Json::json_pointer relook("/scene/extras/relook");
  const Json& scene = document.look.at(relook);
  const Json& environment = scene.at("environment");
  const Json black{0.0, 0.0, 0.0};
  const bool shines = environment.contains("image") || (environment.contains("color") && environment["color"] != black);
  if (shines && environment.at("intensity") != 0)
    edit.push_back(replace_operation("/scene/extras/relook/environment/intensity", 0));
  if (scene.at("ambient") != black) edit.push_back(replace_operation("/scene/extras/relook/ambient", black));
  return edit;
}

WideBox target_bounds(const LookDocument& document, const std::string& target) {
  if (target.empty()) return world_bounds(document);
  require_node(document, target);
  return Placement(document).bounds(target);
}

}  // namespace

JournalDraft draft_rig(const LookDocument& document, const Camera& camera, const RigOptions& options) {
  const WideBox bounds = target_bounds(document, options.target);
  if (bounds.isEmpty())
    throw InputError(document.file, "",
                     options.target.empty() ? "the scene has no objects to light"
                                            : "node \"" + options.target + "\" shows nothing to light");
  const WidePoint center = bounds.center();
  const double radius = std::max(bounds.size().length() / 2, 1e-4);
  Json lights = document.look.at("lights");
  Json edit = options.replaces ? darkening(lights, document, "") : Json::array();
  std::vector<std::pair<std::string, std::string>> added;  // name, what the rig calls it
  UniqueNames names([&](const std::string& name) {
    return document.look["lights"].contains(name) || document.look["nodes"].contains(name);
  });
  for (const RigLight& light : lights_of(options.style)) {
    const double distance = light.distance * radius;
    const WidePoint way = direction_from(camera, center, light.azimuth, light.elevation);
    const std::string name = names.give(std::string(light.name));
    lights[name] = light_json(light, distance, radius, options.level, options.uses_lamps);
    edit.push_back({{"op", "add"}, {"path", "/lights/" + escape_token(name)}, {"value", lights[name]}});
    const char* const extension = options.uses_lamps ? "KHR_lights_punctual" : "EXT_lights_area";
    edit.push_back({{"op", "add"},
                    {"path", "/nodes/" + escape_token(name)},
                    {"value",
                     {{"translation", json_of(center + way * distance)},
                      {"rotation", json_of(looking(-way))},
                      {"extensions", {{extension, {{"light", name}}}}}}}});
    added.emplace_back(name, light.name);
  }
  JournalDraft draft;
  draft.steps.push_back({{"name", "rig"}, {"edit", std::move(edit)}});
  LookDocument dark = document;
  if (options.replaces) {
    for (const auto& item : document.look.at("lights").items()) lights[item.key()]["intensity"] = 0;
    dark.look["scene"]["extras"]["relook"]["environment"]["intensity"] = 0;
    dark.look["scene"]["extras"]["relook"]["ambient"] = {0.0, 0.0, 0.0};
  }
  for (const auto& [name, word] : added)
    draft.steps.push_back({{"name", word + " only"}, {"from", "rig"}, {"edit", darkening(lights, dark, name)}});
  return draft;
}

}  // namespace relook
