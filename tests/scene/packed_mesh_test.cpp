// Compressed meshes: what comes out is what was put in, whatever the file has beside it; damage and greed are refused
// with their place.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/import_memory.h"
#include "packed_files.h"
#include "run_program.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/import.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.25F};
const std::vector<float> kUvs = {0, 0, 1, 0, 0, 1, 0.5F, 0.75F};
const std::vector<std::uint8_t> kIndices = {0, 1, 2, 2, 1, 3};

class PackedMeshes : public testing::Test {
 protected:
  ~PackedMeshes() override { set_import_memory(kImportMemory); }

  [[nodiscard]] fs::path written(const SceneFile& file) const {
    std::ofstream(folder_ / "scene.glb", std::ios::binary) << file.glb();
    return folder_ / "scene.glb";
  }
  [[nodiscard]] ImportedGltf imported(const SceneFile& file) const { return import_gltf(written(file)); }
  /// The message after the file's name; "" if the file is accepted.
  [[nodiscard]] std::string refusal(const SceneFile& file) const {
    const fs::path path = written(file);
    try {
      (void)import_gltf(path);
    } catch (const Error& error) {
      return std::string(error.what()).substr(path.string().size() + 2);
    }
    return "";
  }

  ScratchFolder folder_{"packed_meshes"};
};

/// A square of Draco data alone: no accessor has a view.
SceneFile draco_square(const std::string& draco) {
  SceneFile file = square();
  file.binary.clear();
  file.gltf["bufferViews"] = Json::array();
  file.gltf.erase("extensions");
  file.gltf.erase("extensionsUsed");
  file.gltf["nodes"] = {{{"mesh", 0}}};
  file.gltf["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
                            {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}},
                            {{"componentType", 5126}, {"type", "VEC2"}, {"count", 4}}};
  const std::size_t view = file.add_view<char>({draco.begin(), draco.end()});
  file.primitive() = {
      {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}},
      {"indices", 1},
      {"extensions",
       {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 7}, {"TEXCOORD_0", 3}}}}}}}};
  file.gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

std::vector<DracoColumn> square_columns() {
  return {{7, 0, 9, 3, bytes_of_numbers(kCorners)}, {3, 3, 9, 2, bytes_of_numbers(kUvs)}};
}
std::string draco_square_data(DracoCounts counts = {}) { return draco_mesh(kIndices, 4, square_columns(), counts); }
SceneFile draco_square() { return draco_square(draco_square_data()); }
Json& draco_extension_of(SceneFile& file) { return file.primitive()["extensions"]["KHR_draco_mesh_compression"]; }

void expect_square(const Mesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(mesh.positions[i], Point(kCorners[3 * i], kCorners[3 * i + 1], kCorners[3 * i + 2])) << i;
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}}));
}

TEST_F(PackedMeshes, draco_data_is_the_primitive) {
  const ImportedGltf got = imported(draco_square());
  expect_square(got.meshes.at(0).at(0));
  EXPECT_EQ(got.meshes[0][0].uv[0].at(3), Uv(0.5F, 0.75F));
  EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
}

TEST_F(PackedMeshes, draco_data_goes_before_what_is_beside_it) {
  SceneFile file = draco_square();
  file.gltf.erase("extensionsRequired");
  for (const std::size_t accessor : {0, 2}) {  // other values
    const std::size_t view = file.add_view(std::vector<float>(12, 9.0F));
    file.gltf["accessors"][accessor]["bufferView"] = view;
  }
  expect_square(imported(file).meshes.at(0).at(0));
}

TEST_F(PackedMeshes, draco_data_of_a_newer_version_gives_way_to_plain_data) {
  SceneFile file = draco_square(draco_square_data({.major = 2, .minor = 3}));
  EXPECT_EQ(refusal(file),
            "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: Draco data of version 2.3; versions up to "
            "2.2 are read; `gltf-transform copy IN.glb OUT.glb` writes the file uncompressed");
  file.gltf["accessors"][0]["bufferView"] = file.add_view(kCorners);
  file.gltf["accessors"][1]["bufferView"] = file.add_view<std::uint16_t>({0, 1, 2, 2, 1, 3});
  file.gltf["accessors"][2]["bufferView"] = file.add_view(kUvs);
  const ImportedGltf got = imported(file);
  expect_square(got.meshes.at(0).at(0));
  ASSERT_EQ(got.warnings.size(), 1U);
  EXPECT_NE(got.warnings[0].find("the uncompressed data is read"), std::string::npos) << got.warnings[0];
}

TEST_F(PackedMeshes, attributes_without_draco_data_and_targets_stand_beside_it) {
  SceneFile file = draco_square();
  draco_extension_of(file)["attributes"].erase("TEXCOORD_0");
  file.gltf["accessors"][2]["bufferView"] = file.add_view(std::vector<float>{0, 0, 0.25F, 0, 0, 0.25F, 1, 1});
  file.primitive()["targets"] = {{{"POSITION", file.floats(std::vector<float>(12, 2.0F), "VEC3", 3)}}};
  const Mesh mesh = imported(file).meshes.at(0).at(0);
  expect_square(mesh);
  EXPECT_EQ(mesh.uv[0].at(1), Uv(0.25F, 0));
  EXPECT_EQ(mesh.targets.at(0).positions.at(3), Imath::V3f(2, 2, 2));
}

TEST_F(PackedMeshes, draco_joints_and_weights) {
  auto columns = square_columns();
  columns.push_back(
      {1, 4, 4, 4, bytes_of_numbers(std::vector<std::uint16_t>{0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 300, 0, 0, 0})});
  columns.push_back(
      {2, 4, 9, 4, bytes_of_numbers(std::vector<float>{0.25F, 0.75F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})});
  SceneFile file = draco_square(draco_mesh(kIndices, 4, columns));
  file.gltf["accessors"].push_back({{"componentType", 5123}, {"type", "VEC4"}, {"count", 4}});
  file.gltf["accessors"].push_back({{"componentType", 5126}, {"type", "VEC4"}, {"count", 4}});
  file.primitive()["attributes"].update({{"JOINTS_0", 3}, {"WEIGHTS_0", 4}});
  draco_extension_of(file)["attributes"].update({{"JOINTS_0", 1}, {"WEIGHTS_0", 2}});
  const Mesh mesh = imported(file).meshes.at(0).at(0);
  EXPECT_EQ(mesh.joints.at(1), 1);
  EXPECT_EQ(mesh.joints.at(12), 300);
  EXPECT_EQ(mesh.joint_weights.at(1), 0.75F);
}

TEST_F(PackedMeshes, primitives_share_draco_data) {
  SceneFile file = draco_square();
  Json second = file.primitive();
  second["attributes"].erase("TEXCOORD_0");
  second["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("TEXCOORD_0");
  file.gltf["meshes"][0]["primitives"].push_back(second);
  const ImportedGltf got = imported(file);
  expect_square(got.meshes.at(0).at(0));
  expect_square(got.meshes.at(0).at(1));
  EXPECT_TRUE(got.meshes[0][1].uv[0].empty());
}

TEST_F(PackedMeshes, draco_vertices_count_whatever_accessors_say) {
  for (const int declared : {3, 9}) {
    SceneFile file = draco_square();
    file.gltf["accessors"][0]["count"] = file.gltf["accessors"][2]["count"] = declared;
    const ImportedGltf got = imported(file);
    expect_square(got.meshes.at(0).at(0));
    ASSERT_EQ(got.warnings.size(), 1U);
    EXPECT_NE(got.warnings[0].find("2 triangles and 4 vertices, its accessors say otherwise"), std::string::npos);
  }
}

struct Change {
  const char* pointer;  // in the JSON
  Json value;           // null: removed
  const char* message;  // a part of it
};

TEST_F(PackedMeshes, what_is_wrong_about_draco_data_is_said) {
  const std::string packed = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  const std::vector<Change> changes = {
      {"/bufferView", 9, "/bufferView: there is no buffer view 9"},
      {"/attributes", 5, "/attributes: must be an object"},
      {"/attributes/POSITION", -1, "/attributes/POSITION: -1 is out of range"},
      {"/attributes/POSITION", 1, "/attributes/POSITION: the Draco data has no attribute 1"},
      {"/attributes/POSITION", 3, "/attributes/POSITION: the Draco data has 2 numbers a vertex, the accessor has 3"},
  };
  for (const Change& change : changes) {
    SceneFile file = draco_square();
    draco_extension_of(file)[Json::json_pointer(change.pointer)] = change.value;
    const std::string message = refusal(file);
    EXPECT_TRUE(message.starts_with(packed + change.message)) << message;
  }
  SceneFile few = draco_square();
  few.gltf["accessors"][1]["count"] = 3;
  EXPECT_EQ(refusal(few), packed + ": the Draco data has 2 triangles, its accessors have 1");
  SceneFile mode = draco_square();
  mode.primitive()["mode"] = 6;
  EXPECT_EQ(refusal(mode), "/meshes/0/primitives/0/mode: Draco data holds triangles and strips alone");
  SceneFile bare = draco_square();
  bare.primitive().erase("indices");
  EXPECT_EQ(refusal(bare), "/meshes/0/primitives/0: Draco data needs an accessor of indices");
  SceneFile beside = draco_square();
  draco_extension_of(beside)["attributes"].erase("TEXCOORD_0");
  beside.gltf["accessors"][0]["count"] = beside.gltf["accessors"][2]["count"] = 5;
  EXPECT_EQ(
      refusal(beside),
      "/meshes/0/primitives/0/attributes/TEXCOORD_0: neither the Draco data nor a buffer view gives this attribute");
  SceneFile plain = square();
  plain.gltf["accessors"][1].erase("bufferView");
  EXPECT_EQ(refusal(plain), "/meshes/0/primitives/0/indices: indices need a buffer view");
}

TEST_F(PackedMeshes, damaged_draco_data_is_refused) {
  const std::string whole = draco_square_data();
  for (std::size_t length = 1; length < whole.size(); ++length)
    EXPECT_NE(refusal(draco_square(whole.substr(0, length))), "") << length;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int flip : {1, 0x80, 0xFF}) {  // an answer, whichever
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      (void)refusal(draco_square(damaged));
    }
  std::vector<std::uint8_t> indices = kIndices;
  indices[4] = 4;
  EXPECT_NE(refusal(draco_square(draco_mesh(indices, 4, square_columns()))).find("damaged"), std::string::npos);
  EXPECT_NE(refusal(draco_square(draco_square_data({.kind = 0}))).find("no mesh of triangles"), std::string::npos);
  EXPECT_NE(refusal(draco_square(draco_square_data({.method = 1}))), "");
  EXPECT_NE(refusal(draco_square(draco_square_data({.method = 2}))).find("unknown method"), std::string::npos);
}

TEST_F(PackedMeshes, draco_data_holds_no_more_than_is_allowed) {
  constexpr std::uint64_t kMany = 1400000000;
  SceneFile greedy = draco_square(draco_square_data({.faces = kMany, .points = kMany}));
  EXPECT_NE(refusal(greedy).find("triangles, its accessors have 2"), std::string::npos) << refusal(greedy);
  greedy.gltf["accessors"][0]["count"] = greedy.gltf["accessors"][2]["count"] = kMany;
  greedy.gltf["accessors"][1]["count"] = 3 * kMany;
  EXPECT_NE(refusal(greedy).find("the Draco data"), std::string::npos) << refusal(greedy);
  // Wide attributes, each small in the file.
  std::vector<DracoColumn> wide(100, {7, 4, 9, 255, ""});
  for (std::size_t i = 0; i < wide.size(); ++i) wide[i].id = static_cast<std::uint32_t>(7 + i);
  SceneFile file = draco_square(draco_mesh(kIndices, 60000, wide));
  file.gltf["accessors"][0]["count"] = file.gltf["accessors"][2]["count"] = 60000;
  EXPECT_NE(refusal(file).find("the Draco data"), std::string::npos) << refusal(file);
  set_import_memory(300);
  EXPECT_NE(refusal(draco_square()).find("--import-memory"), std::string::npos) << refusal(draco_square());
}

// meshopt -------------------------------------------------------------------------------------------------------------

SceneFile meshopt_square(const char* mode = "TRIANGLES", const char* name = "EXT_meshopt_compression") {
  SceneFile file = square();
  file.binary.clear();
  file.gltf["bufferViews"] = Json::array();
  file.gltf["accessors"] = Json::array();
  file.gltf.erase("extensions");
  file.gltf.erase("extensionsUsed");
  file.gltf["nodes"] = {{{"mesh", 0}}};
  const std::vector<std::uint32_t> indices(kIndices.begin(), kIndices.end());
  const std::size_t positions =
      add_meshopt_view(file, meshopt_attributes(bytes_of_numbers(kCorners), 4, 12), 4, 12, "ATTRIBUTES", "NONE", name);
  const bool is_list = mode == std::string_view("TRIANGLES");
  const std::size_t corners =
      add_meshopt_view(file, is_list ? meshopt_triangles(indices) : meshopt_indices(indices), 6, 2, mode, "NONE", name);
  file.primitive()["attributes"] = {{"POSITION", file.add_accessor(positions, 5126, "VEC3", 4)}};
  file.primitive()["indices"] = file.add_accessor(corners, 5123, "SCALAR", 6);
  file.gltf["extensionsRequired"] = {name};
  return file;
}

/// Every triangle's corners as positions, turned so that the least comes first: the codec may turn them.
std::vector<std::array<float, 9>> shape(const Mesh& mesh) {
  std::vector<std::array<float, 9>> triangles;
  for (auto corners : mesh.triangles) {
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    auto& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 9; ++i) triangle[i] = mesh.positions[corners[i / 3]][static_cast<int>(i % 3)];
  }
  return triangles;
}

TEST_F(PackedMeshes, meshopt_views_of_both_names_and_both_codecs_of_indices) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
      const ImportedGltf got = imported(meshopt_square(mode, name));
      const Mesh& mesh = got.meshes.at(0).at(0);
      ASSERT_EQ(mesh.positions.size(), 4U) << mode;
      EXPECT_EQ(mesh.positions[3], Point(1, 1, 0.25F));
      EXPECT_EQ(shape(mesh), shape(imported(draco_square()).meshes.at(0).at(0)));
      EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
    }
}

TEST_F(PackedMeshes, meshopt_filters_with_quantized_attributes) {
  SceneFile file = meshopt_square();
  const std::vector<float> normals = {0, 0, 1, 0, 0.6F, 0.8F, 0, 0, -0.6F, 0, 0.8F, 0, 1, 0, 0, 0};
  std::string octahedral(16, '\0'), exponential(48, '\0');
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
  meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, kCorners.data());
  const std::size_t packed =
      add_meshopt_view(file, meshopt_attributes(octahedral, 4, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
  file.primitive()["attributes"]["NORMAL"] = file.add_accessor(packed, 5120, "VEC3", 4, {{"normalized", true}});
  const std::size_t places =
      add_meshopt_view(file, meshopt_attributes(exponential, 4, 12), 4, 12, "ATTRIBUTES", "EXPONENTIAL");
  file.primitive()["attributes"]["POSITION"] = file.add_accessor(places, 5126, "VEC3", 4);
  const Mesh mesh = imported(file).meshes.at(0).at(0);
  EXPECT_LT((mesh.positions.at(3) - Point(1, 1, 0.25F)).length(), 1e-3F);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((mesh.normals.at(i) - Normal(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2])).length(), 0.02F);
}

TEST_F(PackedMeshes, meshopt_targets_skins_and_animations) {
  SceneFile file = meshopt_square();
  const auto packed_floats = [&](const std::vector<float>& values, std::size_t width, const char* type) {
    const std::size_t count = values.size() / width, stride = width * sizeof(float);
    const std::size_t view = add_meshopt_view(file, meshopt_attributes(bytes_of_numbers(values), count, stride), count,
                                              stride, "ATTRIBUTES");
    return file.add_accessor(view, 5126, type, count);
  };
  file.primitive()["targets"] = {{{"POSITION", packed_floats(std::vector<float>(12, 2.0F), 3, "VEC3")}}};
  file.primitive()["attributes"]["WEIGHTS_0"] =
      packed_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4, "VEC4");
  const std::string joints(16, '\0');
  file.primitive()["attributes"]["JOINTS_0"] =
      file.add_accessor(add_meshopt_view(file, meshopt_attributes(joints, 4, 4), 4, 4, "ATTRIBUTES"), 5121, "VEC4", 4);
  file.gltf["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "Joint"}}};
  file.gltf["scenes"][0]["nodes"] = {0, 1};
  file.gltf["skins"] = {
      {{"joints", {1}},
       {"inverseBindMatrices", packed_floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}, 16, "MAT4")}}};
  std::vector<float> turns = {0, 0, 0, 1, 0, 0.6F, 0, 0.8F};
  std::string quaternions(16, '\0');
  meshopt_encodeFilterQuat(quaternions.data(), 2, 8, 12, turns.data());
  const std::size_t view =
      add_meshopt_view(file, meshopt_attributes(quaternions, 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
  const std::size_t output = file.add_accessor(view, 5122, "VEC4", 2, {{"normalized", true}});
  file.gltf["animations"] = {{{"samplers", {{{"input", packed_floats({0, 1}, 1, "SCALAR")}, {"output", output}}}},
                              {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  const ImportedGltf got = imported(file);
  const Mesh& mesh = got.meshes.at(0).at(0);
  EXPECT_EQ(mesh.targets.at(0).positions.at(2), Imath::V3f(2, 2, 2));
  EXPECT_EQ(mesh.joint_weights.at(0), 1);
  EXPECT_EQ(got.inverse_binds.at(0).at(0)[3][0], 5);
  const std::vector<Animation> animations = import_animations(written(file));
  const AnimationChannel& channel = animations.at(0).channels.at(0);
  EXPECT_EQ(channel.times, (std::vector<float>{0, 1}));
  for (std::size_t i = 0; i < turns.size(); ++i) EXPECT_NEAR(channel.values.at(i), turns[i], 2e-3) << i;
}

TEST_F(PackedMeshes, newer_meshopt_data_gives_way_to_plain_data) {
  const std::string place = "/bufferViews/0/extensions/EXT_meshopt_compression: ";
  const std::string command = "; `gltf-transform copy IN.glb OUT.glb` writes the file uncompressed";
  SceneFile newer = meshopt_square();
  newer.binary[0] = static_cast<char>(0xA1);
  EXPECT_EQ(refusal(newer),
            place + "version 1 of the codec of ATTRIBUTES is not supported; versions below 1 are" + command);
  SceneFile filter = meshopt_square();
  filter.gltf["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["filter"] = "COLOR";
  EXPECT_EQ(refusal(filter),
            place + "filter COLOR is not supported; OCTAHEDRAL, QUATERNION and EXPONENTIAL are" + command);
  for (SceneFile* file : {&newer, &filter}) {
    const std::size_t plain = file->add_view(kCorners);
    Json& view = file->gltf["bufferViews"][0];
    view["buffer"] = 0;
    view["byteOffset"] = file->gltf["bufferViews"][plain]["byteOffset"];
    const ImportedGltf got = imported(*file);
    EXPECT_EQ(got.meshes.at(0).at(0).positions.at(3), Point(1, 1, 0.25F));
    EXPECT_EQ(got.warnings.size(), 1U);
  }
}

TEST_F(PackedMeshes, meshopt_data_that_nothing_reads_is_not_looked_at) {
  SceneFile file = meshopt_square();
  (void)add_meshopt_view(file, "nonsense", 4, 12, "ATTRIBUTES", "OCTAHEDRAL");
  EXPECT_EQ(refusal(file), "");
}

TEST_F(PackedMeshes, what_is_wrong_about_meshopt_data_is_said) {
  const std::vector<Change> changes = {
      {"/buffer", 9, "/buffer: there is no buffer 9"},
      {"/buffer", 1, "/buffer: the buffer has no data"},
      {"/byteOffset", 1U << 20, ": reaches to byte "},
      {"/byteLength", 1U << 20, ": reaches to byte "},
      {"/byteLength", 0, "/byteLength: 0 is out of range"},
      {"/byteLength", 5, ""},
      {"/byteStride", 10, "/byteStride: must be a multiple of 4"},
      {"/byteStride", 300, "/byteStride: 300 is out of range"},
      {"/byteStride", 16, "/byteStride: is 16, that of the buffer view is 12"},
      {"/count", 3, ": unpacks to 36 bytes, its buffer view has 48"},
      {"/count", 0, "/count: 0 is out of range"},
      {"/count", 4000000000U, "/count: 4000000000 elements do not fit "},
      {"/count", 70, ": the compressed data is damaged"},
      {"/mode", "TRIANGLES", "/byteStride: indices have 2 or 4 bytes"},
      {"/mode", "NONE", ": mode NONE is not supported; ATTRIBUTES, TRIANGLES and INDICES are; "},
      {"/mode", 1, "/mode: must be a string"},
      {"/filter", "OCTAHEDRAL", "/byteStride: the filter does not have this stride"},
      {"/filter", "QUATERNION", "/byteStride: the filter does not have this stride"},
  };
  for (const Change& change : changes) {
    SceneFile file = meshopt_square();
    file.other_buffers[0]["byteLength"] = 1000;
    file.gltf["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][Json::json_pointer(change.pointer)] =
        change.value;
    const std::string message = refusal(file), place = "/bufferViews/0/extensions/EXT_meshopt_compression";
    EXPECT_TRUE(message.starts_with(place + change.message)) << change.pointer << change.value << ": " << message;
  }
  SceneFile filtered = meshopt_square();
  Json& triangles = filtered.gltf["bufferViews"][1]["extensions"]["EXT_meshopt_compression"];
  triangles["filter"] = "EXPONENTIAL";
  EXPECT_NE(refusal(filtered).find("only attributes are filtered"), std::string::npos) << refusal(filtered);
  triangles["filter"] = "NONE";
  triangles["count"] = 7;
  EXPECT_NE(refusal(filtered).find("triangles have three indices"), std::string::npos) << refusal(filtered);
}

TEST_F(PackedMeshes, damaged_meshopt_data_is_refused) {
  const SceneFile whole = meshopt_square();
  for (std::size_t view = 0; view < 2; ++view) {
    const std::string key = "/bufferViews/" + std::to_string(view) + "/extensions/EXT_meshopt_compression/byteLength";
    const Json::json_pointer length(key);
    for (std::size_t bytes = 1; bytes < whole.gltf[length].get<std::size_t>(); ++bytes) {
      SceneFile file = whole;
      file.gltf[length] = bytes;
      EXPECT_NE(refusal(file), "") << view << " " << bytes;
    }
  }
  for (std::size_t i = 0; i < whole.binary.size(); ++i)
    for (const int flip : {1, 0x10, 0x80, 0xFF}) {  // an answer, whichever
      SceneFile file = whole;
      file.binary[i] = static_cast<char>(file.binary[i] ^ flip);
      (void)refusal(file);
    }
  SceneFile indices = whole;  // of vertices that are not there
  indices.gltf["bufferViews"].erase(1);
  indices.gltf["accessors"][1]["bufferView"] =
      add_meshopt_view(indices, meshopt_triangles({0, 1, 2, 2, 1, 4}), 6, 2, "TRIANGLES");
  EXPECT_NE(refusal(indices).find("but there are 4 vertices"), std::string::npos) << refusal(indices);
  set_import_memory(whole.binary.size() + 20);
  EXPECT_NE(refusal(whole).find("--import-memory"), std::string::npos) << refusal(whole);
}

}  // namespace
}  // namespace relook
