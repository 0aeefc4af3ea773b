// glTF import: geometry comes out as written, and every kind of damage is refused with its place.
#include "scene/gltf/import.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "gltf_writer.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

class Import : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("relook_import_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] ImportedGltf import_bytes(std::string_view bytes, const std::string& name = "scene.glb") const {
    write_plain(name, bytes);
    return import_gltf(folder_ / name);
  }
  /// The message after the file's name; "" if the file is accepted.
  [[nodiscard]] std::string refusal(std::string_view bytes, const std::string& name = "scene.glb") const {
    try {
      (void)import_bytes(bytes, name);
    } catch (const InputError& error) {
      const std::string prefix = (folder_ / name).string() + ": ", message = error.what();
      EXPECT_TRUE(message.starts_with(prefix)) << message;
      return message.substr(prefix.size());
    }
    return "";
  }
  [[nodiscard]] std::string refusal(const SceneFile& file) const { return refusal(file.glb()); }
  [[nodiscard]] Mesh only_mesh(const SceneFile& file) const {
    ImportedGltf imported = import_bytes(file.glb());
    EXPECT_EQ(imported.meshes.size(), 1U);
    EXPECT_EQ(imported.meshes.at(0).size(), 1U);
    return std::move(imported.meshes.at(0).at(0));
  }
  void write_plain(const std::string& name, std::string_view bytes) const {
    std::FILE* out = std::fopen((folder_ / name).c_str(), "wb");
    ASSERT_NE(out, nullptr);
    std::fwrite(bytes.data(), 1, bytes.size(), out);
    std::fclose(out);
  }

  fs::path folder_;
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST_F(Import, a_square) {
  const ImportedGltf imported = import_bytes(square().glb());
  const Mesh& mesh = imported.meshes.at(0).at(0);
  EXPECT_EQ(mesh.positions.at(3), Point(1, 1, 0));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(mesh.bounds.max, Point(1, 1, 0));
  EXPECT_TRUE(mesh.normals.empty() && mesh.tangents.empty() && mesh.colors.empty());
  EXPECT_EQ(imported.instances.size(), 3U);
  EXPECT_TRUE(imported.warnings.empty());
}

TEST_F(Import, every_triangle_mode) {
  SceneFile file = square();
  file.primitive().erase("indices");
  file.primitive()["mode"] = 5;
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
  file.primitive()["mode"] = 6;
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{1, 2, 0}, {2, 3, 0}}));
  file.primitive()["mode"] = 4;
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{0, 1, 2}})) << "an incomplete triangle is left out";
}

TEST_F(Import, points_lines_and_empty_primitives_are_left_out_with_a_warning) {
  for (int mode = 0; mode < 4; ++mode) {
    SceneFile file = square();
    file.primitive()["mode"] = mode;
    const ImportedGltf imported = import_bytes(file.glb());
    EXPECT_TRUE(imported.meshes.at(0).empty());
    ASSERT_EQ(imported.warnings.size(), 1U);
    EXPECT_EQ(imported.warnings[0], "/meshes/0/primitives/0: points and lines are ignored");
  }
}

TEST_F(Import, index_types_and_interleaved_positions) {
  SceneFile file = square();
  file.primitive()["indices"] =
      file.add_accessor(file.add_view<std::uint8_t>({9, 0, 1, 3}), 5121, "SCALAR", 3, {{"byteOffset", 1}});
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{0, 1, 2}})) << "of the vertices that are named, in their order";
  EXPECT_EQ(only_mesh(file).positions.size(), 3U);
  file.primitive()["indices"] = file.add_accessor(file.add_view<std::uint32_t>({3, 2, 1}), 5125, "SCALAR", 3);
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{2, 1, 0}}));

  const std::size_t view = file.add_view<float>({7, 0, 0, 1, 7, 0, 1, 1, 7, 1, 0, 1, 7, 1, 1, 1}, 16);
  file.primitive()["attributes"]["POSITION"] = file.add_accessor(view, 5126, "VEC3", 4, {{"byteOffset", 4}});
  const Mesh mesh = only_mesh(file);
  EXPECT_EQ(mesh.positions.at(0), Point(0, 1, 1));
  EXPECT_EQ(mesh.positions.at(2), Point(1, 1, 1));
}

TEST_F(Import, sparse_positions_over_data_and_over_nothing) {
  SceneFile file = square();
  const std::size_t indices = file.add_view<std::uint16_t>({1, 3});
  const std::size_t values = file.add_view<float>({5, 6, 7, 8, 9, 10});
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  file.gltf["accessors"][0]["sparse"] = sparse;
  EXPECT_EQ(only_mesh(file).positions, (std::vector<Point>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}, {8, 9, 10}}));
  file.gltf["accessors"][0].erase("bufferView");
  EXPECT_EQ(only_mesh(file).positions, (std::vector<Point>{{0, 0, 0}, {5, 6, 7}, {0, 0, 0}, {8, 9, 10}}));

  file.gltf["accessors"][0]["sparse"]["indices"]["bufferView"] = file.add_view<std::uint16_t>({3, 1});
  EXPECT_EQ(refusal(file), "/meshes/0/primitives/0/attributes/POSITION: sparse indices do not increase");
  file.gltf["accessors"][0]["sparse"]["indices"]["bufferView"] = file.add_view<std::uint16_t>({1, 4});
  EXPECT_EQ(refusal(file), "/meshes/0/primitives/0/attributes/POSITION: a sparse index is not below count");
}

TEST_F(Import, quantized_and_normalized_attributes) {
  SceneFile file = square();
  Json& attributes = file.primitive()["attributes"];
  attributes["POSITION"] = file.add_accessor(
      file.add_view<std::int8_t>({0, 0, 0, 0, 10, -128, 0, 0, 0, 127, 0, 0, 1, 1, 1, 0}, 4), 5120, "VEC3", 4);
  attributes["NORMAL"] =
      file.add_accessor(file.add_view<std::int8_t>({0, 0, 127, 0, 0, 0, -128, 0, 127, 0, 0, 0, 0, 0, 0, 0}, 4), 5120,
                        "VEC3", 4, {{"normalized", true}});
  attributes["TEXCOORD_0"] = file.add_accessor(file.add_view<std::uint16_t>({0, 65535, 65535, 0, 1, 2, 3, 4}), 5123,
                                               "VEC2", 4, {{"normalized", true}});
  attributes["COLOR_0"] =
      file.add_accessor(file.add_view<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 255, 255, 1, 2, 3, 255}),
                        5121, "VEC4", 4, {{"normalized", true}});
  const Mesh mesh = only_mesh(file);
  EXPECT_EQ(mesh.positions.at(1), Point(10, -128, 0));
  EXPECT_EQ(mesh.normals.at(0), Normal(0, 0, 1));
  EXPECT_EQ(mesh.normals.at(1), Normal(0, 0, -1)) << "-128 / 127 is clamped";
  EXPECT_NEAR(mesh.normals.at(3).length(), 1, 1e-6) << "a zero normal is replaced by that of the triangles";
  EXPECT_EQ(mesh.uv[0].at(0), Uv(0, 1));
  EXPECT_EQ(mesh.colors.at(1), Rgba(0, 1, 0, 51.0F / 255.0F));
  EXPECT_EQ(mesh.min_alpha, 51.0F / 255.0F);
}

TEST_F(Import, vertex_data_must_be_finite_and_indices_in_range) {
  const std::string indices = "/meshes/0/primitives/0/indices: ";
  SceneFile file = square();
  file.primitive()["indices"] = file.add_accessor(file.add_view<std::uint16_t>({0, 1, 4}), 5123, "SCALAR", 3);
  EXPECT_EQ(refusal(file), indices + "index 2 is 4, but there are 4 vertices");
  file.primitive()["indices"] =
      file.add_accessor(file.add_view<std::uint16_t>({0, 65535, 1, 2, 3, 0}), 5123, "SCALAR", 6);
  EXPECT_EQ(only_mesh(file).triangles, (Triangles{{0, 1, 2}})) << "lists begin anew behind a restart value";
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e9F}) {
    file = square();
    file.primitive()["attributes"]["POSITION"] = file.floats({0, 0, 0, 1, bad, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
    EXPECT_TRUE(refusal(file).starts_with("/meshes/0/primitives/0/attributes/POSITION: element 1 is ")) << bad;
  }
  file = square();
  file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC3", 3);
  EXPECT_NE(refusal(file).find("has 4 elements, another attribute has 2"), std::string::npos) << refusal(file);
  file = square();
  file.primitive()["attributes"]["TANGENT"] = file.floats({1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
  EXPECT_TRUE(only_mesh(file).tangents.empty()) << "a w that is neither 1 nor -1";
}

TEST_F(Import, instances_are_scaled_then_rotated_then_moved) {
  SceneFile file = square();
  const float half = 0.70710678F;
  const std::size_t moves = file.floats({1, 2, 3, 0, 0, 0}, "VEC3", 3);
  const std::size_t turns = file.floats({0, 0, half, half, 0, 0, 0, 2}, "VEC4", 4);
  const std::size_t scales = file.floats({2, 3, 4, 1, 1, -1}, "VEC3", 3);
  file.gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", moves}, {"ROTATION", turns}, {"SCALE", scales}};
  const auto instances = import_bytes(file.glb()).instances.at(0);
  ASSERT_EQ(instances.size(), 2U);
  Point moved;
  instances[0].multVecMatrix(Point(1, 1, 1), moved);  // (2, 3, 4), a quarter turn about z: (-3, 2, 4)
  EXPECT_LT((moved - Point(-2, 4, 7)).length(), 1e-5F);
  instances[1].multVecMatrix(Point(1, 1, 1), moved);
  EXPECT_EQ(moved, Point(1, 1, -1)) << "quaternions are normalised";
  file.gltf["accessors"][scales]["count"] = 1;
  EXPECT_NE(refusal(file).find("TRANSLATION, ROTATION and SCALE differ in count"), std::string::npos);
}

struct Damage {
  const char* pointer;  // in the JSON of square()
  Json value;
  const char* message;  // its beginning
};

const std::vector<Damage> kDamages = {
    {"/asset/version", "1.0", "/asset/version: glTF version \"1.0\" is not supported"},
    {"/asset/minVersion", "2.1", "/asset/minVersion: glTF version \"2.1\" is required"},
    {"/extensionsRequired",
     {"EXT_primitive_voxels"},
     "/extensionsRequired/0: required extension EXT_primitive_voxels is not supported"},
    {"/scene", 1, "/scene: there is no scene 1; the file has 1"},
    {"/scene", 0.5, "/scene: must be an integer"},
    {"/scenes/0/nodes/0", 9, "/scenes/0/nodes/0: there is no node 9; the file has 3"},
    {"/nodes/0/mesh", -1, "/nodes/0/mesh: there is no mesh -1"},
    {"/nodes/0/children", {1, 1}, "/nodes/0/children/1: node 1 has more than one parent"},
    {"/nodes/1/children", {0}, "/nodes/0: is its own ancestor"},
    {"/nodes/1/camera", 3, "/nodes/1/camera: there is no camera 3"},
    {"/nodes/1/translation", {0, 0}, "/nodes/1/translation: expected an array of 3 numbers, got 2"},
    {"/nodes/1/translation", {0, 0, "x"}, "/nodes/1/translation/2: expected a number, got a string"},
    {"/nodes/1/rotation", {0, 0, 0, 0}, "/nodes/1/rotation: the quaternion is zero"},
    {"/nodes/1/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "/nodes/1/matrix: a node has either"},
    {"/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "/nodes/0/matrix: the matrix is not affine"},
    {"/nodes/0/matrix", {1, 0, 0, "x"}, "/nodes/0/matrix: expected an array of 16 numbers, got 4"},
    {"/nodes/2/extensions/KHR_lights_punctual/light", 1,
     "/nodes/2/extensions/KHR_lights_punctual/light: there is no light 1"},
    {"/nodes/0/extensions/KHR_node_visibility/visible", 1,
     "/nodes/0/extensions/KHR_node_visibility/visible: expected true or false, got a number"},
    {"/nodes/0/name", 5, "/nodes/0/name: must be a string"},
    {"/nodes/0", 5, "/nodes/0: must be an object"},
    {"/cameras/0/perspective/znear", 0, "/cameras/0/perspective/znear: 0 is not above 0"},
    {"/cameras/0/type", "fisheye", "/cameras/0/type: \"fisheye\" is not one of"},
    {"/materials/0/pbrMetallicRoughness/metallicFactor", 1.5,
     "/materials/0/pbrMetallicRoughness/metallicFactor: 1.5 is above 1"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1,
     "/materials/0/pbrMetallicRoughness/baseColorTexture/index: there is no texture 1"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", 2,
     "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord: 2 is above 1"},
    {"/materials/0/extensions/KHR_materials_ior/ior", 0.5,
     "/materials/0/extensions/KHR_materials_ior/ior: 0.5 is below 1 and not 0"},
    {"/materials/0/extensions/KHR_materials_dispersion/dispersion", -1,
     "/materials/0/extensions/KHR_materials_dispersion/dispersion: -1 is below 0"},
    {"/materials/0/extensions/KHR_materials_volume/attenuationDistance", 0,
     "/materials/0/extensions/KHR_materials_volume/attenuationDistance: 0 is not above 0"},
    {"/materials/0/alphaMode", "blend", "/materials/0/alphaMode: \"blend\" is not one of"},
    {"/textures/0/source", 0, "/textures/0/source: there is no image 0"},
    {"/samplers/0/wrapS", 1, "/samplers/0/wrapS: 1 is not one of 10497, 33071, 33648"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 1.2,
     "/extensions/KHR_lights_punctual/lights/0/spot: outerConeAngle must be greater"},
    {"/extensions/KHR_lights_punctual/lights/0/color",
     {1, -1, 1},
     "/extensions/KHR_lights_punctual/lights/0/color/1: -1 is below 0"},
    {"/meshes/0/primitives/0/indices", 2, "/meshes/0/primitives/0/indices: there is no accessor 2"},
    {"/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode: 7 is out of range"},
    {"/meshes/0/primitives/0/material", 1, "/meshes/0/primitives/0/material: there is no material 1"},
    {"/meshes/0/primitives/0/attributes/POSITION", 1,
     "/meshes/0/primitives/0/attributes/POSITION: the accessor's type"},
    {"/meshes/0/primitives", Json::object(), "/meshes/0/primitives: must be an array"},
    {"/accessors/0/count", 5, "/accessors/0: reaches to byte 60 of a buffer view of 48"},
    {"/accessors/0/count", 0, "/accessors/0/count: 0 is out of range"},
    {"/accessors/0/count", std::uint64_t{1} << 62, "/accessors/0/count: 4611686018427387904 is out of range"},
    {"/accessors/0/byteOffset", std::uint64_t{1} << 63, "/accessors/0/byteOffset: 9223372036854775808 is out of range"},
    {"/accessors/0/byteOffset", 2, "/accessors/0: is not aligned to its components of 4 bytes"},
    {"/accessors/0/componentType", 5124, "/accessors/0/componentType: component type 5124"},
    {"/accessors/0/type", "VEC5", "/accessors/0/type: \"VEC5\" is not one of"},
    {"/accessors/0/bufferView", 5, "/accessors/0/bufferView: there is no buffer view 5"},
    {"/accessors/0/normalized", true, "/accessors/0/normalized: only 8-bit and 16-bit"},
    {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: there is no buffer 1"},
    {"/bufferViews/0/byteLength", 61, "/bufferViews/0: reaches to byte 61 of a buffer of 60"},
    {"/bufferViews/0/byteOffset", -4, "/bufferViews/0/byteOffset: -4 is out of range"},
    {"/bufferViews/0/byteStride", 8, "/accessors/0: elements of 12 bytes do not fit the stride of 8"},
    {"/images", {{{"bufferView", 9}, {"mimeType", "image/png"}}}, "/images/0/bufferView: there is no buffer view 9"},
    {"/images", {{{"uri", "../side.png"}}}, "/images/0/uri: \"../side.png\" leads out of its folder"},
    {"/images", {{{"uri", "/side.png"}}}, "/images/0/uri: \"/side.png\" is not a relative path"},
};

TEST_F(Import, wrong_values_are_refused_at_their_place) {
  EXPECT_EQ(refusal(square()), "");
  for (const Damage& damage : kDamages) {
    SceneFile file = square();
    file.gltf[Json::json_pointer(damage.pointer)] = damage.value;
    const std::string message = refusal(file);
    EXPECT_TRUE(message.starts_with(damage.message)) << damage.pointer << " gives: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST_F(Import, every_cut_of_a_glb_is_refused) {
  const std::string bytes = square().glb();
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_NE(refusal(std::string_view(bytes).substr(0, length)), "") << length;
  EXPECT_EQ(refusal(bytes + "x"), "") << "what is behind the counted bytes is ignored";
}

TEST_F(Import, every_flipped_byte_gives_a_scene_or_one_line) {
  const std::string bytes = square().glb();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x15);
    EXPECT_EQ(refusal(damaged).find('\n'), std::string::npos);
  }
}

TEST_F(Import, deep_node_chains_are_walked_without_recursion) {
  SceneFile file;
  for (int i = 0; i < 100'000; ++i) file.gltf["nodes"].push_back({{"children", {i + 1}}});
  file.gltf["nodes"].push_back(Json::object());
  EXPECT_EQ(refusal(file), "");
  file.gltf["nodes"].back()["children"] = {50'000};
  EXPECT_NE(refusal(file).find("has more than one parent"), std::string::npos);
  file.gltf["nodes"].back()["children"] = {0};
  EXPECT_NE(refusal(file).find("is its own ancestor"), std::string::npos);
}

TEST_F(Import, a_small_file_cannot_ask_for_unbounded_memory) {
  SceneFile file = square();
  file.gltf["accessors"][0].erase("bufferView");
  file.gltf["accessors"][0]["count"] = 1U << 30;
  EXPECT_NE(refusal(file).find("elements without a buffer view"), std::string::npos);
  file.gltf["accessors"][0]["count"] = 1U << 22;
  file.primitive().erase("indices");
  for (int i = 0; i < 1000; ++i) file.gltf["meshes"][0]["primitives"].push_back(file.primitive());
  EXPECT_NE(refusal(file).find("/meshes: the geometry needs"), std::string::npos);
}

TEST_F(Import, external_files_and_data_uris) {
  const SceneFile file = square();
  write_plain("my data.bin", file.binary);
  Json gltf = file.gltf;
  gltf["buffers"] = {{{"byteLength", file.binary.size()}, {"uri", "my%20data.bin"}}};
  EXPECT_EQ(refusal(gltf.dump(), "scene.gltf"), "");
  gltf["buffers"][0]["byteLength"] = file.binary.size() + 1;
  EXPECT_NE(refusal(gltf.dump(), "scene.gltf").find("/buffers/0/byteLength: says"), std::string::npos);
  gltf["buffers"][0] = {{"byteLength", file.binary.size()}, {"uri", "%2e%2e/my%20data.bin"}};
  EXPECT_NE(refusal(gltf.dump(), "scene.gltf").find("leads out of its folder"), std::string::npos);
  gltf["buffers"][0]["uri"] = "%zz";
  EXPECT_NE(refusal(gltf.dump(), "scene.gltf").find("two hexadecimal digits"), std::string::npos);
  gltf["buffers"][0]["uri"] = "none.bin";
  EXPECT_EQ(refusal(gltf.dump(), "scene.gltf"), "/buffers/0/uri: no such file: \"none.bin\"");
  gltf["buffers"][0].erase("uri");
  EXPECT_NE(refusal(gltf.dump(), "scene.gltf").find("the accessor's buffer has no data"), std::string::npos);

  gltf["buffers"][0] = {{"byteLength", 4}, {"uri", "data:application/octet-stream;base64,AQIDBA=="}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteLength", 3}, {"byteOffset", 1}}};
  gltf["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  for (const char* key : {"accessors", "meshes", "nodes", "scenes", "scene"}) gltf.erase(key);
  const ImportedGltf imported = import_bytes(gltf.dump(), "scene.gltf");
  EXPECT_EQ(text_of(*imported.images.at(0).bytes), "\x02\x03\x04");
  EXPECT_FALSE(imported.gltf["buffers"][0].contains("uri")) << "data URIs do not stay in the document";
}

}  // namespace
}  // namespace relook
