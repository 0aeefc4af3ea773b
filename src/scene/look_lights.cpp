// --lights auto: a key, a fill and a rim light, as directional lights placed relative to the camera, so that they do
// not depend on the size of the scene. A white diffuse surface that faces the key alone is about 0.8.
#include <cmath>
#include <numbers>

#include "scene/look.h"
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

}  // namespace

void add_auto_lights(LookDocument& document, const Camera& camera) {
  const AutoLight lights[] = {{"key", -0.6, 0.8, 0.7, 0.8, {1.0, 0.97, 0.92}},
                              {"fill", 0.9, 0.3, 0.6, 0.22, {0.92, 0.96, 1.0}},
                              {"rim", 0.3, 0.7, -0.9, 0.4, {1.0, 1.0, 1.0}}};
  for (const AutoLight& light : lights) {
    const Imath::V3d from = Imath::V3d(camera.right) * light.right + Imath::V3d(camera.up) * light.up -
                            Imath::V3d(camera.forward) * light.back;
    const std::string name = unique_name(light.name, [&](const std::string& candidate) {
      return document.look["lights"].contains(candidate) || document.look["nodes"].contains(candidate);
    });
    // A diffuse surface reflects 1 / pi of the illuminance.
    Json value{{"type", "directional"}, {"color", light.color}, {"intensity", light.white_diffuse * std::numbers::pi}};
    fill_defaults(Section::lights, value);
    document.look["lights"][name] = std::move(value);
    Json node{{"rotation", rotation_to(-from.normalized())},
              {"extensions", {{"KHR_lights_punctual", {{"light", name}}}}}};
    fill_defaults(Section::nodes, node);
    document.look["nodes"][name] = std::move(node);
  }
}

}  // namespace relook
