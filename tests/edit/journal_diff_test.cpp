// `relook journal diff`: the original export with the step replayed is the edited export rendered, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "base/files.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSpheresFolder = std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres";

/// glTF nodes of spheres.gltf by name, and what else an export has by name.
Json& named(Json& items, const std::string& name) {
  for (Json& item : items)
    if (item.value("name", "") == name) return item;
  throw std::out_of_range(name);
}

std::size_t index_of(const Json& items, const std::string& name) {
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].value("name", "") == name) return i;
  throw std::out_of_range(name);
}

class JournalDiff : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy(kSpheresFolder, folder_ / "scene", std::filesystem::copy_options::recursive);
    const Bytes bytes = read_file(folder_ / "scene/spheres.gltf");
    original_ = parse_json(text_of(bytes), "spheres.gltf");
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void export_edited(const Json& scene) const { std::ofstream(at("scene/edited.gltf")) << scene.dump(); }
  [[nodiscard]] ProgramResult diff() const {
    return run_program(
        {RELOOK_PROGRAM, "journal", "diff", at("scene/spheres.gltf"), at("scene/edited.gltf"), "-o", at("diff.json")});
  }

  /// Edits an export, and replays the difference to the original.
  void expect_exact(const std::function<void(Json&)>& edit, bool changes_pixels = true) const {
    Json edited = original_;
    edit(edited);
    export_edited(edited);
    const ProgramResult made = diff();
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const Json report = verified_report({at("scene/spheres.gltf"), at("diff.json"), "120x68", {}}, folder_);
    ASSERT_EQ(report["steps"].size(), 2);
    EXPECT_EQ(report["steps"][1]["verify"]["pixels_different"], 0);
    EXPECT_EQ(report["steps"][1]["pixels_changed"] > 0, changes_pixels);
    const ProgramResult rendered =
        run_program({RELOOK_PROGRAM, "render", at("scene/edited.gltf"), "--integrator", "whitted", "-o",
                     at("edited.exr"), "--resolution", "120x68", "--quiet"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.output;
    const ProgramResult compared =
        run_program({RELOOK_PROGRAM, "compare", at("run/frames/0001.exr"), at("edited.exr")});
    EXPECT_EQ(compared.exit_code, 0) << compared.output << text_of(read_file(at("diff.json")));
  }
  void expect_refusal(const std::function<void(Json&)>& edit, const std::string& part) const {
    Json edited = original_;
    edit(edited);
    export_edited(edited);
    const ProgramResult made = diff();
    EXPECT_EQ(made.exit_code, 2) << made.output;
    EXPECT_NE(made.output.find(part), std::string::npos) << made.output;
    EXPECT_FALSE(std::filesystem::exists(at("diff.json")));
    EXPECT_FALSE(std::filesystem::exists(at("diff.files")));
  }

  ScratchFolder folder_{"journal_diff"};
  Json original_;
};

TEST_F(JournalDiff, materials) {
  expect_exact([](Json& scene) {
    Json& materials = scene["materials"];
    named(materials, "Paint")["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.7, 0.2, 1};
    named(materials, "Glass")["extensions"]["KHR_materials_ior"]["ior"] = 1.2;
    named(materials, "Floor").erase("normalTexture");
    named(materials, "Marble")["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
    named(materials, "Varnish").erase("extras");
    materials.push_back({{"name", "Plum"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.4, 0.1, 0.4, 1}}}}});
    named(scene["meshes"], "MirrorBall")["primitives"][0]["material"] = materials.size() - 1;
  });
}

TEST_F(JournalDiff, textures_and_images) {
  std::filesystem::copy(at("scene/textures/planks.png"), at("scene/textures/stone2.png"));
  expect_exact([](Json& scene) {
    named(scene["images"], "Stone")["uri"] = "textures/stone2.png";
    named(scene["textures"], "Marble")["extras"]["relook"]["procedural"]["scale"] = 1.0;
    scene["images"].push_back({{"name", "New/one"}, {"uri", "textures/dents.png"}});
    scene["textures"].push_back({{"name", "New"}, {"source", scene["images"].size() - 1}});
    named(scene["materials"], "Paint")["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", scene["textures"].size() - 1}, {"extras", {{"relook", {{"mapping", {{"kind", "spherical"}}}}}}}};
  });
  EXPECT_TRUE(std::filesystem::exists(at("diff.files")));
}

TEST_F(JournalDiff, lights_and_surroundings) {
  expect_exact([](Json& scene) {
    Json& lights = scene["extensions"]["KHR_lights_punctual"]["lights"];
    lights[0] = {{"name", "Lamp"}, {"type", "spot"}, {"intensity", 300}, {"spot", {{"outerConeAngle", 1.2}}}};
    lights.push_back({{"name", "Sun"}, {"type", "directional"}, {"intensity", 2}});
    scene["nodes"].push_back({{"name", "Sky"},
                              {"rotation", {-0.5, 0, 0, 0.8660254}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    scene["scenes"][0]["nodes"].push_back(scene["nodes"].size() - 1);
    named(scene["nodes"], "Lamp")["rotation"] = {-0.5, -0.3, 0.1, 0.8};
    scene["scenes"][0]["extras"]["relook"]["environment"]["color"] = {0.1, 0.2, 0.1};
  });
}

TEST_F(JournalDiff, nodes_moved_added_removed_and_given_other_parents) {
  expect_exact([](Json& scene) {
    Json &nodes = scene["nodes"], &roots = scene["scenes"][0]["nodes"];
    named(nodes, "LeftSphere")["translation"] = {-1.5, 1.4, 0.3};
    Json& cube = named(nodes, "Cube");  // a matrix in place of its parts
    cube.erase("translation");
    cube.erase("rotation");
    cube["matrix"] = {0.8, 0, 0, 0, 0, 1.2, 0, 0, 0, 0, 0.8, 0, -0.6, 0, 1.2, 1};
    nodes.push_back({{"name", "Twin"}, {"mesh", index_of(scene["meshes"], "PaintBall")}, {"translation", {1, 3, 0}}});
    roots.push_back(nodes.size() - 1);
    const std::size_t small = index_of(nodes, "SmallSphere"), pane = index_of(nodes, "Pane");
    roots.erase(std::find(roots.begin(), roots.end(), small));
    roots.erase(std::find(roots.begin(), roots.end(), pane));  // the pane is in no scene any more
    named(nodes, "Twin")["children"] = {small};
  });
}

/// The child of a removed node lives on elsewhere.
TEST_F(JournalDiff, a_child_outlives_its_parent) {
  Json &nodes = original_["nodes"], &roots = original_["scenes"][0]["nodes"];
  const std::size_t cube = index_of(nodes, "Cube"), small = index_of(nodes, "SmallSphere");
  nodes[cube]["children"] = {small};
  roots.erase(std::find(roots.begin(), roots.end(), small));
  std::ofstream(at("scene/spheres.gltf")) << original_.dump();
  expect_exact([&](Json& scene) {
    Json& edited_roots = scene["scenes"][0]["nodes"];
    *std::find(edited_roots.begin(), edited_roots.end(), cube) = small;
    scene["nodes"][cube].erase("children");
  });
}

TEST_F(JournalDiff, renamed_meshes_are_known_by_their_geometry) {
  expect_exact([](Json& scene) {
    named(scene["meshes"], "Cube")["name"] = "Box";
    named(scene["materials"], "Paint")["name"] = "Red";
    named(scene["nodes"], "CentralSphere")["translation"] = {0, 1.15, -0.5};
  });
}

/// A mesh that the original lacks, one in the place of another, points beside triangles, and a name to step round.
TEST_F(JournalDiff, new_geometry_comes_in_a_file) {
  original_["meshes"].push_back(named(original_["meshes"], "Cube"));
  original_["meshes"].back()["name"] = "geometry/Cube";
  std::ofstream(at("scene/spheres.gltf")) << original_.dump();
  expect_exact([](Json& scene) {
    Json& meshes = scene["meshes"];
    named(meshes, "Cube")["primitives"][0]["attributes"].erase("NORMAL");
    Json crate = named(meshes, "PaintBall");
    crate["name"] = "Crate";
    crate["primitives"].insert(crate["primitives"].begin(), crate["primitives"][0]);
    crate["primitives"][0]["mode"] = 0;
    crate["primitives"][1]["attributes"].erase("TEXCOORD_0");
    meshes.push_back(crate);
    scene["nodes"].push_back({{"name", "Crate"}, {"mesh", meshes.size() - 1}, {"translation", {0.6, 0.4, 1.6}}});
    scene["scenes"][0]["nodes"].push_back(scene["nodes"].size() - 1);
  });
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(at("diff.files")))
    files += entry.path().extension() == ".glb" ? 1 : 0;
  EXPECT_EQ(files, 1);
}

TEST_F(JournalDiff, equal_exports_give_an_empty_step) {
  expect_exact([](Json&) {}, false);
}

TEST_F(JournalDiff, what_no_journal_can_say_is_refused) {
  expect_refusal(
      [](Json& scene) {
        named(scene["nodes"], "Main")["translation"] = {0, 2, 6};
      },
      "camera \"Main\" is not as in");
  std::filesystem::copy(at("scene/textures/planks.png"), at("scene/textures/stone2.png"));
  expect_refusal(
      [](Json& scene) {
        named(scene["images"], "Stone")["uri"] = "textures/stone2.png";
        named(scene["nodes"], "Cube")["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 4;
      },
      "the instances of node \"Cube\" differ");
}

}  // namespace
}  // namespace relook
