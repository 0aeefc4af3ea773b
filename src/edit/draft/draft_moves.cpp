#include "edit/draft/draft_moves.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/error.h"
#include "edit/draft/placement.h"
#include "scene/compile/compile_material.h"
#include "scene/light.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

std::string short_text(double x) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%g", x);
  return text.data();
}

/// The node's light by either extension; null: none.
const Json* light_of(const Json& node) {
  for (const char* extension : {"KHR_lights_punctual", "EXT_lights_area"})
    if (const Json* light = member_at(node, {"extensions", extension, "light"})) return light;
  return nullptr;
}

/// The topmost nodes that can turn with all below them and show something.
class Turning {
 public:
  Turning(const LookDocument& document, const Placement& placement) : document_(document), placement_(placement) {
    for (const Json& skin : document.look.at("skins"))
      for (const Json& joint : skin.value("joints", Json::array())) joints_.insert(joint.get<std::string>());
  }

  void add(const std::string& name) {
    bool shows = false, has_camera = false, has_light = false;
    for (const std::string& below : placement_.subtree(name)) {
      const Json& node = document_.look.at("nodes").at(below);
      shows = shows || node.contains("mesh") || joints_.contains(below);
      has_camera = has_camera || node.contains("camera");
      has_light = has_light || light_of(node) != nullptr;
    }
    if (!shows) return;
    const Json& node = document_.look.at("nodes").at(name);
    const bool is_whole = !has_camera && (!has_light || node.contains("mesh"));
    if (is_whole) return nodes.push_back(name);
    if (node.contains("mesh"))
      warnings.push_back("node \"" + name + "\" holds a camera, so its own mesh does not turn with what is below it");
    for (const Json& child : node.at("children")) add(child.get<std::string>());
  }

  std::vector<std::string> nodes, warnings;

 private:
  const LookDocument& document_;
  const Placement& placement_;
  std::set<std::string> joints_;
};

WidePoint axis_of(const std::string& axis) {
  return {axis == "x" ? 1.0 : 0.0, axis == "y" ? 1.0 : 0.0, axis == "z" ? 1.0 : 0.0};
}

/// Operations that put a node back where it is.
void append_as_it_is(const LookDocument& document, const std::string& node, Json& edit) {
  const Json& entity = document.look.at("nodes").at(node);
  for (const char* key : {"matrix", "rotation", "translation"})
    if (entity.contains(key))
      edit.push_back(replace_operation("/nodes/" + escape_token(node) + "/" + key, entity[key]));
}

Json turning_step(const LookDocument& document, const Placement& placement, const std::vector<std::string>& nodes,
                  const std::string& what, const TurntableOptions& options) {
  WideBox bounds;
  for (const std::string& node : nodes) bounds.extendBy(placement.bounds(node));
  const WidePoint center = options.about == "origin" ? WidePoint(0, 0, 0)
                           : bounds.isEmpty()        ? placement.place(nodes.front())
                                                     : bounds.center();
  const bool comes_round = std::fmod(options.degrees, 360.0) == 0;
  Json select = Json::array(), drag = Json::array();
  for (const std::string& node : nodes) select.push_back("/nodes/" + escape_token(node));
  for (std::uint32_t i = 1; i <= options.frames; ++i) {
    const Quaternion rotation = turn(axis_of(options.axis), options.degrees * i / options.frames);
    Json edit = Json::array();
    for (const std::string& node : nodes) {
      if (comes_round && i == options.frames) {
        append_as_it_is(document, node, edit);
        continue;
      }
      for (Json& operation : placement.turned_edit(node, rotation, center)) edit.push_back(std::move(operation));
    }
    drag.push_back(std::move(edit));
  }
  return {{"name", what + " turned about " + options.axis + ", " + short_text(options.degrees / options.frames) +
                       " degrees a frame"},
          {"select", std::move(select)},
          {"drag", std::move(drag)}};
}

Json environment_step(const LookDocument& document, const TurntableOptions& options) {
  const Json::json_pointer place("/scene/extras/relook/environment/rotation");
  const double from = document.look.at(place).get<double>(), step = options.degrees * kRadians / options.frames;
  const double to = from + options.degrees * kRadians;
  Json wedge{{"path", place.to_string()}};
  if (options.frames == 1)
    wedge["values"] = Json::array({to});
  else
    wedge["range"] = {{"from", from + step}, {"to", to}, {"count", options.frames}};
  return {{"name", "surroundings turned, " + short_text(options.degrees / options.frames) + " degrees a frame"},
          {"wedge", std::move(wedge)}};
}

/// "1,-2,3"; none if it has another form.
std::optional<WidePoint> point_in(std::string_view text) {
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    if (error != std::errc() || !(std::abs(numbers[i]) <= 1e6)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (i == 2) return text.empty() ? std::optional(WidePoint(numbers[0], numbers[1], numbers[2])) : std::nullopt;
    if (!text.starts_with(',')) return std::nullopt;
    text.remove_prefix(1);
  }
  return std::nullopt;
}

WidePoint target_point(const LookDocument& document, const Placement& placement, std::string target) {
  target.erase(0, target.find_first_not_of(' '));
  if (const std::optional<WidePoint> point = point_in(target)) return *point;
  require_node(document, target);
  const WideBox bounds = placement.bounds(target);
  return bounds.isEmpty() ? placement.place(target) : bounds.center();
}

/// The node that a word means: its own name, or that of a light that one node places.
std::string subject_node(const LookDocument& document, const std::string& subject) {
  const Json& nodes = document.look.at("nodes");
  if (nodes.contains(subject)) return subject;
  std::vector<std::string> placing;
  for (const auto& [name, node] : nodes.items())
    if (const Json* light = light_of(node); light != nullptr && *light == subject) placing.push_back(name);
  if (placing.size() == 1) return placing.front();
  if (!document.look.at("lights").contains(subject)) require_node(document, subject);
  if (placing.empty()) throw InputError(document.file, "", "no node has light \"" + subject + "\"");
  std::string list;
  for (const std::string& name : placing) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  throw InputError(document.file, "", "several nodes have light \"" + subject + "\": name one of " + list);
}

}  // namespace

WidePoint direction_from(const Camera& camera, const WidePoint& target, double azimuth, double elevation) {
  const auto level = [](WidePoint way) { return WidePoint(way.x, 0, way.z); };
  WidePoint front = level(camera.orthographic ? -WidePoint(camera.forward) : camera.eye - target);
  if (front.length() < 1e-6) front = level(-WidePoint(camera.up));  // seen from above
  if (front.length() < 1e-6) front = WidePoint(0, 0, 1);
  front.normalize();
  const WidePoint right = WidePoint(0, 1, 0).cross(front);
  const double a = azimuth * kRadians, e = elevation * kRadians;
  return (front * std::cos(a) + right * std::sin(a)) * std::cos(e) + WidePoint(0, 1, 0) * std::sin(e);
}

JournalDraft draft_turntable(const LookDocument& document, const std::string& node, const TurntableOptions& options) {
  const Placement placement(document);
  JournalDraft draft;
  if (node == "all" && !document.look.at("nodes").contains("all")) {
    Turning turning(document, placement);
    for (const std::string& root : placement.roots()) turning.add(root);
    if (turning.nodes.empty()) throw InputError(document.file, "", "the scene has no objects to turn");
    draft.warnings = std::move(turning.warnings);
    draft.steps.push_back(turning_step(document, placement, turning.nodes, "all", options));
  } else if (!node.empty()) {
    require_node(document, node);
    draft.steps.push_back(turning_step(document, placement, {node}, node, options));
  }
  if (options.environment) draft.steps.push_back(environment_step(document, options));
  return draft;
}

JournalDraft draft_aim(const LookDocument& document, const Camera& camera, const std::string& subject,
                       const std::string& target, const AimOptions& options) {
  const Placement placement(document);
  const std::string node = subject_node(document, subject);
  const WidePoint center = target_point(document, placement, target);
  const Json* light = light_of(document.look.at("nodes").at(node));
  const std::string kind =
      light == nullptr ? "" : document.look.at("lights").at(light->get<std::string>()).value("type", "");
  const bool is_placed = options.azimuth || options.elevation || options.distance || options.orbit > 0;
  if (kind == traits_of(LightKind::point).word && !is_placed)
    throw InputError(document.file, "",
                     "light \"" + light->get<std::string>() +
                         "\" shines everywhere alike; --azimuth, --elevation and --distance place it");
  const WidePoint now = placement.place(node) - center;
  const double distance = options.distance.value_or(now.length());
  if (!(distance > 1e-9))
    throw InputError(document.file, "", "node \"" + node + "\" stands at the target; give --distance");
  // Where it stands now, in the angles of direction_from().
  const WidePoint front = direction_from(camera, center, 0, 0), right = direction_from(camera, center, 90, 0);
  const double azimuth = options.azimuth.value_or(std::atan2(now.dot(right), now.dot(front)) / kRadians);
  const double height = now.length() > 1e-9 ? std::clamp(now.y / now.length(), -1.0, 1.0) : 0.0;
  const double elevation = options.elevation.value_or(std::asin(height) / kRadians);
  const auto edit_at = [&](double degrees) {
    const WidePoint way = is_placed ? direction_from(camera, center, degrees, elevation) : now.normalized();
    const WidePoint place = is_placed ? center + way * distance : placement.place(node);
    return placement.placed_edit(node, looking(light != nullptr ? -way : way), place);
  };
  JournalDraft draft;
  Json step{{"name", node + " at " + target.substr(std::min(target.find_first_not_of(' '), target.size()))}};
  if (options.orbit == 0) {
    step["edit"] = edit_at(azimuth);
  } else {
    step["name"] = node + " round " + target.substr(std::min(target.find_first_not_of(' '), target.size()));
    step["select"] = Json::array({"/nodes/" + escape_token(node)});
    step["drag"] = Json::array();
    for (std::uint32_t i = 1; i <= options.orbit; ++i)
      step["drag"].push_back(edit_at(azimuth + 360.0 * i / options.orbit));
  }
  draft.steps.push_back(std::move(step));
  return draft;
}

}  // namespace relook
