#include "inspect/inspect_cameras.h"

#include <array>
#include <cstdio>
#include <numbers>
#include <set>

#include "base/error.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "input/open_look.h"

namespace relook {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 160> text{};
  (void)std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// The camera as glTF has it.
const Json& lens_of(const LookDocument& document, const std::string& name) {
  const Json& nodes = document.look.at("nodes");
  const bool is_node = !document.cameras.contains(name) || document.cameras[name].at("node") == "";
  const std::string camera = is_node ? nodes.at(name).at("camera").get<std::string>() : name;
  return document.cameras.at(camera).at("camera");
}

/// Aspect and field of view, or size, that the file gives; without an aspect that of the picture counts.
void describe_lens(const Json& lens, Json& entry, std::string& line) {
  const double degrees = 180 / std::numbers::pi;
  if (lens.value("type", "") == "orthographic") {
    const Json& size = lens.at("orthographic");
    const double width = 2 * std::abs(size.at("xmag").get<double>()),
                 height = 2 * std::abs(size.at("ymag").get<double>());
    entry["orthographic"] = {{"width", width}, {"height", height}};
    entry["aspect"] = width / height;
    line += formatted(", orthographic %g x %g m, aspect %.4g", width, height, width / height);
    return;
  }
  const Json& perspective = lens.at("perspective");
  const double yfov = perspective.at("yfov").get<double>();
  entry["vertical_degrees"] = yfov * degrees;
  line += formatted(", %.4g degrees high", yfov * degrees);
  entry["aspect"] = perspective.contains("aspectRatio") ? perspective["aspectRatio"] : Json();
  if (!perspective.contains("aspectRatio")) {
    line += ", aspect as the picture";
    return;
  }
  const double aspect = perspective["aspectRatio"].get<double>();
  entry["horizontal_degrees"] = 2 * std::atan(std::tan(yfov / 2) * aspect) * degrees;
  line += formatted(" and %.4g wide, aspect %.4g", entry["horizontal_degrees"].get<double>(), aspect);
}

}  // namespace

std::vector<std::string> camera_names(const LookDocument& document) {
  std::vector<std::string> names;
  std::set<std::string> nodes;
  for (const auto& [name, camera] : document.cameras.items())
    if (const std::string node = camera.at("node").get<std::string>(); document.look.at("nodes").contains(node)) {
      names.push_back(name);
      nodes.insert(node);
    }
  for (const auto& [name, node] : document.look.at("nodes").items())
    if (node.contains("camera") && !nodes.contains(name)) names.push_back(name);
  return names;
}

void inspect_cameras(const Arguments& arguments, Console& console) {
  const std::string& input = arguments.inputs[0];
  LookDocument document;
  if (is_cache_folder(input)) {
    document = load_cache(input).document;
  } else {
    LoadedDocument loaded = load_document(input, arguments.view);
    console.warn(loaded.warnings);
    document = std::move(loaded.document);
  }
  Json entries = Json::array();
  for (const std::string& name : camera_names(document)) {
    const Camera camera = choose_camera(document, name, arguments.view.width, arguments.view.height);
    const WidePoint& eye = camera.eye;
    const auto wide = [](float x) { return static_cast<double>(x) + 0.0; };  // 0 is shown for -0
    const Direction& to = camera.forward;
    Json entry{{"name", name},
               {"node", camera.node},
               {"eye", {eye.x, eye.y, eye.z}},
               {"direction", {wide(to.x), wide(to.y), wide(to.z)}}};
    std::string line = "camera " + printable(name) + ": eye " + formatted("%.5g, %.5g, %.5g", eye.x, eye.y, eye.z) +
                       ", looks along " + formatted("%.4g, %.4g, %.4g", wide(to.x), wide(to.y), wide(to.z));
    describe_lens(lens_of(document, name), entry, line);
    console.line(line);
    entries.push_back(std::move(entry));
  }
  if (entries.empty()) console.line(input + ": no camera; --camera auto frames the scene");
  console.json({{"input", input}, {"cameras", std::move(entries)}});
}

}  // namespace relook
