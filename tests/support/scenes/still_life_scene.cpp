// The scene that errors of sampling are measured on: Floor is a dull dielectric, MetalBall rough gold, PlasticBall a
// glossy red dielectric.
#include "scene_parts.h"
#include "test_scenes.h"

namespace relook {

SceneState still_life_scene(std::shared_ptr<const TexturePyramid> sky, float base, std::uint32_t width,
                            std::uint32_t height) {
  SceneBuilder scene;
  const Json floor = plain(0.6F * base, 0.55F * base, 0.5F * base, 0, 0.5F);
  const Json plastic = plain(0.7F * base, 0.1F * base, 0.08F * base, 0, 0.2F);
  const Json gold = plain(1, 0.77F, 0.34F, 1, 0.3F);
  scene.node("Floor", placed(scene.mesh("Floor", plane_mesh(6, 1), scene.material("Floor", floor)), 0, 0, 0));
  scene.node("MetalBall",
             placed(scene.mesh("MetalBall", sphere_mesh(0.9F, 24, 12), scene.material("Gold", gold)), -1, 0.9F, 0));
  const int ball = scene.mesh("PlasticBall", sphere_mesh(0.8F, 24, 12), scene.material("Plastic", plastic));
  scene.node("PlasticBall", placed(ball, 0.9F, 0.8F, 0.5F));
  if (sky) {
    scene.image("Sky", std::move(sky));
    scene.environment({{"image", "Sky"}, {"color", {1, 1, 1}}});
  } else {
    scene.area_light("Window", {{"type", "rect"}, {"size", 1.6}, {"rect", {{"aspect", 1.5}}}, {"intensity", 12}},
                     {{"translation", {0.8, 3.2, 2.2}}, {"rotation", {-0.4067366, 0, 0, 0.9135455}}});
  }
  scene.look_at(Point(0, 3, 4.6F), Point(0, 0.55F, 0.2F), 38, width, height);
  return with_integrator(scene.state(), Integrator::path);
}

}  // namespace relook
