// Every row of the paper's Table 1 (and the look-dev edits beside it) on three scenes: the replayed frame has the bits
// of a full render of the edited scene, and the ray trees kept for the next step are those that a fresh preprocess
// finds. Under `path` as well, there also with the sums of light, and on a fourth scene.
#include <gtest/gtest.h>

#include <optional>

#include "matrix_rows.h"
#include "path_checks.h"

namespace relook {
namespace {

std::vector<MatrixRow> color_rows() {
  return {
      row("surface color", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.2, 0.7, 0.3, 1})),
      row("one component of a color", set("/materials/Ground/pbrMetallicRoughness/baseColorFactor/0", 0.25)),
      row("color of a mirror", set("/materials/Mirror/pbrMetallicRoughness/baseColorFactor", {0.5, 0.8, 0.9, 1})),
      row("color of glass", set("/materials/Glass/pbrMetallicRoughness/baseColorFactor", {0.9, 0.5, 0.4, 1})),
      row("surface roughness", set("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.4)),
      row("roughness of a mirror", set("/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.05)),
      row("plastic to metallic", set("/materials/Matte/pbrMetallicRoughness/metallicFactor", 0.7)),
      row("specular", set("/materials/Matte/extensions/KHR_materials_specular/specularFactor", 0.5)),
      row("specular color",
          set("/materials/Ground/extensions/KHR_materials_specular/specularColorFactor", {1, 0.5, 0.2})),
      row("emission", set("/materials/Matte/emissiveFactor", {0.1, 0.05, 0.2})),
      row("emissive strength", set("/materials/Matte/extensions/KHR_materials_emissive_strength/emissiveStrength", 2)),
      row("sheen", set("/materials/Matte/extensions/KHR_materials_sheen/sheenColorFactor", {0.4, 0.3, 0.2}),
          set("/materials/Matte/extensions/KHR_materials_sheen/sheenRoughnessFactor", 0.5)),
      row("anisotropy", set("/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.7)),
      row("its direction", set("/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyRotation", 1.1)),
      row("anisotropy of a mirror",
          set("/materials/Mirror/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.4)),
      row("anisotropy texture", add("/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyTexture",
                                    {{"index", "Bumps"}})),
      row("anisotropy texture turned",
          set("/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyTexture/extensions/"
              "KHR_texture_transform/rotation",
              0.7)),
      row("strength under the texture",
          set("/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.9)),
      row("no anisotropy of a mirror",
          set("/materials/Mirror/extensions/KHR_materials_anisotropy/anisotropyStrength", 0)),
      row("iridescence", set("/materials/Matte/extensions/KHR_materials_iridescence/iridescenceFactor", 0.8)),
      row("iridescence of a mirror",
          set("/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceFactor", 1)),
      row("index of the film", set("/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceIor", 1.8)),
      row("thickness of the film",
          set("/materials/Matte/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 560)),
      row("thickness texture",
          add("/materials/Matte/extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
              {{"index", "Picture"}})),
      row("least thickness of the film",
          set("/materials/Matte/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 250)),
      row("iridescence texture", add("/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceTexture",
                                     {{"index", "Marble"}})),
      row("no iridescence of a mirror",
          set("/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceFactor", 0)),
      row("proportion of reflection", set("/materials/Mirror/extras/relook/reflection", 0.3)),
      row("proportion of refraction", set("/materials/Glass/extras/relook/refraction", 0.4)),
      row("proportion of transparency", set("/materials/Glass/extras/relook/transparency", 0.3)),
      row("proportion of transmission",
          set("/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", 0.6)),
      row("attenuation", set("/materials/Glass/extensions/KHR_materials_volume/attenuationColor", {0.9, 0.4, 0.4}),
          add("/materials/Glass/extensions/KHR_materials_volume/attenuationDistance", 0.3)),
      row("light color", set("/lights/Lamp/color", {0.6, 1, 0.7})),
      row("light intensity", set("/lights/Lamp/intensity", 33)),
      row("light range", add("/lights/Lamp/range", 9)),
      row("the light by its glTF name", set("/extensions/KHR_lights_punctual/lights/Lamp/intensity", 40)),
      row("ambient light", set("/scene/extras/relook/ambient", {0.2, 0.1, 0.1})),
      row("environment color", set("/scene/extras/relook/environment/color", {0.6, 0.2, 0.1})),
      row("environment intensity", set("/scene/extras/relook/environment/intensity", 0.7)),
      row("environment image", add("/scene/extras/relook/environment/image", "PictureImage")),
      row("environment rotation", set("/scene/extras/relook/environment/rotation", 1.2)),
      row("texture parameter", set("/textures/Marble/extras/relook/procedural/scale", 3.5)),
      row("texture colors", set("/textures/Marble/extras/relook/procedural/color2", {0.1, 0.4, 0.2})),
      row("texture kind", set("/textures/Marble/extras/relook/procedural/kind", "wood")),
      row("texture image", set("/textures/Picture/source", "SecondImage")),
      row("a texture put on", add("/materials/Matte/pbrMetallicRoughness/baseColorTexture", {{"index", "Picture"}})),
      row("texture transform",
          set("/materials/Matte/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform",
              {{"offset", {0.1, 0.2}}, {"scale", {2, 3}}, {"rotation", 0.4}})),
      row("surface parametrization", add("/materials/Matte/pbrMetallicRoughness/baseColorTexture/extras",
                                         {{"relook", {{"mapping", {{"kind", "spherical"}, {"axis", "y"}}}}}})),
      row("planar parametrization", set("/materials/Matte/pbrMetallicRoughness/baseColorTexture/extras/relook/mapping",
                                        {{"kind", "planar"}, {"axis", "z"}})),
      row("cylindrical parametrization",
          set("/materials/Matte/pbrMetallicRoughness/baseColorTexture/extras/relook/mapping/kind", "cylindrical")),
      row("bump map of a dull surface", add("/materials/Ground/normalTexture", {{"index", "Bumps"}})),
      row("strength of a bump map", set("/materials/Ground/normalTexture/scale", 1.7)),
      row("bump map taken off", removed("/materials/Ground/normalTexture")),
      row("illumination model", set("/materials/Matte/extras/relook/model", "blinn-phong")),
      row("ambient coefficient", set("/materials/Matte/extras/relook/ambient", {0.3, 0.6, 0.9})),
      row("diffuse coefficient", set("/materials/Matte/extras/relook/diffuse", {0.9, 0.8, 0.5})),
      row("specular coefficient", set("/materials/Matte/extras/relook/specular", {0.2, 0.9, 0.2})),
      row("shininess", set("/materials/Matte/extras/relook/shininess", 12)),
      row("unlit", set("/materials/Matte/extras/relook/model", "unlit")),
      row("back to metallic-roughness", set("/materials/Matte/extras/relook/model", "metallic-roughness")),
      row("another material and a light at once", set("/meshes/Ball/primitives/0/material", "Ground"),
          set("/lights/Lamp/intensity", 45)),
      row("another material and ambient light at once", set("/meshes/Ball/primitives/0/material", "Matte"),
          set("/scene/extras/relook/ambient", {0.1, 0.2, 0.1})),
      row("nothing at all", set("/lights/Lamp/intensity", 45)),
  };
}

std::vector<MatrixRow> optical_rows() {
  return {
      row("add a reflection", set("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.05)),
      row("delete a reflection", set("/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.9)),
      row("delete a phong reflection", set("/materials/Mirror/extras/relook/reflection", 0)),
      row("add it again", set("/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.1),
          set("/materials/Mirror/extras/relook/reflection", 0.4)),
      row("add a coat", set("/materials/Ground/extensions/KHR_materials_clearcoat/clearcoatFactor", 0.5)),
      row("delete a coat", set("/materials/Ground/extensions/KHR_materials_clearcoat/clearcoatFactor", 0)),
      row("refraction index", set("/materials/Glass/extensions/KHR_materials_ior/ior", 1.8)),
      row("a film on glass", set("/materials/Glass/extensions/KHR_materials_iridescence/iridescenceFactor", 0.9)),
      row("a film without a base", set("/materials/Glass/extensions/KHR_materials_specular/specularFactor", 0)),
      row("its base again", set("/materials/Glass/extensions/KHR_materials_specular/specularFactor", 1)),
      row("no film on glass", set("/materials/Glass/extensions/KHR_materials_iridescence/iridescenceFactor", 0)),
      row("delete transmission", set("/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", 0)),
      row("delete phong refraction and transparency", set("/materials/Glass/extras/relook/refraction", 0),
          set("/materials/Glass/extras/relook/transparency", 0)),
      row("add phong transparency", set("/materials/Glass/extras/relook/transparency", 0.5)),
      row("add phong refraction", set("/materials/Glass/extras/relook/refraction", 0.5)),
      row("add transmission", set("/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", 0.9)),
      row("a volume", set("/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", 0.5)),
      row("part colours", set("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 6)),
      row("bend parted colours otherwise", set("/materials/Glass/extensions/KHR_materials_ior/ior", 1.6)),
      row("part them more, with a bump map", set("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 9),
          add("/materials/Glass/normalTexture", {{"index", "Bumps"}, {"scale", 0.3}})),
      row("no bump map", removed("/materials/Glass/normalTexture")),
      row("do not part them", set("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 0)),
      row("part them again", set("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 3)),
      row("thin again", set("/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", 0)),
      row("add transparency", set("/materials/Matte/alphaMode", "BLEND"),
          set("/materials/Matte/pbrMetallicRoughness/baseColorFactor/3", 0.5)),
      row("proportion of alpha", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor/3", 0.7)),
      row("delete transparency", set("/materials/Matte/alphaMode", "OPAQUE")),
      row("add a bump map to a mirror", add("/materials/Mirror/normalTexture", {{"index", "Bumps"}})),
      row("change a bump map of a mirror", set("/materials/Mirror/normalTexture/scale", 0.4)),
      row("change the image of a bump map", set("/textures/Bumps/source", "SecondBumpImage")),
      row("delete a bump map of a mirror", removed("/materials/Mirror/normalTexture")),
      row("a bump map on glass", add("/materials/Glass/normalTexture", {{"index", "Bumps"}, {"scale", 0.3}})),
      row("model of a mirror", set("/materials/Mirror/extras/relook/model", "blinn-phong")),
      row("model of glass", set("/materials/Glass/extras/relook/model", "blinn-phong")),
      row("glass is dull", set("/materials/Glass/extras/relook/model", "unlit")),
      row("models of both", set("/materials/Mirror/extras/relook/model", "metallic-roughness"),
          set("/materials/Glass/extras/relook/model", "metallic-roughness")),
  };
}

std::vector<MatrixRow> geometric_rows() {
  const Json lamp = {{"translation", {-2, 3, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", "Lamp"}}}}}};
  return {
      row("transform an object", set("/nodes/Ball/translation", {0.4, 0.8, 0.2})),
      row("flatten it to a sheet", set("/nodes/Ball/scale", {0.9, 1.1, 0})),
      row("to nothing", set("/nodes/Ball/scale", {0, 1, 0})),
      row("rotate and scale it", set("/nodes/Ball/rotation", {0, 0.3, 0.2, 0.9}),
          set("/nodes/Ball/scale", {0.8, 1.2, -0.9})),
      row("transform a mirror", set("/nodes/MirrorBall/translation", {-1.2, 1, 0.6})),
      row("transform glass", set("/nodes/GlassBall/translation", {1, 0.9, 0.9})),
      row("transform the ground", set("/nodes/Ground/translation", {0.3, 0.05, 0.2})),
      row("add an object",
          add("/nodes/Twin", {{"mesh", "Ball"}, {"translation", {0.9, 0.5, 1.2}}, {"scale", {0.5, 0.5, 0.5}}})),
      row("add glass", add("/nodes/SmallGlass",
                           {{"mesh", "GlassBall"}, {"translation", {-0.5, 0.5, 1.7}}, {"scale", {0.5, 0.5, 0.5}}})),
      row("add a coincident object",
          add("/nodes/Shadowed", {{"mesh", "Ball"}, {"translation", {0.9, 0.5, 1.2}}, {"scale", {0.5, 0.5, 0.5}}}),
          set("/meshes/Ball/primitives/0/material", "Mirror")),
      row("another material", set("/meshes/Ball/primitives/0/material", "Glass")),
      row("the first material", set("/meshes/Ball/primitives/0/material", "Matte")),
      row("delete an object", removed("/nodes/Twin")),
      row("hide an object", set("/nodes/GlassBall/extensions/KHR_node_visibility/visible", false)),
      row("show an object", set("/nodes/GlassBall/extensions/KHR_node_visibility/visible", true)),
      row("transform a light", set("/nodes/Lamp/translation", {1, 3.5, 2.5})),
      row("turn a light", set("/nodes/Lamp/rotation", {-0.6, 0.1, 0, 0.79})),
      row("add a light", add("/nodes/SecondLamp", lamp)),
      row("a light and an object at once", set("/nodes/SecondLamp/translation", {-2.5, 3, 2}),
          set("/nodes/SmallGlass/translation", {-0.4, 0.6, 1.6})),
      row("delete a light", removed("/nodes/Lamp")),
      row("add it again", add("/nodes/Lamp", lamp), set("/nodes/Lamp/translation", {2, 4, 3})),
      row("hide a light", set("/nodes/SecondLamp/extensions/KHR_node_visibility/visible", false)),
      row("add a displacement map",
          add("/nodes/Ball/extras", {{"relook", {{"displacement", {{"texture", "Picture"}, {"scale", 0.2}}}}}})),
      row("change a displacement map", set("/nodes/Ball/extras/relook/displacement/scale", 0.1)),
      row("subdivide it", set("/nodes/Ball/extras/relook/displacement/subdivide", 1)),
      row("offset a displacement map",
          set("/nodes/Ball/extras/relook/displacement/extensions/KHR_texture_transform/offset", {0.3, 0.15})),
      row("turn and scale it",
          set("/nodes/Ball/extras/relook/displacement/extensions/KHR_texture_transform/rotation", 0.7),
          set("/nodes/Ball/extras/relook/displacement/extensions/KHR_texture_transform/scale", {2, 3})),
      row("displace by the other uv set", set("/nodes/Ball/extras/relook/displacement/texCoord", 1)),
      row("change the displacing texture", set("/nodes/Ball/extras/relook/displacement/texture", "Marble")),
      row("delete a displacement map", removed("/nodes/Ball/extras/relook/displacement")),
      row("alpha cut-out", add("/materials/Matte/pbrMetallicRoughness/baseColorTexture", {{"index", "Leaves"}}),
          set("/materials/Matte/alphaMode", "MASK")),
      row("cut-off", set("/materials/Matte/alphaCutoff", 0.2)),
      row("image of a cut-out", set("/textures/Leaves/source", "VeilImage")),
      row("no cut-out", set("/materials/Matte/alphaMode", "OPAQUE")),
      row("glass that parts colours", set("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", 7),
          set("/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", 1),
          set("/materials/Glass/extras/relook/model", "metallic-roughness"),
          set("/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", 0.8)),
      row("move it", set("/nodes/GlassBall/translation", {0.8, 0.8, 0.7})),
      row("move what stands before it", set("/nodes/Ball/translation", {0.5, 0.6, 0.9})),
      row("glass without back faces", set("/materials/Glass/doubleSided", false)),
      row("glass with back faces", set("/materials/Glass/doubleSided", true)),
      row("a surface with back faces", set("/materials/Matte/doubleSided", true)),
      row("a surface without them", set("/materials/Matte/doubleSided", false)),
      row("geometry and color", set("/nodes/Ball/translation", {0.1, 0.9, 0.1}),
          set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.9, 0.7, 0.2, 1}),
          set("/lights/Lamp/intensity", 70)),
      row("geometry and optics", set("/nodes/MirrorBall/translation", {-1.4, 0.9, 0.2}),
          set("/materials/Glass/extensions/KHR_materials_ior/ior", 1.3),
          set("/materials/Ground/pbrMetallicRoughness/roughnessFactor", 0.1)),
  };
}

struct MatrixCase {
  TestScene scene;
  std::uint32_t samples;
  ChangeClass kind;
  std::uint32_t shadow_bits = 0;
  Integrator integrator = Integrator::whitted;
};

void PrintTo(const MatrixCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << change_class_name(c.kind) << ", " << c.samples << " samples, "
       << c.shadow_bits << " shadow bits, " << integrator_word(c.integrator);
}

class EditMatrix : public testing::TestWithParam<MatrixCase> {};

std::string case_name(const testing::TestParamInfo<MatrixCase>& info) {
  return std::string(test_scene_name(info.param.scene)) + "_" + std::string(change_class_name(info.param.kind)) + "_" +
         std::to_string(info.param.samples) +
         (info.param.shadow_bits == 0 ? "" : "_shadow_bits_" + std::to_string(info.param.shadow_bits)) +
         (info.param.integrator == Integrator::path ? "_path" : "");
}

std::vector<MatrixRow> rows_of(ChangeClass kind) {
  if (kind == ChangeClass::color) return color_rows();
  return kind == ChangeClass::optical ? optical_rows() : geometric_rows();
}

TEST_P(EditMatrix, ReplayedFrameAndTreesAreThoseOfAFullRender) {
  const auto [which, samples, kind, shadow_bits, integrator] = GetParam();
  if (integrator == Integrator::path) {  // where buckets, suns and emission make the class of a row
    const std::uint32_t width = samples == 1 ? 68 : 28, height = samples == 1 ? 18 : 21;
    expect_full_renders(test_scene(which, width, height), path_view(samples), rows_of(kind), std::nullopt);
    return;
  }
  // In the study Picture displaces and Matte spawns coat rays.
  const bool is_of_color = kind == ChangeClass::color && which != TestScene::study;
  expect_full_renders(test_scene(which, 64 / samples + 24, 48 / samples + 18), {samples, 6, shadow_bits}, rows_of(kind),
                      is_of_color ? std::optional(ChangeClass::color) : std::nullopt);
}

std::vector<MatrixCase> all_cases() {
  std::vector<MatrixCase> cases;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const std::uint32_t samples : {1U, 4U})
      for (const ChangeClass kind : {ChangeClass::color, ChangeClass::optical, ChangeClass::geometric})
        cases.push_back({scene, samples, kind});
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    for (const std::uint32_t shadow_bits : {1U, 2U, 3U, 4U})
      cases.push_back({scene, 1, ChangeClass::geometric, shadow_bits});
    cases.push_back({scene, 1, ChangeClass::optical, 2});
    cases.push_back({scene, 1, ChangeClass::color, 1});
    cases.push_back({scene, 4, ChangeClass::geometric, 1});
  }
  return cases;
}

std::vector<MatrixCase> path_cases() {
  std::vector<MatrixCase> cases;
  std::uint32_t samples = 0;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study, TestScene::lights})
    for (const ChangeClass kind : {ChangeClass::color, ChangeClass::optical, ChangeClass::geometric})
      cases.push_back({scene, 1 + samples++ % 4, kind, 0, Integrator::path});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Path, EditMatrix, testing::ValuesIn(path_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Table1, EditMatrix, testing::ValuesIn(all_cases()), case_name);

}  // namespace
}  // namespace relook
