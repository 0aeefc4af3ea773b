// The camera of a cache: glTF's by name, one that frames the scene, or eye, target and angle. libm appears only in
// values that are uniform over the image and rounded to float.
#include "scene/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "scene/look/look_bounds.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

using Wide = WidePoint;

Direction rounded_direction(const Wide& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Sets the axes. `forward` is not zero; `up` may be parallel to it.
void look_along(Camera& camera, Wide forward, Wide up) {
  forward.normalize();
  if (forward.cross(up).length() < 1e-9 * up.length()) up = std::abs(forward.y) < 0.9 ? Wide(0, 1, 0) : Wide(0, 0, -1);
  const Wide right = forward.cross(up).normalized();
  camera.forward = rounded_direction(forward);
  camera.right = rounded_direction(right);
  camera.up = rounded_direction(right.cross(forward));
}

void set_field_of_view(Camera& camera, double vertical_radians) {
  const double half = std::tan(vertical_radians / 2);
  camera.half_height = static_cast<float>(half);
  camera.half_width = static_cast<float>(half * camera.width / camera.height);
}

/// The file's frame stays wholly visible in an image of another shape: the other side becomes wider.
void show_whole(Camera& camera, double half_width, double half_height) {
  const double aspect = static_cast<double>(camera.width) / camera.height;
  camera.half_width = static_cast<float>(std::max(half_width, half_height * aspect));
  camera.half_height = static_cast<float>(std::max(half_height, half_width / aspect));
}

Camera blank_camera(std::string_view name, std::uint32_t width, std::uint32_t height) {
  Camera camera;
  camera.name = name;
  camera.width = width;
  camera.height = height;
  return camera;
}

/// A three-quarter view from the upper right, as near as all corners of the bounds allow.
Camera framing_camera(const LookDocument& document, std::uint32_t width, std::uint32_t height) {
  constexpr double kVerticalDegrees = 35, kMargin = 1.04;
  Camera camera = blank_camera("auto", width, height);
  set_field_of_view(camera, kVerticalDegrees * std::numbers::pi / 180);
  const WideBox bounds = world_bounds(document);
  if (bounds.isEmpty()) throw InputError(document.file, "", "the scene has no objects for --camera auto to frame");
  const Wide forward = Wide(-0.6, -0.42, -0.8).normalized();
  look_along(camera, forward, Wide(0, 1, 0));
  const Wide right(camera.right), up(camera.up), center = bounds.center();
  const auto half_width = static_cast<double>(camera.half_width), half_height = static_cast<double>(camera.half_height);
  double distance = 1e-3;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Wide at =
        Wide((corner & 1U) != 0 ? bounds.max.x : bounds.min.x, (corner & 2U) != 0 ? bounds.max.y : bounds.min.y,
             (corner & 4U) != 0 ? bounds.max.z : bounds.min.z) -
        center;
    const double across = std::max(std::abs(at.dot(right)) / half_width, std::abs(at.dot(up)) / half_height);
    distance = std::max(distance, across * kMargin - at.dot(forward));
  }
  camera.eye = center - forward * distance;
  return camera;
}

/// "x,y,z" or one number, without anything else.
std::vector<double> numbers_of(std::string_view text, std::string_view choice) {
  std::vector<double> numbers;
  while (true) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !(std::abs(number) <= 1e6))
      throw UsageError("--camera " + std::string(choice) + ": expected EYE:TARGET:FOV, such as 0,1,5:0,0,0:40");
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return numbers;
    if (text[0] != ',')
      throw UsageError("--camera " + std::string(choice) + ": unexpected \"" + std::string(text) + "\"");
    text.remove_prefix(1);
  }
}

Camera spelled_camera(std::string_view choice, std::uint32_t width, std::uint32_t height) {
  const std::size_t first = choice.find(':'), second = choice.find(':', first + 1);
  const std::vector<double> eye = numbers_of(choice.substr(0, first), choice);
  const std::vector<double> target = numbers_of(choice.substr(first + 1, second - first - 1), choice);
  const std::vector<double> angle = numbers_of(choice.substr(second + 1), choice);
  const std::string prefix = "--camera " + std::string(choice) + ": ";
  if (eye.size() != 3 || target.size() != 3) throw UsageError(prefix + "EYE and TARGET are three numbers each");
  if (angle.size() != 1 || !(angle[0] >= 0.01 && angle[0] <= 179))
    throw UsageError(prefix + "FOV is one angle from 0.01 to 179 degrees");
  const Wide from(eye[0], eye[1], eye[2]), to(target[0], target[1], target[2]);
  if ((to - from).length() < 1e-9) throw UsageError(prefix + "EYE and TARGET are the same point");
  Camera camera = blank_camera(choice, width, height);
  camera.eye = from;
  set_field_of_view(camera, angle[0] * std::numbers::pi / 180);
  look_along(camera, to - from, Wide(0, 1, 0));
  return camera;
}

/// Of a lens that passed the schema.
double number_at(const Json& lens, const char* key, const LookDocument& document, const std::string& pointer) {
  if (!lens.contains(key)) throw InputError(document.file, pointer, std::string("\"") + key + "\" is missing");
  return lens[key].get<double>();
}

/// A glTF camera (`name` in document.cameras) on a node.
Camera placed_camera(const LookDocument& document, std::string_view shown_name, const std::string& name,
                     const std::string& node, std::uint32_t width, std::uint32_t height) {
  const Json& gltf = document.cameras.at(name).at("camera");
  const std::string pointer = "/cameras/" + escape_token(name);
  Json known = gltf;  // a cache's may be wrong
  drop_unknown(camera_schema(), known);
  check_against_schema(camera_schema(), known, document, document.file, pointer);
  Camera camera = blank_camera(shown_name, width, height);
  camera.node = node;
  const WideTransform world = unscaled_transform(document, node);
  camera.eye = Wide(world[3][0], world[3][1], world[3][2]);
  if (!is_in_range(world) || dimensions_of(rounded(world, camera.eye)) < 3)
    throw InputError(document.file, "/nodes/" + escape_token(node), "the camera's node is scaled to nothing");
  look_along(camera, -Wide(world[2][0], world[2][1], world[2][2]), Wide(world[1][0], world[1][1], world[1][2]));
  camera.orthographic = gltf.value("type", "") == "orthographic";
  const Json& lens = gltf.value(camera.orthographic ? "orthographic" : "perspective", Json::object());
  const auto number = [&](const char* key) { return number_at(lens, key, document, pointer); };
  const double half_height = camera.orthographic ? std::abs(number("ymag")) : std::tan(number("yfov") / 2);
  double half_width = half_height * width / height;
  if (camera.orthographic && lens.contains("xmag")) half_width = std::abs(number("xmag"));
  if (!camera.orthographic && lens.contains("aspectRatio")) half_width = half_height * number("aspectRatio");
  if (!(half_width > 0 && half_height > 0))
    throw InputError(document.file, pointer, "the camera sees nothing: its angle or size is 0");
  show_whole(camera, half_width, half_height);
  if (lens.contains("znear")) camera.near = static_cast<float>(number("znear"));
  if (lens.contains("zfar")) camera.far = static_cast<float>(number("zfar"));
  return camera;
}

/// The name of the camera of the lowest glTF index that a node of the scene holds, or "".
std::string first_camera(const LookDocument& document) {
  std::string best;
  std::size_t best_index = 0;
  for (const auto& item : document.cameras.items()) {
    const auto index = item.value().at("index").get<std::size_t>();
    if (item.value().at("node") == "" || (!best.empty() && index > best_index)) continue;
    best = item.key();
    best_index = index;
  }
  return best;
}

}  // namespace

Camera choose_camera(const LookDocument& document, std::string_view choice, std::uint32_t width, std::uint32_t height) {
  require(width > 0 && height > 0, "a camera has pixels");
  if (choice == "auto") return framing_camera(document, width, height);
  const Json& nodes = document.look.at("nodes");
  const std::string name = choice.empty() ? first_camera(document) : std::string(choice);
  if (document.cameras.contains(name)) {
    const std::string node = document.cameras[name].at("node");
    if (nodes.contains(node)) return placed_camera(document, name, name, node, width, height);
  }
  if (nodes.contains(name) && nodes[name].contains("camera"))
    return placed_camera(document, name, nodes[name]["camera"], name, width, height);
  if (choice.empty())
    for (const auto& item : nodes.items())
      if (item.value().contains("camera"))
        return placed_camera(document, item.key(), item.value()["camera"], item.key(), width, height);
  if (choice.find(':') != std::string_view::npos && choice.find(':') != choice.rfind(':'))
    return spelled_camera(choice, width, height);
  if (choice.empty()) throw InputError(document.file, "", "the scene has no camera; --camera auto frames the scene");
  throw InputError(document.file, "",
                   missing_name(document, Target::cameras, choice) + " (--camera auto frames the scene)");
}

}  // namespace relook
