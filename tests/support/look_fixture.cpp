#include "look_fixture.h"

#include <cstring>
#include <map>
#include <set>

#include "base/error.h"

namespace relook {
namespace {

constexpr const char* kGltf = R"({
  "asset": {"version": "2.0"},
  "materials": [
    {"name": "Gold", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.8, 0.3, 1], "roughnessFactor": 0.5,
      "baseColorTexture": {"index": 0}}},
    {"name": "Glass", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                     "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_ior": {"ior": 1.5}}},
    {"name": "Mirror", "pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}},
    {"name": "Phong", "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}},
      "extras": {"relook": {"model": "blinn-phong", "reflection": 0.25}}},
    {"name": "Cut", "alphaMode": "MASK", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0}}}],
  "textures": [{"name": "Wood", "source": 0, "sampler": 0},
               {"name": "Marble", "extras": {"relook": {"procedural": {"kind": "marble"}}}},
               {"name": "Bumps", "source": 1}],
  "images": [{"name": "WoodImage", "uri": "wood.png"}, {"name": "BumpImage", "uri": "bumps.png"}],
  "samplers": [{"wrapS": 33071}],
  "meshes": [{"name": "Ball", "primitives": [{"material": 0, "attributes": {"POSITION": 0}}]},
             {"name": "Slab", "primitives": [{"material": 2}]},
             {"name": "Pair", "primitives": [{"material": 3}, {}]},
             {"name": "Pane", "primitives": [{"material": 1}]}],
  "cameras": [{"name": "Lens", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"name": "Bulb", "type": "point", "intensity": 30}, {"name": "Sunlight", "type": "directional"},
    {"name": "Cone", "type": "spot"}]}},
  "nodes": [
    {"name": "Group", "children": [1, 2], "translation": [1, 0, 0]},
    {"name": "Sphere", "mesh": 0, "rotation": [0, 0.6, 0, 0.8]},
    {"name": "Arm", "children": [3], "scale": [1, 2, 1]},
    {"name": "Hand", "mesh": 1, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1]},
    {"name": "Floor", "mesh": 1},
    {"name": "Window", "mesh": 3, "translation": [0, 1, 0]},
    {"name": "Both", "mesh": 2},
    {"name": "Lamp", "translation": [0, 5, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"name": "Sun", "extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"name": "Rig", "children": [10], "translation": [0, 1, 6]},
    {"name": "Eye", "camera": 0},
    {"name": "Elsewhere", "mesh": 0}],
  "scenes": [{"nodes": [0, 4, 5, 6, 7, 8, 9]}], "scene": 0
})";

std::shared_ptr<const TexturePyramid> grey_pyramid(std::uint8_t value) {
  auto pyramid = std::make_shared<TexturePyramid>();
  pyramid->levels = {{1, 1, 0}};
  pyramid->format = TexelFormat::linear8;
  pyramid->texels8 = {value, value, value, 255};
  const float linear = static_cast<float>(value) / 255.0F;
  pyramid->smallest = pyramid->largest = Rgba(linear, linear, linear, 1);
  return pyramid;
}

std::string bits(float x) {
  std::uint32_t word = 0;
  std::memcpy(&word, &x, sizeof word);
  return std::to_string(word) + " ";
}
std::string bits(const Imath::V3f& v) { return bits(v.x) + bits(v.y) + bits(v.z); }
std::string bits(const Imath::C3f& c) { return bits(c.x) + bits(c.y) + bits(c.z); }

std::string slot_text(const TextureSlot& slot) {
  std::string text = std::to_string(static_cast<int>(slot.kind)) + " " +
                     std::to_string(reinterpret_cast<std::uintptr_t>(slot.pyramid.get())) + " ";
  const Procedural& p = slot.procedural;
  text += std::to_string(static_cast<int>(p.kind)) + " " + std::to_string(p.octaves) + " " + bits(p.scale) +
          bits(p.turbulence) + bits(p.color1) + bits(p.color2);
  text +=
      std::to_string(static_cast<int>(slot.sampler.wrap_s)) + std::to_string(static_cast<int>(slot.sampler.wrap_t)) +
      std::to_string(static_cast<int>(slot.sampler.magnified)) +
      std::to_string(static_cast<int>(slot.sampler.minified)) + std::to_string(static_cast<int>(slot.sampler.levels)) +
      std::to_string(static_cast<int>(slot.mapping)) + std::to_string(slot.axis) + std::to_string(slot.texcoord) + " ";
  return text + bits(slot.offset.x) + bits(slot.offset.y) + bits(slot.scale.x) + bits(slot.scale.y) +
         bits(slot.rotation);
}

/// What Integrator::path reads of a light, objects by their keys.
std::string path_text(const Scene& scene, const Light& light) {
  std::set<std::uint64_t> excluded;
  for (const ObjectId id : light.excluded) excluded.insert(scene.object(id).key);
  std::string text = bits(light.radius) + bits(light.angle) + bits(light.right) + bits(light.up) + bits(light.rate) +
                     (light.visible ? "visible " : "") + slot_text(light.emission) + bits(light.rotation) + light.sum + " ";
  for (const std::uint64_t key : excluded) text += std::to_string(key) + " ";
  return text;
}

std::string material_text(const Material& m) {
  std::string text = m.name + " " + std::to_string(static_cast<int>(m.model)) +
                     std::to_string(static_cast<int>(m.alpha_mode)) + (m.double_sided ? "d " : "s ");
  text += bits(m.base_color.r) + bits(m.base_color.g) + bits(m.base_color.b) + bits(m.base_color.a);
  for (float x : {m.alpha_cutoff,
                  m.metallic,
                  m.roughness,
                  m.normal_scale,
                  m.occlusion_strength,
                  m.emissive_strength,
                  m.ior,
                  m.dispersion,
                  m.transmission,
                  m.thickness,
                  m.attenuation_distance,
                  m.specular,
                  m.clearcoat,
                  m.clearcoat_roughness,
                  m.clearcoat_normal_scale,
                  m.sheen_roughness,
                  m.anisotropy,
                  m.anisotropy_rotation,
                  m.iridescence,
                  m.iridescence_ior,
                  m.iridescence_minimum,
                  m.iridescence_maximum,
                  m.shininess,
                  m.reflection,
                  m.refraction,
                  m.transparency})
    text += bits(x);
  for (const Color& c : {m.emissive, m.attenuation_color, m.specular_color, m.sheen_color, m.phong_ambient,
                         m.phong_diffuse, m.phong_specular})
    text += bits(c);
  for (const TextureSlot& slot : m.slots)
    if (slot.kind != TextureKind::none) text += "[" + slot_text(slot) + "]";
  return text;
}

}  // namespace

Mesh square_mesh() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (const Point& position : mesh.positions) mesh.bounds.extendBy(position);
  return mesh;
}

ImportedGltf small_gltf() {
  ImportedGltf imported;
  imported.file = "small.gltf";
  imported.gltf = Json::parse(kGltf);
  imported.meshes = {{square_mesh()}, {square_mesh()}, {square_mesh(), square_mesh()}, {square_mesh()}};
  imported.meshes[2][1].primitive = 1;
  imported.images.resize(2);
  imported.instances.resize(imported.gltf["nodes"].size());
  imported.instances[4] = {Transform(), Transform().translate(Imath::V3f(2, 0, 0))};
  return imported;
}

std::shared_ptr<PyramidStore> small_pyramids() {
  auto pyramids = std::make_shared<PyramidStore>();
  for (bool is_color : {false, true}) {
    pyramids->put("WoodImage", is_color, grey_pyramid(200));
    pyramids->put("BumpImage", is_color, grey_pyramid(128));
  }
  return pyramids;
}

SceneState small_state(Integrator integrator) {
  LookDocument document = make_look_document(small_gltf());
  Camera camera = choose_camera(document, "Lens", 64, 48);
  camera.eye = WidePoint(0, 0, 0);  // so that places are those of the world
  return SceneState(std::move(document), std::move(camera), small_pyramids(), integrator);
}

Edit edit_of(const std::string& json_array) {
  constexpr std::array<std::string_view, 6> kNames{"add", "remove", "replace", "move", "copy", "test"};
  Edit edit;
  for (const Json& item : Json::parse(json_array)) {
    PatchOperation operation;
    const auto name = item.at("op").get<std::string>();
    for (std::size_t i = 0; i < kNames.size(); ++i)
      if (kNames[i] == name) operation.op = static_cast<PatchOp>(i);
    operation.path = item.at("path");
    operation.from = item.value("from", "");
    operation.value = item.value("value", Json());
    operation.where = "/edit/" + std::to_string(edit.size());
    operation.value_where = operation.where + "/value";
    edit.push_back(std::move(operation));
  }
  return edit;
}

SceneDelta apply_json(SceneState& state, const std::string& json_array) {
  return apply_edit(state, edit_of(json_array), "j.json", ".");
}

std::string scene_text(const Scene& scene) {
  std::set<std::string> lines;
  std::map<std::string, std::string> materials;
  for (const Object& object : scene.objects) {
    if (!object.alive) continue;
    std::string line = "object " + object.node + " " + std::to_string(object.primitive) + " " +
                       std::to_string(object.instance) + " " + std::to_string(object.key) + " mesh " +
                       std::to_string(object.mesh.index()) + " material " +
                       material_text(scene.material(object.material)) + " at ";
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) line += bits(object.to_world[row][column]);
    if (object.displacement) {
      const Displacement& d = *object.displacement;
      line += " displaced " + slot_text(d.texture) + bits(d.scale) + bits(d.midlevel) + std::to_string(d.subdivide);
    }
    lines.insert(line);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  for (LightId id : scene.light_order) {
    const Light& light = scene.light(id);
    text += "light " + light.node + " " + light.light + " " + std::to_string(static_cast<int>(light.kind)) + " " +
            bits(light.position) + bits(light.direction) + bits(light.color) + bits(light.intensity) +
            bits(light.range) + bits(light.inner_cone) + bits(light.outer_cone) + path_text(scene, light) + "\n";
  }
  const Environment& e = scene.environment;
  return text + "ambient " + bits(scene.ambient) + " environment " + bits(e.color) + bits(e.intensity) +
         bits(e.rotation) + std::to_string(reinterpret_cast<std::uintptr_t>(e.image.get())) +
         (e.background ? "background " + bits(e.background->color) + bits(e.background->intensity) : "");
}

}  // namespace relook
