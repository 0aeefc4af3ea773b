#include "test_scenes.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "image/render.h"
#include "scene/camera.h"
#include "scene/gltf/import.h"

namespace relook {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Box bounds_of(const std::vector<Point>& positions) {
  Box box;
  for (const Point& p : positions) box.extendBy(p);
  return box;
}

int last_index(const Json& array) { return static_cast<int>(array.size()) - 1; }

Camera camera_looking(Point eye, Point target, std::uint32_t width, std::uint32_t height) {
  Camera camera;
  camera.name = "test";
  camera.eye = WidePoint(eye);
  camera.forward = (target - eye).normalized();
  const Direction up = std::fabs(camera.forward.y) > 0.99F ? Direction(0, 0, -1) : Direction(0, 1, 0);
  camera.right = camera.forward.cross(up).normalized();
  camera.up = camera.right.cross(camera.forward);
  camera.width = width;
  camera.height = height;
  return camera;
}

}  // namespace

Mesh sphere_mesh(float radius, int slices, int stacks) {
  Mesh mesh;
  for (int row = 0; row <= stacks; ++row) {
    for (int column = 0; column <= slices; ++column) {
      const float u = static_cast<float>(column) / static_cast<float>(slices);
      const float v = static_cast<float>(row) / static_cast<float>(stacks);
      const float ring = std::sin(kPi * v);
      const Normal n(ring * std::sin(2 * kPi * u), std::cos(kPi * v), ring * std::cos(2 * kPi * u));
      mesh.normals.push_back(n.normalized());
      mesh.positions.push_back(mesh.normals.back() * radius);
      mesh.uv[0].emplace_back(u, v);
    }
  }
  const auto width = static_cast<std::uint32_t>(slices) + 1;
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(stacks); ++row) {
    for (std::uint32_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t a = row * width + column, b = a + width;
      if (row > 0) mesh.triangles.push_back({a, b, a + 1});
      if (row + 1 < static_cast<std::uint32_t>(stacks)) mesh.triangles.push_back({b, b + 1, a + 1});
    }
  }
  return mesh;
}

Mesh box_mesh(Point half) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      Point n(0, 0, 0), s(0, 0, 0);
      n[axis] = side;
      s[(axis + 1) % 3] = 1;
      const Point t = n.cross(s);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      const Point corners[4] = {n - s - t, n + s - t, n + s + t, n - s + t};
      const Uv uv[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
      for (int i = 0; i < 4; ++i) {
        mesh.positions.push_back(corners[i] * half);
        mesh.uv[0].push_back(uv[i]);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return mesh;
}

Mesh plane_mesh(float half_size, int divisions) {
  Mesh mesh;
  const auto width = static_cast<std::uint32_t>(divisions) + 1;
  for (std::uint32_t row = 0; row < width; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      const Uv uv(static_cast<float>(column) / static_cast<float>(divisions),
                  static_cast<float>(row) / static_cast<float>(divisions));
      mesh.positions.emplace_back((uv.x * 2 - 1) * half_size, 0.0F, (uv.y * 2 - 1) * half_size);
      mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
      mesh.uv[0].push_back(uv);
    }
  }
  for (std::uint32_t row = 0; row + 1 < width; ++row) {
    for (std::uint32_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t a = row * width + column, b = a + width;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

Mesh card_mesh(float half_width, float half_height) {
  Mesh mesh;
  mesh.positions = {{-half_width, half_height, 0},
                    {-half_width, -half_height, 0},
                    {half_width, -half_height, 0},
                    {half_width, half_height, 0}};
  mesh.normals.assign(4, Normal(0, 0, 1));
  mesh.uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

std::shared_ptr<const TexturePyramid> single_level_image(std::uint32_t size, TexelFunction texel) {
  auto pyramid = std::make_shared<TexturePyramid>();
  pyramid->format = TexelFormat::float32;
  pyramid->levels = {{size, size, 0}};
  pyramid->smallest = pyramid->largest = texel(0, 0);
  for (std::uint32_t y = 0; y < size; ++y) {
    for (std::uint32_t x = 0; x < size; ++x) {
      const Rgba value = texel(x, y);
      for (int channel = 0; channel < 4; ++channel) {
        pyramid->texels32.push_back(value[channel]);
        pyramid->smallest[channel] = std::min(pyramid->smallest[channel], value[channel]);
        pyramid->largest[channel] = std::max(pyramid->largest[channel], value[channel]);
      }
    }
  }
  return pyramid;
}

SceneBuilder::SceneBuilder() : pyramids_(std::make_shared<PyramidStore>()) {
  gltf_.file = "test.gltf";
  gltf_.gltf = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
  for (const char* section : {"nodes", "meshes", "materials", "textures", "images"})
    gltf_.gltf[section] = Json::array();
  gltf_.gltf["extensions"]["KHR_lights_punctual"]["lights"] = Json::array();
  look_at(Point(0, 0, 5), Point(0, 0, 0), 45, 16, 16);
}

int SceneBuilder::image(const std::string& name, std::shared_ptr<const TexturePyramid> pyramid) {
  gltf_.gltf["images"].push_back({{"name", name}, {"uri", name + ".png"}});
  gltf_.images.push_back({"", std::make_shared<const Bytes>(1)});
  pyramids_->put(name, true, pyramid);
  pyramids_->put(name, false, pyramid);
  return last_index(gltf_.gltf["images"]);
}

int SceneBuilder::texture(const std::string& name, int image) {
  gltf_.gltf["textures"].push_back({{"name", name}, {"source", image}});
  return last_index(gltf_.gltf["textures"]);
}

int SceneBuilder::procedural_texture(const std::string& name, const Json& parameters) {
  Json texture = {{"name", name}};
  texture["extras"]["relook"]["procedural"] = parameters;
  gltf_.gltf["textures"].push_back(std::move(texture));
  return last_index(gltf_.gltf["textures"]);
}

int SceneBuilder::material(const std::string& name, Json value) {
  value["name"] = name;
  gltf_.gltf["materials"].push_back(std::move(value));
  return last_index(gltf_.gltf["materials"]);
}

int SceneBuilder::mesh(const std::string& name, Mesh mesh, int material) {
  mesh.bounds = bounds_of(mesh.positions);
  for (const Rgba& color : mesh.colors) mesh.min_alpha = std::min(mesh.min_alpha, color.a);
  gltf_.meshes.push_back({std::move(mesh)});
  const Json primitive = {{"attributes", {{"POSITION", 0}}}, {"material", material}};
  gltf_.gltf["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
  return last_index(gltf_.gltf["meshes"]);
}

int SceneBuilder::node(const std::string& name, Json value) {
  value["name"] = name;
  gltf_.gltf["nodes"].push_back(std::move(value));
  gltf_.instances.emplace_back();
  const int index = last_index(gltf_.gltf["nodes"]);
  gltf_.gltf["scenes"][0]["nodes"].push_back(index);
  return index;
}

int SceneBuilder::skin(const std::string& name, const std::vector<int>& joints, std::vector<Transform> inverse_binds) {
  gltf_.gltf["skins"].push_back({{"name", name}, {"joints", joints}});
  gltf_.inverse_binds.push_back(std::move(inverse_binds));
  return last_index(gltf_.gltf["skins"]);
}

void SceneBuilder::adopt(int parent, int child) {
  Json& roots = gltf_.gltf["scenes"][0]["nodes"];
  for (std::size_t i = 0; i < roots.size(); ++i)
    if (roots[i] == child) {
      roots.erase(i);
      break;
    }
  gltf_.gltf["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(child);
}

void SceneBuilder::light(const std::string& name, Json light, Json placement) {
  add_light("KHR_lights_punctual", name, std::move(light), std::move(placement));
}
void SceneBuilder::area_light(const std::string& name, Json light, Json placement) {
  add_light("EXT_lights_area", name, std::move(light), std::move(placement));
}

void SceneBuilder::add_light(const char* extension, const std::string& name, Json light, Json placement) {
  Json& lights = gltf_.gltf["extensions"][extension]["lights"];
  light["name"] = name;
  lights.push_back(std::move(light));
  placement["extensions"][extension]["light"] = last_index(lights);
  node(name, std::move(placement));
}

void SceneBuilder::ambient(Color color) {
  gltf_.gltf["scenes"][0]["extras"]["relook"]["ambient"] = {color.x, color.y, color.z};
}
void SceneBuilder::environment(const Json& value) {
  gltf_.gltf["scenes"][0]["extras"]["relook"]["environment"] = value;
}

void SceneBuilder::look_at(Point eye, Point target, float vertical_degrees, std::uint32_t width, std::uint32_t height) {
  camera_ = camera_looking(eye, target, width, height);
  camera_.half_height = std::tan(vertical_degrees * kPi / 360.0F);
  camera_.half_width = camera_.half_height * static_cast<float>(width) / static_cast<float>(height);
}

void SceneBuilder::look_orthographic(Point eye, Point target, float half_height, std::uint32_t width,
                                     std::uint32_t height) {
  camera_ = camera_looking(eye, target, width, height);
  camera_.orthographic = true;
  camera_.half_height = half_height;
  camera_.half_width = half_height * static_cast<float>(width) / static_cast<float>(height);
}

SceneState SceneBuilder::state() const {
  ImportedGltf imported = gltf_;
  imported.gltf = Json::parse(gltf_.gltf.dump());  // numbers of the types that a file has
  return SceneState(make_look_document(std::move(imported)), camera_, pyramids_);
}

Edit edit_of(const Json& operations) {
  static constexpr std::string_view kNames[] = {"add", "remove", "replace", "move", "copy", "test"};
  Edit edit;
  for (const Json& operation : operations) {
    PatchOperation next;
    for (std::size_t i = 0; i < std::size(kNames); ++i)
      if (operation.at("op") == kNames[i]) next.op = static_cast<PatchOp>(i);
    next.path = operation.at("path").get<std::string>();
    next.from = operation.value("from", std::string());
    if (operation.contains("value")) next.value = operation.at("value");
    next.where = "/edit/" + std::to_string(edit.size());
    next.value_where = next.where + "/value";
    edit.push_back(std::move(next));
  }
  return edit;
}

Edit parsed_edit(std::string_view text) { return edit_of(Json::parse(text)); }

Edit replace_edit(const std::string& pointer, Json value) {
  PatchOperation operation;
  operation.path = pointer;
  operation.value = std::move(value);
  operation.where = "/edit/0";
  operation.value_where = "/edit/0/value";
  return {operation};
}

SceneState scene_of_file(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height) {
  LookDocument document = make_look_document(import_gltf(file));
  const Camera camera = choose_camera(document, "", width, height);
  return SceneState(std::move(document), camera, std::make_shared<PyramidStore>());
}

SceneState with_camera(const SceneState& state, const Camera& camera) {
  return SceneState(state.document(), camera, state.pyramids(), state.scene().integrator);
}

SceneState with_integrator(const SceneState& state, Integrator integrator) {
  return SceneState(state.document(), state.scene().camera, state.pyramids(), integrator);
}

SceneState compiled_again(const SceneState& state) { return with_camera(state, state.scene().camera); }

Frame rendered(const Scene& scene, ViewOptions view) {
  RenderStats stats;
  return render(scene, view, stats);
}

Image preprocessed(const Scene& scene, ViewOptions view) {
  RenderStats stats;
  return preprocess(scene, view, stats);
}

std::vector<std::uint32_t> different_pixels(const Frame& a, const Frame& b) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < std::max(a.pixels.size(), b.pixels.size()); ++i) {
    const bool both = i < a.pixels.size() && i < b.pixels.size();
    if (!both || std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(Rgba)) != 0)
      pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return pixels;
}

SceneState test_scene(TestScene scene, std::uint32_t width, std::uint32_t height) {
  if (scene == TestScene::spheres) return spheres_scene(width, height);
  if (scene == TestScene::cards) return cards_scene(width, height);
  if (scene == TestScene::lights) return lights_scene(width, height);
  return study_scene(width, height);
}

const char* test_scene_name(TestScene scene) {
  static constexpr const char* kNames[] = {"spheres", "cards", "study", "lights"};
  return kNames[static_cast<std::size_t>(scene)];
}

}  // namespace relook
