// --lights auto: a key, a fill and a rim light, as directional lights placed relative to the camera, so that they do
// not depend on the size of the scene. A white diffuse surface that faces the key alone is about 0.8. Where none of them
// reaches the camera, in a closed room, a lamp at the camera gives as much to what it looks at.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/look.h"
#include "scene/look_bounds.h"
#include "scene/look_names.h"

namespace relook {
namespace {

struct AutoLight {
  const char* name;
  double right, up, back;  // where the light comes from, in the camera's frame
  double white_diffuse;    // value of a white diffuse surface that faces it
  Json color;
};

/// The shortest rotation that turns -z into `travel` (a light shines along its node's -z).
Json rotation_to(const Imath::V3d& travel) {
  const Imath::V3d axis = Imath::V3d(0, 0, -1).cross(travel);
  const double w = 1 - travel.z;
  const double length = std::sqrt(axis.dot(axis) + w * w);
  if (length < 1e-6) return {0.0, 1.0, 0.0, 0.0};
  return {axis.x / length, axis.y / length, axis.z / length, w / length};
}

/// What a ray from the camera's eye meets first, whichever side it shows.
struct Obstacle {
  double distance = std::numeric_limits<double>::infinity();
  std::string node;
};

/// Distance along a ray from the origin to a triangle; infinity for a miss. By Moeller and Trumbore, 1997.
double distance_to(const std::array<Imath::V3d, 3>& corners, const Imath::V3d& along) {
  const Imath::V3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], p = along.cross(e2);
  const double determinant = e1.dot(p);
  const double none = std::numeric_limits<double>::infinity();
  if (determinant == 0) return none;
  const Imath::V3d q = (-corners[0]).cross(e1);
  const double u = -corners[0].dot(p) / determinant, v = along.dot(q) / determinant;
  const double t = e2.dot(q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : none;
}

std::vector<Obstacle> obstacles(const LookDocument& document, const WidePoint& eye,
                                const std::vector<Imath::V3d>& directions) {
  std::vector<Obstacle> nearest(directions.size());
  for_each_placed_mesh(document, [&](const std::string& node, const Mesh& mesh, const WideTransform& world) {
    for (const auto& triangle : mesh.triangles) {
      std::array<Imath::V3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = Imath::V3d(mesh.positions[triangle[i]]) * world - eye;
      for (std::size_t i = 0; i < directions.size(); ++i)
        if (const double distance = distance_to(corners, directions[i]); distance < nearest[i].distance)
          nearest[i] = {distance, node};
    }
  });
  return nearest;
}

/// A light of the look document and its node, both called `wanted` or nearly so. `node`: its transform.
void add_light(LookDocument& document, const char* wanted, Json light, Json node) {
  const std::string name = unique_name(wanted, [&](const std::string& candidate) {
    return document.look["lights"].contains(candidate) || document.look["nodes"].contains(candidate);
  });
  fill_defaults(Section::lights, light);
  document.look["lights"][name] = std::move(light);
  node["extensions"]["KHR_lights_punctual"]["light"] = name;
  fill_defaults(Section::nodes, node);
  document.look["nodes"][name] = std::move(node);
}

constexpr double kKeyDiffuse = 0.8;

}  // namespace

std::string add_auto_lights(LookDocument& document, const Camera& camera) {
  const AutoLight lights[] = {{"key", -0.6, 0.8, 0.7, kKeyDiffuse, {1.0, 0.97, 0.92}},
                              {"fill", 0.9, 0.3, 0.6, 0.22, {0.92, 0.96, 1.0}},
                              {"rim", 0.3, 0.7, -0.9, 0.4, {1.0, 1.0, 1.0}}};
  std::vector<Imath::V3d> directions;
  for (const AutoLight& light : lights)
    directions.push_back((Imath::V3d(camera.right) * light.right + Imath::V3d(camera.up) * light.up -
                          Imath::V3d(camera.forward) * light.back)
                             .normalized());
  directions.emplace_back(camera.forward);
  const bool is_inside = world_bounds(document).intersects(camera.eye);
  const std::vector<Obstacle> met = is_inside ? obstacles(document, camera.eye, directions) : std::vector<Obstacle>();
  for (std::size_t i = 0; i < std::size(lights); ++i)  // a diffuse surface reflects 1 / pi of the illuminance
    add_light(document, lights[i].name,
              {{"type", "directional"},
               {"color", lights[i].color},
               {"intensity", lights[i].white_diffuse * std::numbers::pi}},
              {{"rotation", rotation_to(-directions[i])}});
  const bool is_closed =
      is_inside && std::ranges::all_of(met, [](const Obstacle& obstacle) { return std::isfinite(obstacle.distance); });
  if (!is_closed) return "";
  const double distance = std::clamp(met.back().distance, 1e-4, 1e4);
  add_light(document, "lamp", {{"type", "point"}, {"intensity", kKeyDiffuse * std::numbers::pi * distance * distance}},
            {{"translation", {camera.eye.x, camera.eye.y, camera.eye.z}}});
  return "the camera stands in a room closed by node \"" + met.front().node +
         "\", which no light of --lights auto reaches: a lamp at the camera lights it";
}

}  // namespace relook
