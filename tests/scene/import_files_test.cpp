// Files with oddities that have one plain meaning are read, with a warning; what nothing reads may hold anything; names
// are resolved within the folders that are open.
#include <gtest/gtest.h>

#include "import_values.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

TEST_F(ImportValues, columns_that_nothing_reads_may_hold_anything) {
  const float bad = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> uv{0, 0, bad, 0, 0, 1, 1, 1};
  struct Case {
    const char* name;
    bool is_fine;
    std::function<void(SceneFile&)> change;
  };
  const auto skin = [](SceneFile& file) {
    file.primitive()["attributes"]["JOINTS_0"] =
        file.add_accessor(file.add_view(std::vector<std::uint8_t>(16)), 5121, "VEC4", 4);
    file.primitive()["attributes"]["WEIGHTS_0"] = file.floats(std::vector<float>(16, HUGE_VALF), "VEC4", 4);
  };
  const Case cases[] = {
      {"uv of a set that no texture reads", true,
       [&](SceneFile& file) { file.primitive()["attributes"]["TEXCOORD_1"] = file.floats(uv, "VEC2", 2); }},
      {"uv of the set that a texture reads", false,
       [&](SceneFile& file) { file.primitive()["attributes"]["TEXCOORD_0"] = file.floats(uv, "VEC2", 2); }},
      {"tangents", true,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
         file.primitive()["attributes"]["TANGENT"] = file.floats(std::vector<float>(16, bad), "VEC4", 4);
       }},
      {"tangents of three numbers", true,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
         file.primitive()["attributes"]["TANGENT"] = file.floats(std::vector<float>(12, 1), "VEC3", 3);
       }},
      {"normals of an unlit material", true,
       [&](SceneFile& file) {
         file.gltf["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()}};
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, bad, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
       }},
      {"normals", false,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, bad, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
       }},
      {"weights without a skin", true, skin},
      {"weights of a skin", false,
       [&](SceneFile& file) {
         skin(file);
         file.gltf["skins"] = {{{"joints", {1}}}};
         file.gltf["nodes"][0]["skin"] = 0;
       }},
      {"positions of a mesh that no node shows", true,
       [&](SceneFile& file) {
         Json primitive = {{"attributes", {{"POSITION", file.floats(std::vector<float>(9, bad), "VEC3", 3)}}}};
         file.gltf["meshes"].push_back({{"primitives", {primitive}}});
       }},
      {"indices of a mesh that no node shows: structure", false,
       [&](SceneFile& file) {
         Json primitive = file.primitive();
         primitive["indices"] = file.add_accessor(file.add_view<std::uint16_t>({0, 1, 4}), 5123, "SCALAR", 3);
         file.gltf["meshes"].push_back({{"primitives", {primitive}}});
       }},
  };
  for (const Case& one : cases) {
    SceneFile file = square();
    one.change(file);
    const Answer read = answer(file);
    EXPECT_EQ(read.error == "", one.is_fine) << one.name << ": " << read.error;
    if (!one.is_fine) continue;
    EXPECT_FALSE(read.imported.warnings.empty()) << one.name;
    EXPECT_EQ(read.imported.meshes.at(0).at(0).positions.size(), 4U) << one.name;
    set_import_rules({.is_strict = true, .roots = {}});
    EXPECT_NE(answer(file).error, "") << one.name << " --strict-gltf";
    set_import_rules({});
  }
}

TEST_F(ImportValues, roots_that_are_children_stand_below_their_parents) {
  SceneFile file = square();
  file.gltf["scenes"][0]["nodes"] = {1, 0, 0};
  const Answer read = answer(file);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.imported.warnings.size(), 2U);
  EXPECT_EQ(active_nodes(read.imported.gltf), (std::vector<std::size_t>{0, 1, 2}));
  file.gltf["scenes"][0]["nodes"] = {1};  // its parent is not shown
  EXPECT_EQ(active_nodes(answer(file).imported.gltf), (std::vector<std::size_t>{1}));
}

TEST_F(ImportValues, a_missing_image_matters_where_a_texture_that_is_shown_has_it) {
  Json gltf = text_scene();
  gltf["images"] = {{{"uri", "none.png"}}};
  gltf["textures"].push_back({{"source", 0}});
  const Answer read = answer(gltf.dump(), "inner/scene.gltf");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.imported.warnings.size(), 1U);
  EXPECT_FALSE(read.imported.gltf["textures"][1].contains("source"));
  gltf["textures"][0]["source"] = 0;
  EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error.find("/images/0/uri: no such file"), std::string::npos);
  gltf["textures"][0].erase("source");
  for (const char* uri : {"../none.png", ".", "/etc/none.png"}) {
    gltf["images"][0]["uri"] = uri;
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri << ": where it leads is structure";
  }
}

TEST_F(ImportValues, names_are_resolved_as_uris_are) {
  Json gltf = text_scene();
  for (const char* uri : {"./data.bin", "./a/../data.bin", "none/../data.bin", "a/./../data.bin"}) {
    gltf["buffers"][0]["uri"] = uri;
    EXPECT_EQ(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri;
  }
  for (const char* uri : {"../inner/../../data.bin", "a/../../data.bin", ".."}) {
    gltf["buffers"][0]["uri"] = uri;
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error.find("leads out of its folder"), std::string::npos) << uri;
  }
}

TEST_F(ImportValues, roots_open_folders_and_what_links_lead_to_within_them) {
  Json gltf = text_scene();
  fs::create_directories(folder_ / "library");
  fs::create_directories(folder_ / "elsewhere");
  for (const char* at : {"library", "elsewhere"}) fs::copy_file(folder_ / "inner/data.bin", folder_ / at / "data.bin");
  fs::create_symlink(folder_ / "library/data.bin", folder_ / "inner/linked.bin");
  fs::create_symlink(folder_ / "elsewhere/data.bin", folder_ / "library/away.bin");
  fs::create_directory_symlink(folder_ / "library", folder_ / "alias");
  const auto error_of = [&](const std::string& uri) {
    gltf["buffers"][0]["uri"] = uri;
    return answer(gltf.dump(), "inner/scene.gltf").error;
  };
  const std::string library = (folder_ / "library").string();
  for (const std::string& uri : {std::string("../library/data.bin"), library + "/data.bin", std::string("linked.bin")})
    EXPECT_NE(error_of(uri), "") << uri;
  for (const char* root : {"library", "library/", "alias", "library/../library"}) {
    set_import_rules({.is_strict = false, .roots = {folder_ / root}});
    for (const std::string& uri : {std::string("../library/data.bin"), library + "/data.bin",
                                   std::string("linked.bin"), std::string("data.bin")})
      EXPECT_EQ(error_of(uri), "") << root << " " << uri;
    for (const char* uri : {"../elsewhere/data.bin", "../library/away.bin", "../library/../elsewhere/data.bin"})
      EXPECT_NE(error_of(uri).find("--root"), std::string::npos) << root << " " << uri << ": " << error_of(uri);
  }
}

TEST_F(ImportValues, what_has_one_plain_meaning_is_read_with_a_warning) {
  const std::pair<const char*, std::function<void(Json&)>> cases[] = {
      {"the cone of a light that is no spot",
       [](Json& gltf) {
         Json& light = gltf["extensions"]["KHR_lights_punctual"]["lights"][0];
         light = {{"type", "directional"}, {"spot", {{"innerConeAngle", 3}}}};
       }},
      {"an unused light without a type",
       [](Json& gltf) { gltf["extensions"]["KHR_lights_punctual"]["lights"].push_back(Json::object()); }},
      {"an integer with a fraction",
       [](Json& gltf) { gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 0.0; }},
      {"a buffer that no view names",
       [](Json& gltf) { gltf["buffers"].push_back({{"byteLength", 9}, {"uri", "none.bin"}}); }},
      {"an unused image in bad base64",
       [](Json& gltf) { gltf["images"] = {{{"uri", "data:image/png;base64,*"}}}; }},
      {"an image whose type is not said",
       [](Json& gltf) { gltf["images"] = {{{"bufferView", 0}}}; }},
      {"an unused camera without a lens", [](Json& gltf) { gltf["cameras"].push_back({{"type", "perspective"}}); }},
  };
  for (const auto& [name, change] : cases) {
    Json gltf = text_scene();
    change(gltf);
    const Answer read = answer(gltf.dump(), "inner/scene.gltf");
    EXPECT_EQ(read.error, "") << name;
    EXPECT_EQ(read.imported.warnings.size(), 1U) << name;
    set_import_rules({.is_strict = true, .roots = {}});
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error, "") << name << " --strict-gltf";
    set_import_rules({});
  }
}

TEST_F(ImportValues, framing_of_files_is_read_as_it_is_meant) {
  const SceneFile file = square();
  EXPECT_EQ(answer(file.glb() + std::string(9, 'x')).imported.warnings.size(), 1U);
  Json gltf = text_scene();
  EXPECT_EQ(answer("\xEF\xBB\xBF" + gltf.dump(), "inner/scene.gltf").imported.warnings.size(), 1U);
  SceneFile outside = square();
  outside.binary.clear();
  outside.gltf["buffers"] = gltf["buffers"];
  EXPECT_EQ(answer(outside.glb()).error, "") << "a .glb may name files";
  gltf = {{"asset", {{"version", "2.0"}}}};
  for (const char* uri :
       {"data:application/octet-stream;base64,AQIDBA==", "data:application/octet-stream;BASE64,AQIDBA==",
        "DATA:;Base64,AQIDBA", "data:;base64,AQID%42A%3D%3D", "data:;base64,AQ\n ID\r\nBA=="}) {
    gltf["buffers"] = {{{"byteLength", 4}, {"uri", uri}}};
    EXPECT_EQ(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri;
  }
}

}  // namespace
}  // namespace relook
