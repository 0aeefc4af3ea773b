// The renderer against the reference tracer: the same picture to float accuracy.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "edit/apply.h"
#include "reference_tracer.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// Relative where a pixel is bright, absolute near black.
double error_of(const Rgba& ours, const Rgba& reference) {
  double error = 0;
  for (int channel = 0; channel < 4; ++channel) {
    const double difference = std::fabs(double{ours[channel]} - double{reference[channel]});
    error = std::max(error, difference / std::max(std::fabs(double{reference[channel]}), 0.05));
  }
  return error;
}

struct Agreement {
  std::size_t pixels = 0, beyond = 0;  // beyond 1e-3
  std::string worst;
};

Agreement compare_with_reference(const SceneState& state, std::uint32_t max_depth) {
  const Frame ours = rendered(state.scene(), {1, max_depth});
  const Frame reference = ReferenceTracer(state.scene(), max_depth).frame();
  Agreement agreement;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    ++agreement.pixels;
    if (error_of(ours.pixels[i], reference.pixels[i]) <= 1e-3) continue;
    ++agreement.beyond;
    if (agreement.beyond > 12) continue;
    const Rgba &a = ours.pixels[i], &b = reference.pixels[i];
    std::ostringstream line;
    line << "\n(" << i % reference.width << "," << i / reference.width << ") ours " << a.r << " " << a.g << " " << a.b
         << " " << a.a << " reference " << b.r << " " << b.g << " " << b.b << " " << b.a;
    agreement.worst += line.str();
  }
  return agreement;
}

/// Where single and double precision may part: a ray that passes an edge of a silhouette, a shadow or a facet within
/// the rounding error of its path takes the other side, and every refraction or reflection at a curved surface
/// multiplies that error. Such pixels are single ones; a wrong formula shows on every pixel of a surface.
void expect_agreement(const SceneState& state, std::uint32_t max_depth) {
  constexpr double kToleratedShare = 0.002;  // at most one of the 3072 pixels was seen to differ
  const Agreement agreement = compare_with_reference(state, max_depth);
  EXPECT_LE(static_cast<double>(agreement.beyond), kToleratedShare * static_cast<double>(agreement.pixels))
      << agreement.beyond << " of " << agreement.pixels << agreement.worst;
}

/// A pyramid of many levels: 64 x 64 checks of 8-bit colours.
std::shared_ptr<const TexturePyramid> checks(TexelFormat format) {
  std::vector<std::uint8_t> texels;
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      for (const std::uint32_t value : {(x / 4 + y / 4) % 2 * 150 + 60, x * 4, y * 3 + 30, 255U})
        texels.push_back(static_cast<std::uint8_t>(value));
  return std::make_shared<const TexturePyramid>(build_pyramid(format, 64, 64, std::move(texels)));
}

/// Every texture slot in use, most of them with a transform, on surfaces with and without mirror rays.
SceneState textured_scene() {
  SceneBuilder scene;
  const int colors = scene.texture("Colors", scene.image("ColorChecks", checks(TexelFormat::srgb8)));
  const int values = scene.texture("Values", scene.image("ValueChecks", checks(TexelFormat::linear8)));
  const auto slot = [](int texture, double turn) {
    Json info = {{"index", texture}};
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.13, turn}}, {"rotation", turn}, {"scale", {1.5, 0.75}}};
    return info;
  };
  Json ground;
  ground["pbrMetallicRoughness"] = {{"baseColorTexture", slot(colors, 0.3)},
                                    {"metallicRoughnessTexture", slot(values, -0.4)}};
  ground["occlusionTexture"] = slot(values, 0.2);
  ground["occlusionTexture"]["strength"] = 0.7;
  ground["emissiveTexture"] = slot(colors, 1.1);
  ground["emissiveFactor"] = {0.1, 0.2, 0.1};
  ground["extensions"]["KHR_materials_specular"] = {{"specularTexture", {{"index", colors}}},
                                                    {"specularColorTexture", slot(colors, 0.6)}};
  Json card = ground;
  card["pbrMetallicRoughness"]["roughnessFactor"] = 0.4;
  card["normalTexture"] = slot(values, 0.1);
  card["normalTexture"]["scale"] = 0.3;
  card["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.9},
                                                   {"clearcoatTexture", slot(values, 0.5)},
                                                   {"clearcoatRoughnessFactor", 0.4},
                                                   {"clearcoatRoughnessTexture", slot(values, 0.9)},
                                                   {"clearcoatNormalTexture", {{"index", values}, {"scale", 0.2}}}};
  Json cloth = ground;
  cloth["extensions"]["KHR_materials_sheen"] = {
      {"sheenColorFactor", {0.8, 0.7, 0.9}}, {"sheenColorTexture", slot(colors, 0.7)}, {"sheenRoughnessFactor", 0.6}};
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(5, 1), scene.material("Ground", ground))}});
  scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(0.9F, 0.7F), scene.material("Card", card))},
                      {"translation", {-0.9, 0.9, 0.4}},
                      {"rotation", {0, 0.17, 0, 0.985}}});
  scene.node("Cloth", {{"mesh", scene.mesh("Cloth", sphere_mesh(0.7F, 24, 14), scene.material("Cloth", cloth))},
                       {"translation", {0.9, 0.8, 0.3}}});
  scene.light("Lamp", {{"type", "point"}, {"intensity", 40}, {"range", 9}}, {{"translation", {1, 4, 3}}});
  scene.light("Spot",
              {{"type", "spot"}, {"intensity", 60}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
              {{"translation", {-1, 4, 2}}, {"rotation", {-0.57, 0, 0, 0.82}}});
  scene.ambient(Color(0.2F, 0.2F, 0.25F));
  scene.image("Sky", single_level_image(8, [](std::uint32_t x, std::uint32_t y) {
                return Rgba(0.1F * static_cast<float>(x), 0.3F, 0.1F * static_cast<float>(y), 1);
              }));
  scene.environment({{"color", {1, 0.9, 0.8}}, {"image", "Sky"}, {"rotation", 0.8}});
  scene.look_at(Point(0.2F, 1.6F, 5), Point(0, 0.6F, 0), 44, 64, 48);
  return scene.state();
}

/// Brushed surfaces and thin films, smooth and rough, metallic and not, with all their textures and without.
SceneState brushed_scene() {
  SceneBuilder scene;
  const int colors = scene.texture("Colors", scene.image("ColorChecks", checks(TexelFormat::srgb8)));
  const int values = scene.texture("Values", scene.image("ValueChecks", checks(TexelFormat::linear8)));
  const auto surface = [&](float metallic, float roughness) {
    return Json{
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", colors}}}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}}}};
  };
  const auto turned = [](int texture) {
    Json info = {{"index", texture}};
    info["extensions"]["KHR_texture_transform"] = {{"rotation", 0.7}, {"scale", {1.5, -0.75}}};
    return info;
  };
  const auto put = [&](const char* name, const Mesh& mesh, const Json& material, const Json& place) {
    Json node = place;
    node["mesh"] = scene.mesh(name, mesh, scene.material(name, material));
    scene.node(name, node);
  };
  Json ground = surface(0, 0.4F);
  ground["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.8}, {"anisotropyRotation", 0.6}};
  ground["extensions"]["KHR_materials_iridescence"] = {{"iridescenceFactor", 1}, {"iridescenceThicknessMaximum", 520}};
  Json brushed = surface(1, 0.3F);
  brushed["extensions"]["KHR_materials_anisotropy"] = {
      {"anisotropyStrength", 0.9}, {"anisotropyRotation", -2}, {"anisotropyTexture", turned(values)}};
  brushed["normalTexture"] = {{"index", values}, {"scale", 0.2}};
  Json mirror = surface(0.5F, 0.1F);
  mirror["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.15}};
  mirror["extensions"]["KHR_materials_iridescence"] = {
      {"iridescenceFactor", 0.9},           {"iridescenceTexture", {{"index", values}}},
      {"iridescenceIor", 1.9},              {"iridescenceThicknessMinimum", 700},
      {"iridescenceThicknessMaximum", 200}, {"iridescenceThicknessTexture", turned(values)}};
  Json bubble = surface(0, 0.05F);
  bubble["doubleSided"] = true;
  bubble["extensions"]["KHR_materials_ior"]["ior"] = 1;
  bubble["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  bubble["extensions"]["KHR_materials_iridescence"] = {{"iridescenceFactor", 1}, {"iridescenceIor", 1.33}};
  Json glass = bubble;
  glass["extensions"]["KHR_materials_ior"]["ior"] = 1.5;
  glass["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  put("Ground", plane_mesh(5, 2), ground, Json::object());
  put("Brushed", sphere_mesh(0.6F, 24, 14), brushed, {{"translation", {-1.2, 0.7, 0}}});
  put("Mirror", box_mesh(Point(0.4F, 0.5F, 0.4F)), mirror,
      {{"translation", {0, 0.6, -0.5}}, {"rotation", {0, 0.3, 0, 0.954}}, {"scale", {-1, 1, 1.2}}});
  put("Bubble", sphere_mesh(0.4F, 24, 14), bubble, {{"translation", {0.3, 0.6, 1.2}}});
  put("Glass", box_mesh(Point(0.4F, 0.4F, 0.4F)), glass,
      {{"translation", {1.3, 0.6, 0.2}}, {"rotation", {0, 0.2, 0, 0.98}}});
  scene.light("Lamp", {{"type", "point"}, {"intensity", 40}}, {{"translation", {1, 4, 3}}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 1}}, {{"rotation", {-0.45, -0.25, 0.1, 0.85}}});
  scene.ambient(Color(0.2F, 0.2F, 0.25F));
  scene.environment({{"color", {0.5, 0.6, 0.8}}});
  scene.look_at(Point(0.2F, 1.6F, 5), Point(0, 0.6F, 0), 44, 64, 48);
  return scene.state();
}

/// Light and rays through everything that lets them pass: tinted glass around an opaque ball, veils before and behind,
/// phong surfaces with all three proportions, thin panes with a metallic share, vertex alpha.
SceneState transport_scene() {
  SceneBuilder scene;
  const int colors = scene.texture(
      "Colors", scene.image("Colors", single_level_image(8, [](std::uint32_t x, std::uint32_t y) {
                              return Rgba(0.3F + 0.08F * static_cast<float>(x), 0.9F,
                                          0.4F + 0.07F * static_cast<float>(y), 0.2F + 0.1F * static_cast<float>(x));
                            })));
  const Json textured = {{"baseColorTexture", {{"index", colors}}}, {"metallicFactor", 0}, {"roughnessFactor", 0.15}};
  Json glass = {{"pbrMetallicRoughness", textured}};
  glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.9;
  glass["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 1}, {"attenuationDistance", 1.5}, {"attenuationColor", {0.4, 0.8, 0.9}}};
  glass["extensions"]["KHR_materials_ior"]["ior"] = 1.33;
  Json pane = {{"pbrMetallicRoughness", textured}, {"doubleSided", true}};
  pane["pbrMetallicRoughness"]["metallicFactor"] = 0.3;
  pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.7;
  Json veil = {{"pbrMetallicRoughness", textured}, {"alphaMode", "BLEND"}};
  Json phong = {{"pbrMetallicRoughness", textured}, {"alphaMode", "BLEND"}};
  phong["extras"]["relook"] = {
      {"model", "blinn-phong"}, {"reflection", 0.2}, {"refraction", 0.3}, {"transparency", 0.3}, {"shininess", 20}};
  phong["extensions"]["KHR_materials_ior"]["ior"] = 1.2;
  Json dull = {{"pbrMetallicRoughness",
                {{"baseColorFactor", {0.6, 0.6, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}}}};
  Mesh faded = card_mesh(0.6F, 0.6F);
  faded.colors = {{1, 1, 1, 0.9F}, {1, 0.8F, 0.8F, 0.3F}, {0.8F, 1, 1, 0.6F}, {1, 1, 0.7F, 0.1F}};
  const int dull_material = scene.material("Dull", dull);
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(6, 1), dull_material)}});
  scene.node("Glass", {{"mesh", scene.mesh("Glass", box_mesh(Point(0.6F, 0.6F, 0.6F)), scene.material("Glass", glass))},
                       {"translation", {-0.9, 0.7, 0.2}},
                       {"rotation", {0, 0.25, 0, 0.968}}});
  scene.node("Inner", {{"mesh", scene.mesh("Inner", box_mesh(Point(0.2F, 0.25F, 0.2F)), dull_material)},
                       {"translation", {-0.9, 0.7, 0.2}}});
  scene.node("Pane", {{"mesh", scene.mesh("Pane", card_mesh(0.5F, 0.6F), scene.material("Pane", pane))},
                      {"translation", {0.2, 0.7, 1.1}},
                      {"rotation", {0, -0.2, 0, 0.98}}});
  scene.node("Veil",
             {{"mesh", scene.mesh("Veil", faded, scene.material("Veil", veil))}, {"translation", {0.5, 0.8, -0.5}}});
  scene.node("Phong", {{"mesh", scene.mesh("Phong", box_mesh(Point(0.4F, 0.5F, 0.4F)), scene.material("Phong", phong))},
                       {"translation", {1.3, 0.6, 0.3}},
                       {"rotation", {0, 0.3, 0, 0.954}}});
  scene.light("Lamp", {{"type", "point"}, {"intensity", 50}}, {{"translation", {1.5, 4, 2.5}}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 1}}, {{"rotation", {-0.45, -0.25, 0.1, 0.85}}});
  scene.ambient(Color(0.1F, 0.1F, 0.1F));
  scene.environment({{"color", {0.5, 0.6, 0.8}}});
  scene.look_at(Point(0.2F, 1.5F, 4.6F), Point(0, 0.6F, 0), 42, 64, 48);
  return scene.state();
}

TEST(Reference, SpheresPrimaryRaysOnly) { expect_agreement(spheres_scene(64, 48), 1); }
TEST(Reference, CardsPrimaryRaysOnly) { expect_agreement(cards_scene(64, 48), 1); }
TEST(Reference, StudyPrimaryRaysOnly) { expect_agreement(study_scene(64, 48), 1); }
TEST(Reference, Spheres) { expect_agreement(spheres_scene(64, 48), 6); }
TEST(Reference, Cards) { expect_agreement(cards_scene(64, 48), 6); }
TEST(Reference, Study) { expect_agreement(study_scene(64, 48), 6); }
TEST(Reference, TexturesPrimaryRaysOnly) { expect_agreement(textured_scene(), 1); }
TEST(Reference, Textures) { expect_agreement(textured_scene(), 6); }
TEST(Reference, Dispersion) {
  SceneState state = spheres_scene(64, 48);
  (void)apply_edit(state, replace_edit("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 8), "", ".");
  expect_agreement(state, 6);
}
TEST(Reference, TransportPrimaryRaysOnly) { expect_agreement(transport_scene(), 1); }
TEST(Reference, Transport) { expect_agreement(transport_scene(), 6); }
TEST(Reference, BrushedPrimaryRaysOnly) { expect_agreement(brushed_scene(), 1); }
TEST(Reference, Brushed) { expect_agreement(brushed_scene(), 5); }
TEST(Reference, OrthographicCamera) {
  SceneBuilder camera;
  camera.look_orthographic(Point(0.3F, 2, 4.5F), Point(0, 0.6F, 0), 1.5F, 64, 48);
  expect_agreement(with_camera(textured_scene(), camera.camera()), 2);
}

}  // namespace
}  // namespace relook
