// --lights auto: a key, a fill and a rim light, as directional lights placed relative to the camera, so that they do
// not depend on the size of the scene. A white diffuse surface that faces the key alone has a value of 0.8. Where none
// of them reaches the camera, in a closed room, a lamp at the camera gives as much to what it looks at. Under
// Integrator::path they are discs in the sky, so that polished surfaces show them and shadows are soft, and a grey
// environment joins them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "scene/compile/compile_material.h"
#include "scene/look/light_shares.h"
#include "scene/look/look.h"
#include "scene/look/look_bounds.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

struct AutoLight {
  const char* name;
  double right, up, back;  // where the light comes from, in the camera's frame
  double white_diffuse;    // value of a white diffuse surface that faces it
  double angle;            // radians across under Integrator::path, which leaves white_diffuse as it is
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

/// What a primitive's material says of light that comes to it: does it let none through, and does it have back faces?
struct Wall {
  bool is_opaque = true, is_double_sided = false;
};
Wall wall_of(const LookDocument& document, const std::string& node, const Mesh& mesh) {
  const Json& name = document.look.at("nodes").at(node).at("mesh");
  const Json* primitives = member_at(document.look, {"meshes", name.get_ref<const std::string&>(), "primitives"});
  if (primitives == nullptr || mesh.primitive >= primitives->size()) return {};
  const Json* of_primitive = member_at((*primitives)[mesh.primitive], {"material"});
  if (of_primitive == nullptr) return {};
  const Json& material = document.look.at("materials").at(of_primitive->get_ref<const std::string&>());
  const auto is_zero = [&](std::initializer_list<std::string_view> keys) {
    const Json* value = member_at(material, keys);
    return value == nullptr || *value == 0;
  };
  const bool is_opaque = material.at("alphaMode") == "OPAQUE" &&
                         is_zero({"extensions", "KHR_materials_transmission", "transmissionFactor"}) &&
                         is_zero({"extras", "relook", "transparency"}) && is_zero({"extras", "relook", "refraction"});
  return {is_opaque, material.at("doubleSided").get<bool>()};
}

/// A direction from the eye, in which a ray of the camera goes, or from which light comes: a single-sided surface stops
/// either one where its front faces where it came from.
struct Way {
  Imath::V3d along;
  bool is_of_light;
};

std::vector<Obstacle> obstacles(const LookDocument& document, const WidePoint& eye, const std::vector<Way>& ways) {
  std::vector<Obstacle> nearest(ways.size());
  for_each_placed_mesh(document, [&](const std::string& node, const Mesh& mesh, const WideTransform& world) {
    const Wall wall = wall_of(document, node, mesh);
    if (!wall.is_opaque) return;
    const bool is_mirrored = world.determinant() < 0;
    for (const auto& triangle : mesh.triangles) {
      std::array<Imath::V3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = Imath::V3d(mesh.positions[triangle[i]]) * world - eye;
      const Imath::V3d front = (corners[1] - corners[0]).cross(corners[2] - corners[0]) * (is_mirrored ? -1.0 : 1.0);
      for (std::size_t i = 0; i < ways.size(); ++i) {
        if (!wall.is_double_sided && (front.dot(ways[i].along) > 0) != ways[i].is_of_light) continue;
        if (const double distance = distance_to(corners, ways[i].along); distance < nearest[i].distance)
          nearest[i] = {distance, node};
      }
    }
  });
  return nearest;
}

/// Adds a light and its node to the look document, both called `wanted` or, if that is taken, `wanted_2` and so on.
/// `node`: its transform. Returns the name.
std::string add_light(LookDocument& document, const char* wanted, Json light, Json node) {
  const std::string name = unique_name(wanted, [&](const std::string& candidate) {
    return document.look["lights"].contains(candidate) || document.look["nodes"].contains(candidate);
  });
  fill_defaults(Section::lights, light);
  document.look["lights"][name] = std::move(light);
  node["extensions"]["KHR_lights_punctual"]["light"] = name;
  fill_defaults(Section::nodes, node);
  document.look["nodes"][name] = std::move(node);
  return name;
}

constexpr double kKeyDiffuse = 0.8;

/// Gives a scene whose environment is black a soft grey one: enough for metals to have something to reflect, little
/// enough that white in the key light stays near 1.
void add_environment(LookDocument& document) {
  constexpr double kGrey = 0.35;
  Json& environment = document.look.at("scene")["extras"]["relook"]["environment"];
  const auto color = environment.find("color");
  const bool is_black = color == environment.end() ? !environment.contains("image") : *color == Json({0.0, 0.0, 0.0});
  if (!is_black && environment.at("intensity") != 0) return;
  environment.erase("image");
  environment["color"] = {kGrey, kGrey, kGrey};
  environment["intensity"] = 1.0;
}

}  // namespace

std::string add_auto_lights(LookDocument& document, const Camera& camera, Integrator integrator) {
  if (integrator == Integrator::path) add_environment(document);
  const AutoLight lights[] = {{"key", -0.6, 0.8, 0.7, kKeyDiffuse, 0.25, {1.0, 0.97, 0.92}},
                              {"fill", 0.9, 0.3, 0.6, 0.22, 0.6, {0.92, 0.96, 1.0}},
                              {"rim", 0.3, 0.7, -0.9, 0.4, 0.3, {1.0, 1.0, 1.0}}};
  std::vector<Way> ways;
  for (const AutoLight& light : lights)
    ways.push_back({(Imath::V3d(camera.right) * light.right + Imath::V3d(camera.up) * light.up -
                     Imath::V3d(camera.forward) * light.back)
                        .normalized(),
                    true});
  ways.push_back({Imath::V3d(camera.forward), false});
  const WideBox bounds = world_bounds(document);
  const bool is_inside = bounds.intersects(camera.eye);
  const std::vector<Obstacle> met = is_inside ? obstacles(document, camera.eye, ways) : std::vector<Obstacle>();
  std::vector<std::string> added;
  for (std::size_t i = 0; i < std::size(lights); ++i) {
    Json light{{"type", "directional"},
               {"color", lights[i].color},  // a diffuse surface reflects 1 / pi of the illuminance
               {"intensity", lights[i].white_diffuse * std::numbers::pi}};
    if (integrator == Integrator::path) light["extras"]["relook"]["angle"] = lights[i].angle;
    added.push_back(
        add_light(document, lights[i].name, std::move(light), {{"rotation", rotation_to(-ways[i].along)}}));
  }
  const bool is_closed = is_inside && std::ranges::all_of(std::span(met).first(std::size(lights)),
                                                          [](const Obstacle& o) { return std::isfinite(o.distance); });
  if (is_closed) {
    const double extent = bounds.size().length() / 2;
    const double distance = std::clamp(std::min(met.back().distance, extent), 1e-4, 1e4);
    added.push_back(add_light(
        document, "lamp", {{"type", "point"}, {"intensity", kKeyDiffuse * std::numbers::pi * distance * distance}},
        {{"translation", {camera.eye.x, camera.eye.y, camera.eye.z}}}));
  }
  write_light_shares(document, added);
  if (!is_closed) return "";
  return "the camera stands in a room closed by node \"" + met.front().node +
         "\", which no light of --lights auto reaches: a lamp at the camera lights it";
}

}  // namespace relook
