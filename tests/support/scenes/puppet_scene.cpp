// A scene whose meshes are morphed and skinned.
#include <cmath>

#include "scene_parts.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// A target that squeezes a ball along y and one that makes waves, the first with its normals.
Mesh with_targets(Mesh mesh) {
  MorphTarget squeezed, waved;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Point& p = mesh.positions[i];
    squeezed.positions.emplace_back(0.3F * p.x, -0.6F * p.y, 0.3F * p.z);
    waved.positions.emplace_back(0.25F * std::sin(7 * p.y), 0.0F, 0.2F * std::cos(5 * p.x));
    if (mesh.normals.empty()) continue;
    const Normal& n = mesh.normals[i];
    squeezed.normals.emplace_back(-0.2F * n.x, 0.7F * n.y, -0.2F * n.z);
  }
  mesh.targets = {std::move(squeezed), std::move(waved)};
  return mesh;
}

/// Two influences of four: Hip below, Chest above.
Mesh with_joints(Mesh mesh, float height) {
  for (const Point& p : mesh.positions) {
    const float upper = std::min(std::max(p.y / height + 0.5F, 0.0F), 1.0F);
    mesh.joints.insert(mesh.joints.end(), {0, std::uint16_t(upper > 0 ? 1 : 0), 0, 0});
    mesh.joint_weights.insert(mesh.joint_weights.end(), {1 - upper, upper, 0, 0});
  }
  return mesh;
}

Transform moved_by(float x, float y, float z) {
  Transform matrix;
  matrix.setTranslation(Point(x, y, z));
  return matrix;
}

}  // namespace

SceneState puppet_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const int marble = scene.procedural_texture(
      "Marble", {{"kind", "marble"}, {"scale", 2}, {"color1", {0.8, 0.75, 0.7}}, {"color2", {0.3, 0.15, 0.1}}});
  const int ground = scene.mesh("Ground", plane_mesh(5, 2), scene.material("Ground", plain(0.6F, 0.6F, 0.5F, 0, 0.8F)));
  const int ball = scene.mesh("Ball", with_joints(with_targets(sphere_mesh(0.6F, 14, 10)), 1.2F),
                              scene.material("Matte", plain(0.7F, 0.2F, 0.15F, 0, 0.6F)));
  const int mirror = scene.mesh("MirrorBall", with_targets(sphere_mesh(0.6F, 16, 10)),
                                scene.material("Mirror", plain(0.9F, 0.85F, 0.8F, 1, 0.1F)));
  Json glass_material = plain(0.95F, 0.97F, 0.96F, 0, 0.1F);
  glass_material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  glass_material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  const int glass =
      scene.mesh("GlassBall", with_targets(sphere_mesh(0.5F, 16, 10)), scene.material("Glass", glass_material));
  const int post = scene.mesh("Post", with_targets(box_mesh(Point(0.2F, 0.5F, 0.2F))),
                              scene.material("Wood", plain(0.5F, 0.4F, 0.2F, 0, 0.7F)));
  scene.node("Ground", {{"mesh", ground}});
  const int rig = scene.node("Rig", {{"translation", {0, 0.7, -0.5}}});
  const int hip = scene.node("Hip", {{"translation", {0, -0.3, 0}}});
  const int chest = scene.node("Chest", {{"translation", {0, 0.6, 0}}});
  scene.adopt(rig, hip);
  scene.adopt(hip, chest);
  const int skin = scene.skin("Puppet", {hip, chest}, {moved_by(0, 0.3F, 0), moved_by(0, -0.3F, 0)});
  scene.node("Ball", {{"mesh", ball}, {"skin", skin}, {"weights", {0.2, 0}}, {"translation", {7, 7, 7}}});
  scene.node("MirrorBall", {{"mesh", mirror}, {"translation", {-1.4, 0.75, 0}}, {"weights", {0, 0.5}}});
  scene.node("GlassBall", {{"mesh", glass}, {"translation", {1.2, 0.66, 0.5}}});
  Json displaced = {{"mesh", post}, {"translation", {0.4, 0.5, 1.2}}};
  displaced["extras"]["relook"]["displacement"] = {{"texture", marble}, {"scale", 0.1}, {"subdivide", 1}};
  scene.node("Post", displaced);
  scene.light("Lamp", {{"type", "point"}, {"intensity", 60}}, {{"translation", {2, 4, 3}}});
  scene.ambient(Color(0.06F, 0.06F, 0.08F));
  scene.environment({{"color", {0.2, 0.3, 0.5}}});
  scene.look_at(Point(0.2F, 1.7F, 5), Point(0, 0.6F, 0), 42, width, height);
  return scene.state();
}

}  // namespace relook
