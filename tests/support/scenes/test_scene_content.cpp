// What the three scenes of the edit matrix contain.
#include "scene_parts.h"
#include "test_scenes.h"

namespace relook {
namespace {

Rgba picture_texel(std::uint32_t x, std::uint32_t y) {
  const float shade = odd_cell(x, y, 2) ? 0.8F : 0.35F;
  return Rgba(shade, 0.1F + 0.05F * static_cast<float>(x % 16), 0.2F + 0.04F * static_cast<float>(y % 16), 1);
}
/// Leaves: round islands of alpha 1 in alpha 0.
Rgba leaf_texel(std::uint32_t x, std::uint32_t y) {
  const float dx = static_cast<float>(x % 8) - 3.5F, dy = static_cast<float>(y % 8) - 3.5F;
  return Rgba(0.2F, 0.6F, 0.15F, dx * dx + dy * dy < 9 ? 1.0F : 0.0F);
}

/// Images and textures that every scene has; the numbers are glTF indices.
struct CommonTextures {
  int picture, marble, bumps, leaves, veil;
};
CommonTextures add_common_textures(SceneBuilder& scene) {
  const int picture = scene.image("PictureImage", single_level_image(16, picture_texel));
  scene.image("SecondImage", single_level_image(16, second_picture_texel));
  const int bumps = scene.image("BumpImage", single_level_image(16, bump_texel));
  scene.image("SecondBumpImage", single_level_image(16, second_bump_texel));
  const int leaves = scene.image("LeafImage", single_level_image(32, leaf_texel));
  const int veil = scene.image("VeilImage", single_level_image(16, veil_texel));
  CommonTextures textures{};
  textures.picture = scene.texture("Picture", picture);
  textures.bumps = scene.texture("Bumps", bumps);
  textures.leaves = scene.texture("Leaves", leaves);
  textures.veil = scene.texture("Veil", veil);
  textures.marble = scene.procedural_texture(
      "Marble", {{"kind", "marble"}, {"scale", 2}, {"color1", {0.8, 0.75, 0.7}}, {"color2", {0.3, 0.15, 0.1}}});
  return textures;
}

Json textured(int texture, float factor = 1, float roughness = 0.8F) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {factor, factor, factor, 1}},
            {"baseColorTexture", {{"index", texture}}},
            {"metallicFactor", 0},
            {"roughnessFactor", roughness}}}};
}

Json phong(float reflection, float refraction, float transparency, float shininess) {
  Json extras;
  extras["relook"] = {{"model", "blinn-phong"},   {"diffuse", {0.7, 0.7, 0.7}},  {"specular", {0.3, 0.3, 0.3}},
                      {"shininess", shininess},   {"ambient", {1, 0.9, 0.8}},    {"reflection", reflection},
                      {"refraction", refraction}, {"transparency", transparency}};
  return extras;
}

void add_study_extras(SceneBuilder& scene, const CommonTextures& textures) {
  Json sheen = plain(0.3F, 0.1F, 0.4F, 0, 0.9F);
  sheen["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.6, 0.5, 0.8}}, {"sheenRoughnessFactor", 0.4}};
  const int sheen_mesh = scene.mesh("Sheen", sphere_mesh(0.35F, 14, 8), scene.material("Sheen", sheen));
  scene.node("Sheen", placed(sheen_mesh, -0.6F, 0.35F, 1.4F));

  Json glowing = plain(0.2F, 0.2F, 0.25F, 0, 0.5F);
  glowing["emissiveFactor"] = {0.9, 0.4, 0.1};
  glowing["emissiveTexture"] = {{"index", textures.picture}};
  glowing["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1.5;
  glowing["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0.6}, {"specularColorFactor", {1, 0.6, 0.4}}};
  const int glowing_mesh = scene.mesh("Glowing", box_mesh(Point(0.3F, 0.3F, 0.3F)), scene.material("Glowing", glowing));
  Json mirrored = placed(glowing_mesh, 0.6F, 0.31F, 1.3F, 30);
  mirrored["scale"] = {-1, 0.8, 1.2};
  scene.node("Glowing", mirrored);

  Mesh patch = card_mesh(0.5F, 0.5F);
  patch.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 0, 1}};
  Json coated = plain(0.9F, 0.9F, 0.9F, 0.3F, 0.6F);
  coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.1}};
  const int patch_mesh = scene.mesh("Patch", patch, scene.material("Coated", coated));
  scene.node("Patch", placed(patch_mesh, 1.9F, 0.6F, -0.6F, -25));

  // The same box twice in the same place, with different materials: only the tie rule tells them apart.
  const int red =
      scene.mesh("Red", box_mesh(Point(0.25F, 0.25F, 0.25F)), scene.material("Red", plain(0.9F, 0, 0, 0, 1)));
  const int blue =
      scene.mesh("Blue", box_mesh(Point(0.25F, 0.25F, 0.25F)), scene.material("Blue", plain(0, 0, 0.9F, 0, 1)));
  scene.node("RedTwin", placed(red, 0.1F, 0.26F, 2.2F, 10));
  scene.node("BlueTwin", placed(blue, 0.1F, 0.26F, 2.2F, 10));
}

}  // namespace

SceneState spheres_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const CommonTextures textures = add_common_textures(scene);
  const int ground = scene.mesh("Ground", plane_mesh(5, 2), scene.material("Ground", textured(textures.picture)));
  const int ball =
      scene.mesh("Ball", sphere_mesh(0.7F, 16, 10), scene.material("Matte", plain(0.7F, 0.2F, 0.15F, 0, 0.6F)));
  const int mirror =
      scene.mesh("MirrorBall", sphere_mesh(0.75F, 20, 12), scene.material("Mirror", plain(0.9F, 0.85F, 0.8F, 1, 0.1F)));
  Json glass_material = plain(0.95F, 0.97F, 0.96F, 0, 0.1F);
  glass_material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  glass_material["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 1}, {"attenuationDistance", 0.8}, {"attenuationColor", {0.5, 0.8, 0.6}}};
  glass_material["extensions"]["KHR_materials_ior"]["ior"] = 1.5;
  const int glass = scene.mesh("GlassBall", sphere_mesh(0.65F, 20, 12), scene.material("Glass", glass_material));
  scene.node("Ground", {{"mesh", ground}});
  scene.node("Ball", placed(ball, 0, 0.7F, -0.7F));
  scene.node("MirrorBall", placed(mirror, -1.5F, 0.75F, 0));
  scene.node("GlassBall", placed(glass, 1.3F, 0.66F, 0.5F));
  scene.light("Lamp", {{"type", "point"}, {"intensity", 60}, {"color", {1, 0.95, 0.9}}}, {{"translation", {2, 4, 3}}});
  scene.ambient(Color(0.06F, 0.06F, 0.08F));
  scene.environment({{"color", {0.2, 0.3, 0.5}}});
  scene.look_at(Point(0.2F, 1.7F, 5), Point(0, 0.6F, 0), 42, width, height);
  return scene.state();
}

SceneState cards_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const CommonTextures textures = add_common_textures(scene);
  const int ground = scene.mesh("Ground", plane_mesh(5, 2), scene.material("Ground", textured(textures.picture, 0.9F)));
  const int ball = scene.mesh("Ball", box_mesh(Point(0.5F, 0.6F, 0.5F)),
                              scene.material("Matte", plain(0.3F, 0.4F, 0.7F, 0.2F, 0.5F)));
  Json veil = textured(textures.veil, 1, 0.12F);
  veil["alphaMode"] = "BLEND";
  veil["doubleSided"] = true;
  const int mirror = scene.mesh("MirrorBall", card_mesh(0.7F, 0.8F), scene.material("Mirror", veil));
  Json glass_material = textured(textures.picture, 1, 0.12F);
  glass_material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.8},
                                                                {"transmissionTexture", {{"index", textures.veil}}}};
  const int glass = scene.mesh("GlassBall", card_mesh(0.6F, 0.7F), scene.material("Glass", glass_material));
  Json leaves = textured(textures.leaves);
  leaves["alphaMode"] = "MASK";
  leaves["doubleSided"] = true;
  const int foliage = scene.mesh("Foliage", card_mesh(0.8F, 0.8F), scene.material("Leaves", leaves));
  scene.node("Ground", {{"mesh", ground}});
  const int tree = scene.node("Tree", {{"translation", {-0.2, 0.8, -1.3}}});
  scene.adopt(tree, scene.node("Ball", placed(ball, 0.3F, -0.2F, 0.2F, 20)));
  scene.adopt(tree, scene.node("Foliage", placed(foliage, 0.4F, 0.5F, 0.9F, 15)));
  scene.node("MirrorBall", placed(mirror, -1, 0.81F, 0.3F, 20));
  scene.node("GlassBall", placed(glass, 0.9F, 0.71F, 0.7F, -15));
  scene.node("SecondVeil", placed(mirror, -0.6F, 0.85F, 1.1F, 10));
  // Straight down and tilted: the rotation about x by -60 degrees turns the light's -z towards the ground.
  scene.light("Lamp",
              {{"type", "spot"}, {"intensity", 90}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.6}}}},
              {{"translation", {0.5, 4, 2.5}}, {"rotation", {-0.5, 0, 0, 0.8660254}}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 1.2}, {"color", {1, 0.9, 0.7}}},
              {{"rotation", {-0.35, 0.2, 0.1, 0.9096}}});
  scene.ambient(Color(0.1F, 0.1F, 0.1F));
  scene.environment({{"color", {0.4, 0.5, 0.6}}, {"intensity", 0.5}});
  scene.look_at(Point(0.3F, 1.5F, 4.5F), Point(0, 0.7F, 0), 42, width, height);
  return scene.state();
}

SceneState study_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const CommonTextures textures = add_common_textures(scene);
  const int ground = scene.mesh("Ground", plane_mesh(5, 4), scene.material("Ground", textured(textures.marble)));
  Json matte = textured(textures.marble, 1, 0.5F);
  matte["normalTexture"] = {{"index", textures.bumps}, {"scale", 0.8}};
  matte["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.7}, {"clearcoatRoughnessFactor", 0.15}};
  const int ball = scene.mesh("Ball", sphere_mesh(0.6F, 16, 10), scene.material("Matte", matte));
  Json mirror_material = plain(0.4F, 0.5F, 0.4F, 0, 1);
  mirror_material["normalTexture"] = {{"index", textures.bumps}, {"scale", 0.3}};
  mirror_material["extras"] = phong(0.5F, 0, 0, 30);
  const int mirror = scene.mesh("MirrorBall", sphere_mesh(0.6F, 20, 12), scene.material("Mirror", mirror_material));
  Json glass_material = plain(0.8F, 0.9F, 0.9F, 0, 1);
  glass_material["extras"] = phong(0.1F, 0.6F, 0.15F, 50);
  glass_material["extensions"]["KHR_materials_ior"]["ior"] = 1.3;
  const int glass = scene.mesh("GlassBall", sphere_mesh(0.5F, 20, 12), scene.material("Glass", glass_material));
  Json bumpy = {{"mesh", ground}};
  bumpy["extras"]["relook"]["displacement"] = {
      {"texture", textures.picture}, {"scale", 0.15}, {"midlevel", 0.5}, {"subdivide", 1}};
  scene.node("Ground", bumpy);
  scene.node("Ball", placed(ball, 0, 0.75F, -0.4F));
  scene.node("MirrorBall", placed(mirror, -1.4F, 0.75F, 0));
  scene.node("GlassBall", placed(glass, 1.2F, 0.6F, 0.6F));
  add_study_extras(scene, textures);
  scene.light("Lamp", {{"type", "point"}, {"intensity", 50}, {"range", 12}}, {{"translation", {2, 4, 3}}});
  scene.light("Fill", {{"type", "point"}, {"intensity", 15}, {"color", {0.6, 0.7, 1}}}, {{"translation", {-3, 3, 2}}});
  scene.ambient(Color(0.05F, 0.06F, 0.07F));
  scene.environment({{"color", {0.3, 0.3, 0.35}}});
  scene.look_at(Point(0.2F, 1.8F, 5), Point(0, 0.5F, 0.3F), 42, width, height);
  return scene.state();
}

}  // namespace relook
