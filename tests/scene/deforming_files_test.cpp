// Files whose meshes are morphed and skinned: how they stand, where they are wrong, and how they come into other
// scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "base/import_memory.h"
#include "edit/apply.h"
#include "gltf_writer.h"
#include "run_program.h"
#include "scene/compile/deformation.h"
#include "scene/gltf/gltf_write.h"
#include "scene/look/look_bounds.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// A square of two triangles with a target and a joint; vertex 4 of no triangle.
SceneFile bent_square() {
  SceneFile file = square();
  file.binary.clear();
  file.gltf.erase("bufferViews");
  file.gltf.erase("accessors");
  const std::size_t positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9, 1, 1, 0}, "VEC3", 3);
  const std::size_t indices = file.add_accessor(file.add_view<std::uint16_t>({0, 1, 2, 2, 1, 4}), 5123, "SCALAR", 6);
  const std::size_t target = file.floats({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5}, "VEC3", 3);
  const std::size_t joints = file.add_accessor(
      file.add_view<std::uint8_t>({0, 1, 0, 0, 1, 0, 7, 0, 0, 0, 0, 0, 9, 9, 9, 9, 1, 0, 0, 0}), 5121, "VEC4", 5);
  const std::size_t weights = file.add_accessor(
      file.add_view<std::uint8_t>({51, 153, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0}), 5121,
      "VEC4", 5, {{"normalized", true}});
  file.gltf["meshes"] = {{{"weights", {0.5}},
                          {"primitives",
                           {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                             {"indices", indices},
                             {"targets", {{{"POSITION", target}}}}}}}}};
  const std::size_t binds = file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                                        "MAT4", 16);
  file.gltf["skins"] = {{{"joints", {3, 4}}, {"inverseBindMatrices", binds}}};
  file.gltf["nodes"][0] = {{"mesh", 0}, {"skin", 0}, {"name", "Square"}, {"translation", {50, 0, 0}}};
  file.gltf["nodes"][2] = {{"name", "Rig"}, {"children", {3, 1}}};
  file.gltf["nodes"].push_back({{"name", "Root"}, {"translation", {0, 10, 0}}, {"children", {4}}});
  file.gltf["nodes"].push_back({{"name", "Tip"}, {"translation", {1, 0, 0}}});
  file.gltf["scenes"][0]["nodes"] = {0, 2};
  file.gltf.erase("extensions");
  file.gltf.erase("extensionsUsed");
  return file;
}

class DeformingFiles : public testing::Test {
 protected:
  [[nodiscard]] ImportedGltf imported(const SceneFile& file) const {
    std::ofstream(folder_ / "scene.glb", std::ios::binary) << file.glb();
    return import_gltf(folder_ / "scene.glb");
  }
  [[nodiscard]] LookDocument document_of(const SceneFile& file) const { return make_look_document(imported(file)); }
  [[nodiscard]] SceneState state_of(const SceneFile& file) const {
    LookDocument document = document_of(file);
    const Camera camera = choose_camera(document, "", 32, 32);
    return SceneState(std::move(document), camera, std::make_shared<PyramidStore>());
  }
  /// Of bent_square() after `spoil`.
  void expect_refusal(const std::string& part, const std::function<void(SceneFile&)>& spoil) const {
    SceneFile file = bent_square();
    spoil(file);
    std::string message = "accepted";
    try {
      (void)state_of(file);
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  ScratchFolder folder_{"deforming_files"};
};

TEST_F(DeformingFiles, keep_the_vertices_that_triangles_name_and_whole_weights) {
  const Mesh mesh = imported(bent_square()).meshes[0][0];
  ASSERT_EQ(mesh.positions.size(), 4U);
  ASSERT_EQ(mesh.targets.size(), 1U);
  EXPECT_EQ(mesh.targets[0].positions, (std::vector<Point>{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 5}}));
  EXPECT_EQ(mesh.joints, (std::vector<std::uint16_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}));
  EXPECT_FLOAT_EQ(mesh.joint_weights[0], 0.25F);
  EXPECT_FLOAT_EQ(mesh.joint_weights[1], 0.75F);
  EXPECT_EQ(mesh.joint_weights[8], 1);  // of no weight at all: the first joint
  EXPECT_EQ(mesh.joint_count(), 2U);
}

/// By hand: vertex 1 hangs on Tip, vertex 2 on Root. Root is at (0, 10, 0), so is Tip but for its bind at x = 1.
TEST_F(DeformingFiles, stand_as_weights_and_joints_say_whatever_the_transform_of_their_node) {
  const SceneState state = state_of(bent_square());
  EXPECT_EQ(state.document().look["nodes"]["Square"]["weights"], Json::array({0.5}));
  EXPECT_EQ(state.document().look["skins"]["skin_0"]["joints"], Json::array({"Root", "Tip"}));
  const Object& object = state.scene().objects[0];
  const Mesh mesh = deformed(state.scene().mesh(object.mesh), *object.deformation);
  const WidePoint eye = state.scene().camera.eye;
  const auto in_world = [&](std::size_t vertex) { return WidePoint(mesh.positions[vertex] * object.to_world) + eye; };
  EXPECT_LT((in_world(0) - WidePoint(0, 10, 0.5)).length(), 1e-5);
  EXPECT_LT((in_world(1) - WidePoint(1, 10, 1)).length(), 1e-5);
  EXPECT_LT((in_world(2) - WidePoint(0, 11, 1.5)).length(), 1e-5);
  const WideBox bounds = world_bounds(state.document());
  EXPECT_LT((bounds.min - WidePoint(0, 10, 0.5)).length(), 1e-5);
  EXPECT_LT((bounds.max - WidePoint(1, 11, 2.5)).length(), 1e-5);
}

TEST_F(DeformingFiles, take_weights_of_the_node_before_those_of_the_mesh_and_sparse_targets) {
  SceneFile file = bent_square();
  file.gltf["nodes"][0]["weights"] = {0.25};
  const std::size_t target = file.primitive()["targets"][0]["POSITION"];
  const std::size_t values = file.add_view<float>({0, 0, 8, 0, 0, 9}), indices = file.add_view<std::uint8_t>({1, 3});
  file.gltf["accessors"][target] = {{"componentType", 5126},
                                    {"type", "VEC3"},
                                    {"count", 5},
                                    {"sparse",
                                     {{"count", 2},
                                      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", values}}}}}};
  const SceneState state = state_of(file);
  const Mesh& mesh = state.scene().assets->meshes[0];
  EXPECT_EQ(mesh.targets[0].positions, (std::vector<Point>{{0, 0, 0}, {0, 0, 8}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ((*state.scene().objects[0].deformation).weights, std::vector<float>{0.25F});
}

TEST_F(DeformingFiles, are_refused_where_they_are_wrong) {
  expect_refusal("accepted", [](SceneFile&) {});
  expect_refusal("/skins/0/joints/1: there is no node 77", [](SceneFile& f) { f.gltf["skins"][0]["joints"][1] = 77; });
  expect_refusal("/skins/0/joints: a skin needs a joint",
                 [](SceneFile& f) { f.gltf["skins"][0]["joints"] = Json::array(); });
  expect_refusal("/skins/0/inverseBindMatrices: has 2 matrices for 3 joints",
                 [](SceneFile& f) { f.gltf["skins"][0]["joints"].push_back(2); });
  expect_refusal("/skins/0/inverseBindMatrices: matrix 0 is not finite", [](SceneFile& f) {
    f.gltf["skins"][0]["inverseBindMatrices"] = f.floats(std::vector<float>(32, NAN), "MAT4", 16);
  });
  expect_refusal("/nodes/Square/skin: the mesh names joint 1, the skin has 1 joints",
                 [](SceneFile& f) { f.gltf["skins"][0]["joints"] = {3}; });
  expect_refusal("/attributes/WEIGHTS_0: element 0 is not finite", [](SceneFile& f) {
    f.primitive()["attributes"]["WEIGHTS_0"] = f.floats(std::vector<float>(20, NAN), "VEC4", 4);
  });
  expect_refusal("/attributes/JOINTS_0: joints must be unsigned integers", [](SceneFile& f) {
    f.primitive()["attributes"]["JOINTS_0"] = f.floats(std::vector<float>(20, 0), "VEC4", 4);
  });
  expect_refusal("/targets/0/POSITION: has 2 elements, the primitive has 5 vertices", [](SceneFile& f) {
    f.primitive()["targets"][0]["POSITION"] = f.floats({0, 0, 0, 1, 1, 1}, "VEC3", 3);
  });
  expect_refusal("/nodes/0/weights/0: expected a number",
                 [](SceneFile& f) { f.gltf["nodes"][0]["weights"] = {"much"}; });
}

/// 65,535 targets of a large accessor without a buffer view: a small file that asks for gigabytes.
TEST_F(DeformingFiles, ask_for_memory_before_they_take_it) {
  SceneFile file = square();
  file.gltf["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});
  const std::size_t zeros = file.gltf["accessors"].size() - 1;
  file.primitive()["targets"] = Json(65'535, {{"POSITION", zeros}, {"NORMAL", zeros}});
  const std::vector<Mesh> meshes = imported(file).meshes.at(0);
  EXPECT_EQ(meshes[0].targets.size(), 65'535U);
  EXPECT_TRUE(meshes[0].targets[77].positions.empty());
  set_import_memory(1 << 20);
  EXPECT_THROW((void)imported(file), ResourceError);
  set_import_memory(kImportMemory);
}

TEST_F(DeformingFiles, without_a_joint_in_the_scene_lose_their_skin) {
  SceneFile file = bent_square();
  file.gltf["scenes"][0]["nodes"] = {0, 1};
  file.gltf["nodes"][2]["children"] = {3};
  const ImportedGltf gltf = imported(file);
  EXPECT_EQ(gltf.warnings.back(), "/skins/0: the scene does not show joint node 3: the skin is left out");
  const LookDocument document = document_of(file);
  EXPECT_TRUE(document.look["skins"].empty());
  EXPECT_FALSE(document.look["nodes"]["Square"].contains("skin"));
}

TEST_F(DeformingFiles, come_back_from_geometry_that_a_journal_brings) {
  const auto written_and_read = [&](const Mesh& mesh) {
    const MeshToWrite written{"Ball", 1, {&mesh}};
    write_file(folder_ / "ball.glb", glb_of(std::span(&written, 1)));
    return import_gltf(folder_ / "ball.glb").meshes.at(0).at(0);
  };
  const SceneState state = puppet_scene(16, 16);
  const Mesh once = written_and_read(state.scene().assets->meshes[1]);  // without vertices of no triangle
  const Mesh twice = written_and_read(once);
  EXPECT_EQ(once.targets.size(), 2U);
  EXPECT_EQ(once.joint_count(), 2U);
  EXPECT_EQ(once.positions, twice.positions);
  EXPECT_TRUE(once.targets == twice.targets);
  EXPECT_EQ(once.joints, twice.joints);
  EXPECT_EQ(once.joint_weights, twice.joint_weights);
}

TEST_F(DeformingFiles, with_a_skin_that_nothing_uses_load_whatever_its_matrices) {
  SceneFile file = bent_square();
  file.gltf["nodes"][0].erase("skin");
  file.gltf["skins"][0]["inverseBindMatrices"] = file.floats(std::vector<float>(32, NAN), "MAT4", 16);
  EXPECT_TRUE(document_of(file).look["skins"].empty());
}

/// An asset with a skin under a new node, and away again.
TEST_F(DeformingFiles, are_merged_with_their_skins) {
  std::ofstream(folder_ / "scene.glb", std::ios::binary) << bent_square().glb();
  SceneState state = puppet_scene(16, 16);
  const Json look = state.document().look;
  const std::string add = R"([{"op": "add", "path": "/nodes/X", "value": {"asset": "scene.glb"}}])";
  (void)apply_edit(state, parsed_edit(add), "j.json", folder_ / "");
  EXPECT_EQ(state.document().look["skins"]["X/skin_0"]["joints"], Json::array({"X/Root", "X/Tip"}));
  EXPECT_EQ(state.document().look["nodes"]["X/Square"]["skin"], "X/skin_0");
  const SceneState again = compiled_again(state);
  EXPECT_EQ(again.scene().objects.size(), state.scene().objects.size());
  (void)apply_edit(state, parsed_edit(R"([{"op": "remove", "path": "/nodes/X"}])"), "j.json", ".");
  EXPECT_EQ(state.document().look["skins"], look["skins"]);
  EXPECT_EQ(state.document().look["nodes"], look["nodes"]);
}

}  // namespace
}  // namespace relook
