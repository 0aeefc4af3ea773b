// The scene of the integrator `path`: lights Lamp (a point), Spot (soft, excludes Cloth), Sun (soft), Window (a
// rectangle), Dish (a disk that the camera sees), the emission of Glow with an image, and an environment whose image
// has a sun; Ground and Ball are dull, MirrorBall is rough metal, GlassBall a volume, Pane thin glass, Veil blended,
// Coated bumpy under its coat, Cloth has sheen, Phong and Sign have the other models.
#include "scene_parts.h"
#include "test_scenes.h"

namespace relook {
namespace {

Rgba checked_texel(std::uint32_t x, std::uint32_t y) {
  return Rgba(odd_cell(x, y, 2) ? 0.8F : 0.35F, 0.2F + 0.03F * static_cast<float>(x), 0.25F, 1);
}
Rgba checked_leaf_texel(std::uint32_t x, std::uint32_t y) {
  return Rgba(0.2F, 0.6F, 0.15F, odd_cell(x, y, 4) ? 1.0F : 0.0F);
}
/// Roughness in [0.1, 0.9], across several buckets; metallic 0 or 1.
Rgba rough_texel(std::uint32_t x, std::uint32_t y) {
  return Rgba(0, 0.1F + 0.8F * static_cast<float>(x) / 15, odd_cell(x, y, 8) ? 1.0F : 0.0F, 1);
}
/// A gradient with a sun that is a few hundred times as bright.
Rgba sky_texel(std::uint32_t x, std::uint32_t y) {
  if (x == 5 && y == 4) return Rgba(90, 80, 60, 1);
  const float down = static_cast<float>(y) / 15;
  return Rgba(0.15F + 0.1F * down, 0.22F, 0.4F - 0.3F * down, 1);
}
/// Two suns elsewhere, under a warm sky.
Rgba second_sky_texel(std::uint32_t x, std::uint32_t y) {
  if (y == 3 && (x == 2 || x == 12)) return Rgba(40, 45, 60, 1);
  return Rgba(0.4F, 0.25F + 0.005F * static_cast<float>(x), 0.15F, 1);
}
/// No texel that counts as a sun.
Rgba even_sky_texel(std::uint32_t, std::uint32_t y) {
  return Rgba(0.3F, 0.3F, 0.2F + 0.01F * static_cast<float>(y), 1);
}

struct Textures {
  int picture, veil, bumps, rough;
};
Textures add_textures(SceneBuilder& scene) {
  Textures textures{};
  scene.image("SkyImage", single_level_image(16, sky_texel));
  scene.image("SecondSkyImage", single_level_image(16, second_sky_texel));
  scene.image("EvenSkyImage", single_level_image(16, even_sky_texel));
  textures.picture = scene.texture("Picture", scene.image("PictureImage", single_level_image(16, checked_texel)));
  scene.texture("Second", scene.image("SecondImage", single_level_image(16, second_picture_texel)));
  textures.veil = scene.texture("Veil", scene.image("VeilImage", single_level_image(16, veil_texel)));
  scene.texture("Leaves", scene.image("LeafImage", single_level_image(16, checked_leaf_texel)));
  textures.bumps = scene.texture("Bumps", scene.image("BumpImage", single_level_image(16, bump_texel)));
  scene.image("SecondBumpImage", single_level_image(16, second_bump_texel));
  textures.rough = scene.texture("Rough", scene.image("RoughImage", single_level_image(16, rough_texel)));
  scene.procedural_texture(
      "Marble", {{"kind", "marble"}, {"scale", 2}, {"color1", {0.8, 0.75, 0.7}}, {"color2", {0.3, 0.15, 0.1}}});
  return textures;
}

Json pictured(int texture, float roughness) {
  Json material = plain(1, 1, 1, 0, roughness);
  material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture;
  return material;
}
Json other_model(Json material, const char* model) {
  material["extras"]["relook"] = {{"model", model}};
  return material;
}

void add_roles(SceneBuilder& scene, const Textures& textures) {
  const int ground = scene.mesh("Ground", plane_mesh(5, 2), scene.material("Ground", pictured(textures.picture, 0.8F)));
  const int ball =
      scene.mesh("Ball", sphere_mesh(0.55F, 14, 9), scene.material("Matte", plain(0.7F, 0.2F, 0.15F, 0, 0.5F)));
  const int mirror =
      scene.mesh("MirrorBall", sphere_mesh(0.6F, 16, 10), scene.material("Mirror", plain(0.9F, 0.85F, 0.8F, 1, 0.35F)));
  Json glass_material = plain(0.95F, 0.97F, 0.96F, 0, 0.05F);
  glass_material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  glass_material["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 1}, {"attenuationDistance", 0.8}, {"attenuationColor", {0.5, 0.8, 0.6}}};
  glass_material["extensions"]["KHR_materials_ior"]["ior"] = 1.5;
  const int glass = scene.mesh("GlassBall", sphere_mesh(0.5F, 16, 10), scene.material("Glass", glass_material));
  scene.node("Ground", {{"mesh", ground}});
  scene.node("Ball", placed(ball, 0.1F, 0.56F, -0.7F));
  scene.node("MirrorBall", placed(mirror, -1.3F, 0.61F, 0));
  scene.node("GlassBall", placed(glass, 1.1F, 0.51F, 0.5F));
}

void add_surfaces(SceneBuilder& scene, const Textures& textures) {
  Json pane = plain(0.8F, 0.9F, 0.85F, 0, 0.1F);
  pane["doubleSided"] = true;
  pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.8;
  scene.node("Pane", placed(scene.mesh("Pane", card_mesh(0.4F, 0.5F), scene.material("Pane", pane)), -0.5F, 0.51F, 1,
                            -20));
  Json veil = pictured(textures.veil, 0.6F);
  veil["alphaMode"] = "BLEND";
  veil["doubleSided"] = true;
  scene.node("Veil", placed(scene.mesh("Veil", card_mesh(0.4F, 0.4F), scene.material("Veil", veil)), -1.5F, 0.45F, 1.3F,
                            15));
  Json coated = plain(0.3F, 0.4F, 0.8F, 0.3F, 1);
  coated["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = textures.rough;
  coated["normalTexture"] = {{"index", textures.bumps}, {"scale", 0.7}};
  coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.15}};
  const int coated_mesh = scene.mesh("Coated", box_mesh(Point(0.3F, 0.3F, 0.3F)), scene.material("Coated", coated));
  scene.node("Coated", placed(coated_mesh, 0.4F, 0.31F, 1.2F, 30));
  Json cloth = plain(0.3F, 0.1F, 0.4F, 0, 0.9F);
  cloth["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.6, 0.5, 0.8}}, {"sheenRoughnessFactor", 0.4}};
  const int cloth_mesh = scene.mesh("Cloth", sphere_mesh(0.3F, 12, 8), scene.material("Cloth", cloth));
  scene.node("Cloth", placed(cloth_mesh, -0.6F, 0.3F, 1.8F));
  Json phong = other_model(plain(0.4F, 0.5F, 0.4F, 0, 1), "blinn-phong");
  phong["extras"]["relook"].update(
      {{"diffuse", {0.5, 0.6, 0.4}}, {"specular", {0.3, 0.3, 0.3}}, {"shininess", 20}, {"reflection", 0.3}});
  const int phong_mesh = scene.mesh("Phong", box_mesh(Point(0.25F, 0.4F, 0.25F)), scene.material("Phong", phong));
  scene.node("Phong", placed(phong_mesh, 1.9F, 0.41F, -0.6F, 20));
  const Json sign = other_model(pictured(textures.picture, 1), "unlit");
  scene.node("Sign",
             placed(scene.mesh("Sign", card_mesh(0.3F, 0.3F), scene.material("Sign", sign)), -2.1F, 1, -0.8F, 20));
  Json glow = plain(0.2F, 0.2F, 0.2F, 0, 0.6F);
  glow["emissiveFactor"] = {0.9, 0.5, 0.2};
  glow["emissiveTexture"]["index"] = textures.picture;
  glow["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
  const int glow_mesh = scene.mesh("Glow", box_mesh(Point(0.2F, 0.2F, 0.2F)), scene.material("Glow", glow));
  scene.node("Glow", placed(glow_mesh, 1.2F, 0.21F, 1.6F, 10));
}

Json of_relook(const char* key, Json value) { return {{"relook", {{key, std::move(value)}}}}; }

void add_lights(SceneBuilder& scene) {
  const Json downwards = {-0.5, 0, 0, 0.8660254};  // -z, 60 degrees below the horizon
  scene.light("Lamp", {{"type", "point"}, {"intensity", 25}, {"color", {1, 0.95, 0.9}}}, {{"translation", {2, 4, 3}}});
  scene.light("Spot",
              {{"type", "spot"},
               {"intensity", 70},
               {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.6}}},
               {"extras", of_relook("radius", 0.2)}},
              {{"translation", {-0.6, 4, 2.4}},
               {"rotation", downwards},
               {"extras", of_relook("excludes", Json::array({"Cloth"}))}});
  scene.light("Sun",
              {{"type", "directional"},
               {"intensity", 0.9},
               {"color", {1, 0.9, 0.7}},
               {"extras", of_relook("angle", 0.05)}},
              {{"rotation", {-0.35, 0.2, 0.1, 0.9096}}});
  scene.area_light("Window",
                   {{"type", "rect"},
                    {"size", 1.2},
                    {"rect", {{"aspect", 1.5}}},
                    {"intensity", 9},
                    {"color", {0.6, 0.8, 1}}},
                   {{"translation", {1.6, 2.4, 2.2}}, {"rotation", downwards}});
  scene.area_light("Dish", {{"type", "disk"}, {"size", 0.7}, {"intensity", 14}},
                   {{"translation", {-1, 2, -1.6}},
                    {"rotation", {-0.6532815, 0.2705981, 0.2705981, 0.6532815}},
                    {"extras", of_relook("visible", true)}});
  scene.ambient(Color(0.03F, 0.03F, 0.04F));
}

}  // namespace

SceneState lights_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const Textures textures = add_textures(scene);
  add_roles(scene, textures);
  add_surfaces(scene, textures);
  add_lights(scene);
  scene.environment({{"image", "SkyImage"},
                     {"color", {1, 1, 1}},
                     {"intensity", 0.8},
                     {"rotation", 0.4},
                     {"background", {{"color", {0.1, 0.12, 0.15}}}}});
  scene.look_at(Point(0.2F, 1.8F, 5.2F), Point(0, 0.6F, 0.2F), 44, width, height);
  return with_integrator(scene.state(), Integrator::path);
}

}  // namespace relook
