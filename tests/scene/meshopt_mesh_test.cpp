// Meshes and animations of meshopt streams: what comes out is what was put in; damage is refused with its place.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "packed_meshes.h"
#include "scene/gltf/animation.h"

namespace relook {
namespace {

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
