// KHR_materials_pbrSpecularGlossiness: the converted material is the same surface as the metallic-roughness one that
// describes it, texel by texel.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

#include "base/png_chunks.h"
#include "gltf_writer.h"
#include "run_program.h"
#include "scene/gltf/import.h"
#include "scene/look/look.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// 8-bit RGBA.
std::vector<unsigned char> rgba_png(std::uint32_t width, std::uint32_t height, const std::string& samples) {
  std::string rows;
  for (std::uint32_t y = 0; y < height; ++y) rows += '\0' + samples.substr(std::size_t{y} * width * 4, width * 4);
  uLongf size = compressBound(rows.size());
  Bytes header, stream(size);
  compress(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
  stream.resize(size);
  append_png_number(header, width);
  append_png_number(header, height);
  for (const int value : {8, 6, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));
  const BytesView signature = bytes_of(kPngSignature);
  Bytes png(signature.begin(), signature.end());
  append_png_chunk(png, "IHDR", header);
  append_png_chunk(png, "IDAT", stream);
  append_png_chunk(png, "IEND", {});
  std::vector<unsigned char> bytes;
  for (const std::byte b : png) bytes.push_back(static_cast<unsigned char>(b));
  return bytes;
}

/// A square of z = 0 with texture coordinates, a lamp and a camera before it.
SceneFile lit_square() {
  SceneFile file = square();
  const std::size_t uv = file.floats({0, 1, 1, 1, 0, 0, 1, 0}, "VEC2", 2);
  file.primitive()["attributes"]["TEXCOORD_0"] = uv;
  file.gltf["nodes"][1]["translation"] = {0.5, 0.5, 1.2};
  file.gltf["nodes"][2]["translation"] = {0.7, 0.8, 1};
  file.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 3}}};
  file.gltf["samplers"] = {{{"magFilter", 9728}}};
  file.gltf["textures"] = {{{"sampler", 0}, {"source", 0}}};
  return file;
}
/// Specular colour in RGB, glossiness in alpha.
void add_image(SceneFile& file, const std::string& samples) {
  const std::size_t view = file.add_view(rgba_png(2, 2, samples));
  file.gltf["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
}

struct Loaded {
  LookDocument document;
  std::vector<std::string> warnings;
};
Loaded load(const SceneFile& file) {
  const ScratchFolder folder("specular_glossiness");
  write_file(folder / "scene.glb", file.glb());
  ImportedGltf imported = import_gltf(folder / "scene.glb");
  std::vector<std::string> warnings = imported.warnings;
  return {make_look_document(std::move(imported)), std::move(warnings)};
}
Frame frame_of(const SceneFile& file) {
  LookDocument document = load(file).document;
  const Camera camera = choose_camera(document, "", 24, 24);
  const SceneState state(std::move(document), camera, std::make_shared<PyramidStore>());
  return rendered(state.scene(), {1, 3});
}
void expect_same_picture(const SceneFile& a, const SceneFile& b) {
  const Frame one = frame_of(a), other = frame_of(b);
  float brightest = 0;
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(one.pixels[i][c], other.pixels[i][c], 1e-4F + 1e-3F * other.pixels[i][c]) << i;
      brightest = std::max(brightest, one.pixels[i][c]);
    }
  EXPECT_GT(brightest, 0.2F);
}
SceneFile with_material(SceneFile file, const Json& material) {
  file.gltf["materials"] = Json::array({material});
  return file;
}
Json converted(const Json& values) { return {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", values}}}}; }
Json metallic(const Json& values) { return {{"pbrMetallicRoughness", values}}; }

TEST(SpecularGlossiness, FactorsDescribeTheSameMetalAndTheSamePlastic) {
  SceneFile file = lit_square();
  file.gltf.erase("textures");
  expect_same_picture(with_material(file, converted({{"diffuseFactor", {0, 0, 0, 1}},
                                                     {"specularFactor", {0.9, 0.7, 0.3}},
                                                     {"glossinessFactor", 0.6}})),
                      with_material(file, metallic({{"baseColorFactor", {0.9, 0.7, 0.3, 1}},
                                                    {"metallicFactor", 1},
                                                    {"roughnessFactor", 0.4}})));
  expect_same_picture(with_material(file, converted({{"diffuseFactor", {0.2, 0.5, 0.8, 1}},
                                                     {"specularFactor", {0.04, 0.04, 0.04}},
                                                     {"glossinessFactor", 0.5}})),
                      with_material(file, metallic({{"baseColorFactor", {0.2, 0.5, 0.8, 1}},
                                                    {"metallicFactor", 0},
                                                    {"roughnessFactor", 0.5}})));
}

TEST(SpecularGlossiness, TexturesAreConvertedTexelByTexel) {
  // Four metals; the same as base colours with their roughness in another texture.
  SceneFile specular = lit_square(), metals = lit_square();
  std::string colors, values;
  for (const int glossiness : {255, 200, 128, 51}) {
    colors += std::string{static_cast<char>(200), static_cast<char>(glossiness), 90, static_cast<char>(glossiness)};
    const int roughness = static_cast<int>(std::lround(255 - 0.8 * glossiness));
    values += std::string{0, static_cast<char>(roughness), static_cast<char>(255), static_cast<char>(255)};
  }
  add_image(specular, colors);
  add_image(metals, colors);
  add_image(metals, values);
  metals.gltf["textures"].push_back({{"sampler", 0}, {"source", 1}});
  const Json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}};
  expect_same_picture(
      with_material(specular, converted({{"diffuseFactor", {0, 0, 0, 1}},
                                         {"glossinessFactor", 0.8},
                                         {"specularGlossinessTexture", {{"index", 0}, {"extensions", transform}}}})),
      with_material(metals, metallic({{"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
                                      {"metallicRoughnessTexture", {{"index", 1}, {"extensions", transform}}}})));
}

TEST(SpecularGlossiness, ADocumentHasTheWholeMaterial) {
  SceneFile file = lit_square();
  add_image(file, std::string(15, static_cast<char>(200)) + static_cast<char>(0));
  Json material = converted({{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                             {"diffuseTexture", {{"index", 0}}},
                             {"specularFactor", {0.5, 0.6, 0.7}},
                             {"specularGlossinessTexture", {{"index", 0}}}});
  material["name"] = "Old";
  material["pbrMetallicRoughness"] = {{"metallicFactor", 0.5}, {"baseColorFactor", {1, 0, 0, 1}}};  // for others
  file.gltf["extensionsRequired"] = file.gltf["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  const Loaded loaded = load(with_material(file, material));
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("material \"Old\": KHR_materials_pbrSpecularGlossiness"), std::string::npos);
  const Json& old = loaded.document.look["materials"]["Old"];
  EXPECT_EQ(old["pbrMetallicRoughness"]["baseColorFactor"], Json({0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(old["pbrMetallicRoughness"]["baseColorTexture"]["index"], "texture_0");
  EXPECT_EQ(old["pbrMetallicRoughness"]["metallicFactor"], 0);
  EXPECT_EQ(old["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], "texture_0 roughness");
  EXPECT_EQ(old["extensions"]["KHR_materials_specular"]["specularColorFactor"], Json({0.5, 0.6, 0.7}));
  EXPECT_EQ(old["extensions"]["KHR_materials_specular"]["specularColorTexture"]["index"], "texture_0");
  EXPECT_EQ(old["extensions"]["KHR_materials_ior"]["ior"], 0);
  EXPECT_EQ(loaded.document.look["textures"]["texture_0 roughness"]["source"], "image_0 roughness");
}

TEST(SpecularGlossiness, WhatBringsNoAlphaIsANumber) {
  SceneFile opaque = lit_square(), broken = lit_square(), empty = lit_square();
  add_image(opaque, std::string(16, static_cast<char>(255)));
  add_image(broken, std::string(16, static_cast<char>(200)));
  broken.binary.resize(broken.binary.size() - 20);
  broken.binary.append(20, 'x');
  empty.gltf["textures"] = Json::array({Json::object()});
  for (const SceneFile* file : {&opaque, &broken, &empty}) {
    const Loaded loaded = load(with_material(
        *file, converted({{"glossinessFactor", 0.75}, {"specularGlossinessTexture", {{"index", 0}}}})));
    const Json& surface = loaded.document.look["materials"]["material_0"]["pbrMetallicRoughness"];
    EXPECT_EQ(surface["roughnessFactor"], 0.25);
    EXPECT_FALSE(surface.contains("metallicRoughnessTexture"));
  }
}

}  // namespace
}  // namespace relook
