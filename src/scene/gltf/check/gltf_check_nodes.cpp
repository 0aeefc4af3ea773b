// Nodes, scenes, cameras and lights: what they refer to, a forest without cycles.
#include <array>
#include <string_view>
#include <vector>

#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_json.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 2> kLightExtensions{"KHR_lights_punctual", "EXT_lights_area"};

void check_node_extensions(const JsonView& root, const JsonView& node) {
  for (const std::string_view name : kLightExtensions)
    if (const auto light = extension(node, name)) {
      const auto lights = extension(root, name);
      (void)reference(light->at("light"), lights ? array_size(*lights, "lights") : 0, "light");
    }
  if (extension(node, kLightExtensions[0]) && extension(node, kLightExtensions[1]))
    node.at("extensions").at(kLightExtensions[1]).fail("the node has a light of KHR_lights_punctual, too");
  if (const auto instancing = extension(node, "EXT_mesh_gpu_instancing")) {
    const JsonView attributes = instancing->at("attributes");
    attributes.require_object();
    for (const auto& [name, value] : attributes.value().items())
      (void)reference(attributes.at(name), array_size(root, "accessors"), "accessor");
  }
}

/// Every node has at most one parent; following the parents from any node ends.
void check_forest(const JsonView& root, std::size_t node_count) {
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> parents(node_count, kNone);
  for_each(root, "nodes", [&](const JsonView& node, std::size_t parent) {
    for_each(node, "children", [&](const JsonView& place, std::size_t) {
      const std::size_t child = reference(place, node_count, "node");
      if (parents[child] != kNone) place.fail("node " + std::to_string(child) + " has more than one parent");
      parents[child] = parent;
    });
  });
  std::vector<std::size_t> visited_from(node_count, kNone);
  for (std::size_t start = 0; start < node_count; ++start) {
    std::size_t node = start;
    for (; node != kNone && visited_from[node] == kNone; node = parents[node]) visited_from[node] = start;
    if (node != kNone && visited_from[node] == start) root.at("nodes").at(node).fail("is its own ancestor");
  }
}

}  // namespace

void check_nodes(const JsonView& root) {
  const std::size_t node_count = array_size(root, "nodes");
  for_each_object(root, "cameras", [](const JsonView&, std::size_t) {});
  for_each_object(root, "nodes", [&](const JsonView& node, std::size_t) {
    (void)optional_reference(node, "mesh", array_size(root, "meshes"), "mesh");
    (void)optional_reference(node, "camera", array_size(root, "cameras"), "camera");
    (void)optional_reference(node, "skin", array_size(root, "skins"), "skin");
    check_node_extensions(root, node);
  });
  check_forest(root, node_count);
  for_each_object(root, "scenes", [&](const JsonView& scene, std::size_t) {
    for_each(scene, "nodes", [&](const JsonView& place, std::size_t) { (void)reference(place, node_count, "node"); });
  });
  (void)optional_reference(root, "scene", array_size(root, "scenes"), "scene");
}

void check_lights(const JsonView& root) {
  for (const std::string_view name : kLightExtensions)
    if (const auto lights = extension(root, name))
      for_each_object(*lights, "lights", [](const JsonView&, std::size_t) {});
}

}  // namespace relook
