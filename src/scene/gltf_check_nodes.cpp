// Nodes, scenes, cameras and lights: a forest without cycles, transforms that are finite and affine.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/gltf_check.h"
#include "scene/gltf_json.h"

namespace relook {
namespace {

template <std::size_t N>
std::array<float, N> numbers(const JsonView& place, float low, float high) {
  std::array<float, N> values;
  place.reals(values, low, high);
  return values;
}

void check_matrix(const JsonView& node, const JsonView& matrix) {
  for (const std::string_view key : {"translation", "rotation", "scale"})
    if (node.has(key)) matrix.fail("a node has either a matrix or \"" + std::string(key) + "\"");
  const auto m = numbers<16>(matrix, -kLargestTransform, kLargestTransform);
  constexpr float kRounding = 1e-5F;
  if (std::abs(m[3]) > kRounding || std::abs(m[7]) > kRounding || std::abs(m[11]) > kRounding ||
      std::abs(m[15] - 1) > kRounding)
    matrix.fail("the matrix is not affine: its fourth row must be 0 0 0 1");
}

void check_transform(const JsonView& node) {
  if (const auto matrix = member(node, "matrix")) check_matrix(node, *matrix);
  for (const std::string_view key : {"translation", "scale"})
    if (const auto place = member(node, key)) (void)numbers<3>(*place, -kLargestTransform, kLargestTransform);
  if (const auto place = member(node, "rotation")) {
    const auto q = numbers<4>(*place, -kLargestTransform, kLargestTransform);
    if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 1e-12F) place->fail("the quaternion is zero");
  }
}

void check_node_extensions(const JsonView& root, const JsonView& node) {
  if (const auto light = extension(node, "KHR_lights_punctual")) {
    const auto lights = extension(root, "KHR_lights_punctual");
    (void)reference(light->at("light"), lights ? array_size(*lights, "lights") : 0, "light");
  }
  if (const auto visibility = extension(node, "KHR_node_visibility"))
    if (const auto visible = member(*visibility, "visible")) (void)visible->boolean();
  if (const auto instancing = extension(node, "EXT_mesh_gpu_instancing")) {
    const JsonView attributes = instancing->at("attributes");
    attributes.require_object();
    for (const auto& [name, value] : attributes.value().items())
      (void)reference(attributes.at(name), array_size(root, "accessors"), "accessor");
  }
}

/// Every node has at most one parent; following the parents from any node ends.
std::vector<std::size_t> check_forest(const JsonView& root, std::size_t node_count) {
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
  return parents;
}

void check_perspective(const JsonView& camera) {
  (void)camera.at("yfov").number(1e-6, 3.141592);
  const float near = camera.at("znear").real(0);
  if (near <= 0) camera.at("znear").fail("must be greater than 0");
  if (const auto ratio = member(camera, "aspectRatio")) (void)ratio->number(1e-6, 1e6);
  if (const auto far = member(camera, "zfar"); far && far->real(0) <= near) far->fail("must be greater than znear");
}

void check_orthographic(const JsonView& camera) {
  for (const std::string_view key : {"xmag", "ymag"})
    if (const JsonView place = camera.at(key); place.real(-kLargestTransform, kLargestTransform) == 0)
      place.fail("must not be 0");
  const float near = camera.at("znear").real(0);
  if (const JsonView far = camera.at("zfar"); far.real(0) <= near) far.fail("must be greater than znear");
}

void check_cameras(const JsonView& root) {
  for_each_object(root, "cameras", [&](const JsonView& camera, std::size_t) {
    static constexpr std::array<std::string_view, 2> kTypes = {"perspective", "orthographic"};
    const std::size_t type = camera.at("type").one_of(kTypes);
    if (camera.has(kTypes[1 - type])) camera.fail("has both \"perspective\" and \"orthographic\"");
    if (type == 0)
      check_perspective(camera.at("perspective"));
    else
      check_orthographic(camera.at("orthographic"));
  });
}

}  // namespace

void check_nodes(const JsonView& root) {
  const std::size_t node_count = array_size(root, "nodes");
  check_cameras(root);
  for_each_object(root, "nodes", [&](const JsonView& node, std::size_t) {
    (void)optional_reference(node, "mesh", array_size(root, "meshes"), "mesh");
    (void)optional_reference(node, "camera", array_size(root, "cameras"), "camera");
    (void)optional_reference(node, "skin", array_size(root, "skins"), "skin");
    check_transform(node);
    check_node_extensions(root, node);
  });
  const auto parents = check_forest(root, node_count);
  for_each_object(root, "scenes", [&](const JsonView& scene, std::size_t) {
    std::vector<std::size_t> listed;
    for_each(scene, "nodes", [&](const JsonView& place, std::size_t) {
      const std::size_t node = reference(place, node_count, "node");
      if (parents[node] != SIZE_MAX) place.fail("node " + std::to_string(node) + " is no root: it is a child");
      listed.push_back(node);
    });
    std::ranges::sort(listed);
    if (std::ranges::adjacent_find(listed) != listed.end()) scene.at("nodes").fail("names a node twice");
  });
  (void)optional_reference(root, "scene", array_size(root, "scenes"), "scene");
}

void check_lights(const JsonView& root) {
  const auto lights = extension(root, "KHR_lights_punctual");
  if (!lights) return;
  for_each_object(*lights, "lights", [&](const JsonView& light, std::size_t) {
    static constexpr std::array<std::string_view, 3> kTypes = {"directional", "point", "spot"};
    const std::size_t type = light.at("type").one_of(kTypes);
    if (const auto color = member(light, "color")) (void)numbers<3>(*color, 0, kLargestFactor);
    if (const auto intensity = member(light, "intensity")) (void)intensity->real(0, 1e12F);
    if (const auto range = member(light, "range"); range && range->real(0) <= 0) range->fail("must be greater than 0");
    if (type != 2) return;
    const JsonView spot = light.at("spot");
    constexpr double kRightAngle = 1.5707964;
    const auto inner = member(spot, "innerConeAngle"), outer = member(spot, "outerConeAngle");
    const double inner_angle = inner ? inner->number(0, kRightAngle) : 0.0;
    const double outer_angle = outer ? outer->number(0, kRightAngle) : 0.7853981633974483;
    if (outer_angle < inner_angle) spot.fail("outerConeAngle must be greater than innerConeAngle");
  });
}

}  // namespace relook
