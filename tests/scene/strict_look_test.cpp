// Whatever stands at any place of a scene file, a look document, an edit or a cache: a scene, or one sentence of ours
// with the place. Never a library's sentence, a crash or a half-compiled scene.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/error.h"
#include "image/cached_image.h"
#include "image/render.h"
#include "look_fixture.h"
#include "run_program.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

constexpr const char* kEverything = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_ior"],
  "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAA"}],
  "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}],
  "accessors": [{"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}],
  "images": [{"name": "Dot", "mimeType": "image/png", "extras": {"relook": {}}, "uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],
  "samplers": [{"name": "Near", "magFilter": 9728, "minFilter": 9729, "wrapS": 33071, "wrapT": 33648}],
  "textures": [{"name": "Picture", "source": 0, "sampler": 0},
    {"name": "Stone", "extras": {"relook": {"procedural": {"kind": "marble", "scale": 2, "turbulence": 1, "octaves": 3,
      "color1": [0, 0, 0], "color2": [1, 1, 1]}}}}],
  "materials": [{"name": "All", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
      "emissiveFactor": [0, 0, 0.5], "emissiveTexture": {"index": 0}, "occlusionTexture": {"index": 0, "strength": 0.5},
      "normalTexture": {"index": 0, "scale": 0.5, "texCoord": 1}, "pbrMetallicRoughness": {
        "baseColorFactor": [1, 0.8, 0.3, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
        "metallicRoughnessTexture": {"index": 0},
        "baseColorTexture": {"index": 1, "texCoord": 0, "extras": {"relook": {"mapping": {"kind": "planar", "axis": "x"}}},
          "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 2], "texCoord": 0}}}},
      "extensions": {"KHR_materials_ior": {"ior": 1.4},
        "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 1}},
        "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": {"index": 1}, "attenuationDistance": 2,
                                 "attenuationColor": [1, 0.5, 1]},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 1, 1],
          "specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.5,
          "clearcoatTexture": {"index": 0}, "clearcoatNormalTexture": {"index": 0, "scale": 1}},
        "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1], "sheenRoughnessFactor": 0.5,
          "sheenColorTexture": {"index": 0}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1,
          "anisotropyTexture": {"index": 0}},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 1.4,
          "iridescenceThicknessMinimum": 100, "iridescenceThicknessMaximum": 300,
          "iridescenceTexture": {"index": 0}, "iridescenceThicknessTexture": {"index": 0}},
        "KHR_materials_emissive_strength": {"emissiveStrength": 2}},
      "extras": {"relook": {"model": "blinn-phong", "ambient": [1, 1, 1], "diffuse": [1, 1, 1],
        "specular": [0.5, 0.5, 0.5], "shininess": 8, "reflection": 0.1, "refraction": 0.1, "transparency": 0.1}}},
    {"name": "Flat", "extensions": {"KHR_materials_unlit": {}}, "extras": {"relook": {}}}],
  "meshes": [{"name": "Mesh", "extras": {"relook": {}}, "primitives": [{"material": 0, "mode": 4,
    "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1},
    "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]}],
  "cameras": [{"name": "Lens", "type": "perspective",
               "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 90, "aspectRatio": 1}},
              {"name": "Plan", "type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}],
  "extensions": {"KHR_materials_variants": {"variants": [{"name": "flat"}]}, "KHR_lights_punctual": {"lights": [
    {"name": "Bulb", "type": "point", "color": [1, 1, 1], "intensity": 30, "range": 50},
    {"name": "Sunlight", "type": "directional"},
    {"name": "Cone", "type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
  "nodes": [
    {"name": "Group", "children": [1, 2], "translation": [0.1, 0, 0]},
    {"name": "Card", "mesh": 0, "rotation": [0, 0.6, 0, 0.8], "scale": [1, 2, 1], "extras": {"relook": {"displacement":
      {"texture": 1, "scale": 0.1, "midlevel": 0.5, "subdivide": 1, "texCoord": 0, "mapping": {"kind": "solid"}}}}},
    {"name": "Placed", "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1]},
    {"name": "Many", "mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}},
      "KHR_node_visibility": {"visible": true}}, "extras": {"relook": {}}},
    {"name": "Lamp", "translation": [0, 5, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"name": "Sun", "extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"name": "Spot", "extensions": {"KHR_lights_punctual": {"light": 2}}},
    {"name": "Eye", "camera": 0, "translation": [0, 0, 6]}, {"name": "Above", "camera": 1}],
  "scenes": [{"nodes": [0, 3, 4, 5, 6, 7, 8], "extras": {"relook": {"ambient": [0.1, 0.1, 0.1],
    "environment": {"color": [0.1, 0.2, 0.3], "intensity": 1, "rotation": 0.5, "image": "Dot"}}}}], "scene": 0
})";

const std::vector<Json>& wrong_values() {
  static const std::vector<Json> values{
      nullptr, true, -1, 1e300, "", "x", Json::array(), Json::array({Json::array()}), Json::object(), {{"a", 1}}};
  return values;
}
std::size_t wrong_kinds() { return wrong_values().size() + 1; }  // the last: nothing

void collect_places(const Json& value, const Json::json_pointer& at, std::vector<Json::json_pointer>& places) {
  if (!at.empty()) places.push_back(at);
  if (value.is_object())
    for (const auto& item : value.items()) collect_places(item.value(), at / item.key(), places);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) collect_places(value[i], at / i, places);
}
std::vector<Json::json_pointer> places_of(const Json& value) {
  std::vector<Json::json_pointer> places;
  collect_places(value, Json::json_pointer(), places);
  return places;
}

void set_wrong(Json& value, const Json::json_pointer& place, std::size_t kind) {
  if (kind < wrong_values().size()) {
    value[place] = wrong_values()[kind];
    return;
  }
  Json& owner = value[place.parent_pointer()];
  if (owner.is_array())
    owner.erase(std::stoul(place.back()));
  else
    owner.erase(place.back());
}

std::string case_text(const Json::json_pointer& place, std::size_t kind) {
  return place.to_string() + " = " + (kind < wrong_values().size() ? wrong_values()[kind].dump() : "nothing");
}

bool is_of_a_library(const std::string& sentence) {
  for (const char* part : {"json.exception", "::at", "_M_", "basic_string", "bad_", "std::", "stoul", "stoi"})
    if (sentence.find(part) != std::string::npos) return true;
  return false;
}

/// True if there is a scene; else the error must be ours, in the file (the whole of it where something is missing at
/// its root).
bool answers(const std::function<void()>& body, const std::string& file, const std::string& what) {
  try {
    body();
    return true;
  } catch (const InputError& error) {
    const std::string sentence = error.what();
    EXPECT_TRUE(sentence.starts_with(file + ": ")) << what << ": " << sentence;
    EXPECT_FALSE(is_of_a_library(sentence)) << what << ": " << sentence;
  } catch (const std::exception& error) {
    ADD_FAILURE() << what << ": " << error.what();
  }
  return false;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

SceneState imported(const std::filesystem::path& file) {
  LookDocument document = make_look_document(import_gltf(file));
  (void)choose_camera(document, "auto", 8, 4);
  Camera camera = choose_camera(document, "0,0,6:0,0,0:40", 8, 4);
  (void)add_auto_lights(document, camera);
  return SceneState(std::move(document), std::move(camera), nullptr);
}

class StrictLook : public testing::Test {
 protected:
  StrictLook() { write_text(file_, kEverything); }
  ScratchFolder folder_{"strict_look"};
  std::filesystem::path file_ = folder_ / "all.gltf";
};

TEST_F(StrictLook, any_value_at_any_place_of_a_scene_file_gives_a_scene_or_a_place) {
  const Json sound = Json::parse(kEverything);
  ASSERT_NO_THROW((void)imported(file_));
  std::size_t scenes = 0, errors = 0, turn = 0;
  for (const Json::json_pointer& place : places_of(sound))
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t kind = turn++ % wrong_kinds();
      Json wrong = sound;
      set_wrong(wrong, place, kind);
      write_text(file_, wrong.dump());
      ++(answers([&] { (void)imported(file_); }, file_.string(), case_text(place, kind)) ? scenes : errors);
    }
  EXPECT_GT(scenes, 100U);
  EXPECT_GT(errors, 500U);
}

TEST_F(StrictLook, any_value_at_any_place_of_a_look_document_gives_a_scene_or_a_place) {
  const SceneState state = imported(file_);
  std::size_t scenes = 0, errors = 0;
  for (const Json::json_pointer& place : places_of(state.document().look))
    for (std::size_t kind = 0; kind < wrong_kinds(); ++kind) {
      LookDocument document = state.document();
      set_wrong(document.look, place, kind);
      const auto compile = [&] { SceneState(std::move(document), state.scene().camera, state.pyramids()); };
      ++(answers(compile, file_.string(), case_text(place, kind)) ? scenes : errors);
    }
  EXPECT_GT(scenes, 100U);
  EXPECT_GT(errors, 1000U);
}

TEST_F(StrictLook, edits_of_any_place_to_any_value_leave_a_scene_or_say_a_place) {
  const Json look = imported(file_).document().look;
  std::unique_ptr<SceneState> state;
  std::size_t turn = 0;
  for (const Json::json_pointer& place : places_of(look))
    for (std::size_t i = 0; i < 3; ++i) {
      if (state == nullptr) state = std::make_unique<SceneState>(imported(file_));
      const std::size_t kind = turn++ % wrong_kinds();
      Json operation{{"op", "remove"}, {"path", place.to_string()}};
      if (kind < wrong_values().size()) operation.update({{"op", "replace"}, {"value", wrong_values()[kind]}});
      const auto edit = [&] { (void)apply_json(*state, Json::array({operation}).dump()); };
      if (answers(edit, "j.json", case_text(place, kind))) state.reset();
      if (state != nullptr) {
        EXPECT_EQ(state->document().look, look) << case_text(place, kind);
      }
    }
}

TEST_F(StrictLook, any_value_at_any_place_of_a_caches_look_document_is_damage_or_a_scene) {
  const SceneState state = imported(file_);
  const CacheContent sound = content_with_tunnels(state, {1, 2, 0}, {.tunnels = 0});
  std::size_t turn = 0, damaged = 0;
  for (const Json::json_pointer& place : places_of(sound.document.look)) {
    if (turn++ % 4 != 0) continue;  // all of them go through SceneState above
    const std::size_t kind = turn / 4 % wrong_kinds();
    CacheContent content = sound;
    set_wrong(content.document.look, place, kind);
    write_cache(folder_ / "c", content);
    OpenedCache opened;
    const CacheAnswer answer = open_cache(folder_ / "c", false, opened, nullptr);
    EXPECT_FALSE(is_of_a_library(answer.detail)) << case_text(place, kind) << ": " << answer.detail;
    if (answer.fault == CacheFault::none) continue;
    ++damaged;
    EXPECT_EQ(answer.fault, CacheFault::damaged) << case_text(place, kind);
  }
  EXPECT_GT(damaged, 50U);
}

TEST_F(StrictLook, a_caches_cameras_have_a_node_an_index_and_a_lens) {
  const SceneState state = imported(file_);
  const CacheContent sound = content_with_tunnels(state, {1, 2, 0}, {.tunnels = 0});
  const Json lens{{"node", "Eye"}, {"index", 0}, {"camera", Json::object()}};
  const std::vector<std::pair<std::string, Json>> wrong{
      {"node", 5}, {"index", "x"}, {"index", -1}, {"camera", nullptr}, {"camera", Json::array()}};
  for (const auto& [key, value] : wrong) {
    CacheContent content = sound;
    content.document.cameras["Lens"] = lens;
    content.document.cameras["Lens"][key] = value;
    write_cache(folder_ / "c", content);
    CacheContent read;
    const CacheAnswer answer = read_cache(folder_ / "c", read);
    EXPECT_EQ(answer.fault, CacheFault::damaged) << key;
    EXPECT_FALSE(is_of_a_library(answer.detail)) << answer.detail;
  }
}

TEST_F(StrictLook, textures_are_checked_before_a_material_reads_them) {
  Json gltf = Json::parse(kEverything);
  gltf["textures"][1]["extras"]["relook"]["procedural"]["color1"] = Json::array();
  write_text(file_, gltf.dump());
  EXPECT_EQ(
      message_of([&] { (void)imported(file_); }),
      file_.string() + ": /textures/Stone/extras/relook/procedural/color1: expected an array of 3 numbers, got 0");
}

}  // namespace
}  // namespace relook
