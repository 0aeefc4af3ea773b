// Meshes of Draco data: what comes out is what was put in, whatever the file has beside it; damage and greed are
// refused with their place.
#include <gtest/gtest.h>

#include "packed_meshes.h"

namespace relook {
namespace {

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

}  // namespace
}  // namespace relook
