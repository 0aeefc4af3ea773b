// The operation "test" takes glTF's indices where "replace" does: for every kind of reference, alone and inside values.
#include <gtest/gtest.h>

#include "edit/apply.h"
#include "look_fixture.h"
#include "refusal.h"

namespace relook {
namespace {

Json operation(const char* op, const std::string& path, const Json& value) {
  return {{"op", op}, {"path", path}, {"value", value}};
}

/// What there is to refer to besides the fixture's own: variants, a displaced node.
SceneState rich_state() {
  ImportedGltf imported = small_gltf();
  imported.gltf["extensions"]["KHR_materials_variants"] =
      Json::parse(R"({"variants": [{"name": "Day"}, {"name": "Night"}]})");
  imported.gltf["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] =
      Json::parse(R"({"mappings": [{"material": 1, "variants": [0, 1]}]})");
  LookDocument document = make_look_document(std::move(imported));
  Camera camera = choose_camera(document, "Lens", 64, 48);
  return {std::move(document), std::move(camera), small_pyramids()};
}

/// A reference and the index that means what stands there.
struct Reference {
  std::string path;
  Json index, other;
};

const std::vector<Reference> kReferences{
    {"/meshes/Ball/primitives/0/material", 0, 1},
    {"/meshes/Ball/primitives/0/extensions/KHR_materials_variants/mappings/0/material", 1, 0},
    {"/meshes/Ball/primitives/0/extensions/KHR_materials_variants/mappings/0/variants", {0, 1}, {1, 0}},
    {"/meshes/Ball/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/1", 1, 0},
    {"/materials/Gold/pbrMetallicRoughness/baseColorTexture/index", 0, 1},
    {"/textures/Wood/source", 0, 1},
    {"/textures/Wood/sampler", 0, 1},
    {"/nodes/Sphere/mesh", 0, 1},
    {"/nodes/Group/children", {1, 2}, {2, 1}},
    {"/nodes/Group/children/1", 2, 1},
    {"/nodes/Eye/camera", 0, 1},
    {"/nodes/Lamp/extensions/KHR_lights_punctual/light", 0, 1}};

TEST(TestOperation, compares_an_index_as_the_name_that_replace_would_write) {
  SceneState state = rich_state();
  for (const Reference& reference : kReferences) {
    const std::string test = Json::array({operation("test", reference.path, reference.index)}).dump();
    EXPECT_EQ(message_of([&] { (void)apply_json(state, test); }), "");
    const std::string wrong = Json::array({operation("test", reference.path, reference.other)}).dump();
    EXPECT_EQ(message_of([&] {
                (void)apply_json(state, wrong);
              }).starts_with("j.json: /edit/0/value: the test failed: " + reference.path + " is "),
              true)
        << reference.path;
    if (reference.path.starts_with("/nodes/Eye")) continue;  // the active camera's node cannot be written
    const Json before = look_at(state, reference.path);
    (void)apply_json(state, Json::array({operation("replace", reference.path, reference.index)}).dump());
    EXPECT_EQ(look_at(state, reference.path), before) << reference.path;
  }
}

TEST(TestOperation, a_displacement_refers_to_its_texture) {
  SceneState state = rich_state();
  const std::string path = "/nodes/Floor/extras/relook/displacement";
  (void)apply_json(state,
                   Json::array({operation("add", "/nodes/Floor/extras", {{"relook", Json::object()}}),
                                operation("add", path, {{"texture", 2}}), operation("test", path + "/texture", 2),
                                operation("test", path + "/texture", "Bumps")})
                       .dump());
}

/// The value at `path` with the index in place of what stands at a reference below it.
Json with_index(const SceneState& state, const std::string& path, const Reference& reference, const Json& index) {
  Json value = look_at(state, path);
  value[Json::json_pointer(reference.path.substr(path.size()))] = index;
  return value;
}

TEST(TestOperation, finds_indices_inside_whole_values) {
  SceneState state = rich_state();
  for (const Reference& reference : kReferences)
    for (std::size_t end = 0; end != std::string::npos; end = reference.path.find('/', end + 1)) {
      const std::string path = reference.path.substr(0, end);
      const Json same = with_index(state, path, reference, reference.index);
      EXPECT_EQ(message_of([&] { (void)apply_json(state, Json::array({operation("test", path, same)}).dump()); }), "")
          << path << " of " << reference.path;
      const Json other = with_index(state, path, reference, reference.other);
      EXPECT_NE(message_of([&] { (void)apply_json(state, Json::array({operation("test", path, other)}).dump()); }), "")
          << path << " of " << reference.path;
    }
}

TEST(TestOperation, an_index_that_means_nothing_is_no_name) {
  SceneState state = small_state();
  EXPECT_EQ(message_of([&] {
              (void)apply_json(state, R"([{"op": "test", "path": "/meshes/Ball/primitives/0/material", "value": 99}])");
            }),
            "j.json: /edit/0/value: the test failed: /meshes/Ball/primitives/0/material is \"Gold\"");
}

}  // namespace
}  // namespace relook
