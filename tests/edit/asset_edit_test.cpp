// Edits that bring in files beside the journal: glTF assets and images.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "edit/apply.h"
#include "look_fixture.h"
#include "refusal.h"

namespace relook {
namespace {

/// A folder with an image and a glTF file beside a journal.
class AssetFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("relook_apply_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    const std::filesystem::path spheres = std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes" / "spheres";
    std::filesystem::copy(spheres, folder_ / "spheres", std::filesystem::copy_options::recursive);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  SceneDelta apply(SceneState& state, const std::string& edit) {
    return apply_edit(state, edit_of(edit), "j.json", folder_);
  }
  std::filesystem::path folder_;
};

TEST_F(AssetFolder, an_asset_is_merged_under_its_node_with_a_prefix) {
  SceneState state = small_state();
  const std::size_t before = state.slot_counts().objects;
  const SceneDelta delta =
      apply(state,
            R"([{"op": "add", "path": "/nodes/X", "value": {"asset": "spheres/spheres.gltf", "translation": [0, 9, 0]}},
                                           {"op": "replace", "path": "/materials/X~1Glass/extensions/KHR_materials_ior/ior", "value": 2}])");
  EXPECT_FALSE(state.document().look["nodes"]["X"].contains("asset"));
  EXPECT_GT(delta.objects.size(), 3U);
  EXPECT_EQ(state.slot_counts().objects, before + delta.objects.size());
  EXPECT_EQ(state.parent_of("X/CentralSphere"), "X");
  EXPECT_EQ(look_at(state, "/materials/X~1Glass/extensions/KHR_materials_ior/ior"), 2);
  // A state compiled from the edited document is the same.
  const SceneState fresh(state.document(), state.scene().camera, state.pyramids());
  EXPECT_EQ(scene_text(fresh.scene()), scene_text(state.scene()));
}

TEST_F(AssetFolder, a_failed_edit_takes_the_asset_back) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::size_t meshes = state.document().assets->meshes.size(), images = state.document().assets->images.size();
  EXPECT_NE(message_of([&] {
              (void)apply(state, R"([{"op": "add", "path": "/nodes/X", "value": {"asset": "spheres/spheres.gltf"}},
                                     {"op": "remove", "path": "/nodes/None"}])");
            }),
            "");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(state.document().assets->meshes.size(), meshes);
  EXPECT_EQ(state.document().assets->images.size(), images);
  EXPECT_EQ(state.document().assets->mesh_primitives.size(), 4U);
}

TEST_F(AssetFolder, files_outside_the_folder_are_refused) {
  SceneState state = small_state();
  for (const char* name : {"../x.glb", "/etc/passwd", "none.glb"}) {
    const Json edit = Json::array({{{"op", "add"}, {"path", "/nodes/X"}, {"value", {{"asset", name}}}}});
    EXPECT_NE(message_of([&] { (void)apply(state, edit.dump()); }), "") << name;
    const Json image = Json::array({{{"op", "add"}, {"path", "/images/X"}, {"value", {{"uri", name}}}}});
    EXPECT_NE(message_of([&] { (void)apply(state, image.dump()); }), "") << name;
  }
}

TEST_F(AssetFolder, an_image_can_be_added_replaced_and_used) {
  std::string uri;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "spheres" / "textures"))
    if (entry.path().extension() == ".png") uri = "spheres/textures/" + entry.path().filename().string();
  ASSERT_NE(uri, "");
  SceneState state = small_state();
  const Json edit = Json::array({{{"op", "add"}, {"path", "/images/New"}, {"value", {{"uri", uri}}}},
                                 {{"op", "replace"}, {"path", "/textures/Wood/source"}, {"value", "New"}}});
  const SceneDelta delta = apply(state, edit.dump());
  ASSERT_EQ(delta.materials.size(), 2U);  // Gold and Cut
  const std::shared_ptr<const TexturePyramid> added =
      state.scene().material(delta.materials[0].id).slot(Slot::base_color).pyramid;
  EXPECT_NE(added, delta.materials[0].before.slot(Slot::base_color).pyramid);
  const Json back = Json::array({{{"op", "replace"}, {"path", "/textures/Wood/source"}, {"value", "WoodImage"}},
                                 {{"op", "replace"}, {"path", "/images/WoodImage/uri"}, {"value", uri}}});
  (void)apply(state, back.dump());
  EXPECT_EQ(state.scene().material(delta.materials[0].id).slot(Slot::base_color).pyramid, added);
}

}  // namespace
}  // namespace relook
