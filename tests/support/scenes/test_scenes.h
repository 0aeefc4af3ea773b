// Small glTF scenes put together in memory, so that a test is four lines. The three scenes of the edit matrix give the
// same names to the same roles (nodes Ground, Ball, MirrorBall, GlassBall, Lamp; materials Ground, Matte, Mirror,
// Glass; textures Picture, Marble, Bumps), so that one edit fits all of them.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "edit/journal.h"
#include "frame/image.h"
#include "scene/compile/state.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {

/// Triangles in object space: counter-clockwise seen from outside, with unit normals and uv.
[[nodiscard]] Mesh sphere_mesh(float radius, int slices, int stacks);
[[nodiscard]] Mesh box_mesh(Point half_size);                       // flat: no normals
[[nodiscard]] Mesh plane_mesh(float half_size, int divisions);      // y = 0, facing +y, uv (0, 0) at (-x, -z)
[[nodiscard]] Mesh card_mesh(float half_width, float half_height);  // z = 0, facing +z, uv (0, 0) upper left

/// Images without a file: every texel from a function of its position.
using TexelFunction = Rgba (*)(std::uint32_t x, std::uint32_t y);
[[nodiscard]] std::shared_ptr<const TexturePyramid> single_level_image(std::uint32_t size, TexelFunction texel);

/// A glTF scene under construction. References are glTF indices, as returned.
class SceneBuilder {
 public:
  SceneBuilder();

  int image(const std::string& name, std::shared_ptr<const TexturePyramid> pyramid);
  int texture(const std::string& name, int image);
  int procedural_texture(const std::string& name, const Json& parameters);
  int material(const std::string& name, Json value);
  int mesh(const std::string& name, Mesh mesh, int material);
  /// A root node; `value` as in glTF ({"mesh": .., "translation": ..}).
  int node(const std::string& name, Json value);
  /// A light and the root node that places it, of the same name.
  void light(const std::string& name, Json light, Json placement);
  /// The same of EXT_lights_area.
  void area_light(const std::string& name, Json light, Json placement);
  void ambient(Color color);
  void environment(const Json& value);
  /// A skin of these nodes; `inverse_binds`: a matrix a joint.
  int skin(const std::string& name, const std::vector<int>& joints, std::vector<Transform> inverse_binds);
  /// A node hung below another one instead of being a root.
  void adopt(int parent, int child);
  void look_at(Point eye, Point target, float vertical_degrees, std::uint32_t width, std::uint32_t height);
  void look_orthographic(Point eye, Point target, float half_height, std::uint32_t width, std::uint32_t height);

  [[nodiscard]] SceneState state() const;
  [[nodiscard]] const Camera& camera() const { return camera_; }

 private:
  void add_light(const char* extension, const std::string& name, Json light, Json placement);

  ImportedGltf gltf_;
  std::shared_ptr<PyramidStore> pyramids_;
  Camera camera_;
};

/// (a) floor, mirror sphere, opaque sphere and a glass volume under a point light.
[[nodiscard]] SceneState spheres_scene(std::uint32_t width, std::uint32_t height);
/// (b) thin transmission, BLEND and MASK cards with textures under a spot and a directional light.
[[nodiscard]] SceneState cards_scene(std::uint32_t width, std::uint32_t height);
/// (c) clearcoat, sheen, specular, normal maps, emission, procedural textures, blinn-phong, displacement, vertex
/// colours, a negative scale and coincident duplicates.
[[nodiscard]] SceneState study_scene(std::uint32_t width, std::uint32_t height);

/// (d) not of the matrix: a ball that is morphed and, by joints Hip and Chest, skinned (node Ball), a mirror and glass
/// that are morphed (MirrorBall, GlassBall), and a morphed and displaced Post.
[[nodiscard]] SceneState puppet_scene(std::uint32_t width, std::uint32_t height);

/// (e) of the integrator `path`, not of the matrix: every kind of light, softened, linked and seen, a background of its
/// own, and beside the roles every kind of surface: see lights_scene.cpp. Its state is compiled for `path`.
[[nodiscard]] SceneState lights_scene(std::uint32_t width, std::uint32_t height);

/// (f) of the integrator `path`, not of the matrix, all opaque and without textures: a floor, balls of metal and of
/// glossy plastic under the image `sky`, or under a rectangle where that is null. `base`: the plastics' colours are
/// multiplied by it.
[[nodiscard]] SceneState still_life_scene(std::shared_ptr<const TexturePyramid> sky, float base, std::uint32_t width,
                                          std::uint32_t height);

enum class TestScene { spheres, cards, study, lights };
[[nodiscard]] SceneState test_scene(TestScene scene, std::uint32_t width, std::uint32_t height);
[[nodiscard]] const char* test_scene_name(TestScene scene);

/// The RFC 6902 operations of a JSON array.
[[nodiscard]] Edit edit_of(const Json& operations);
[[nodiscard]] Edit parsed_edit(std::string_view text);
/// One "replace".
[[nodiscard]] Edit replace_edit(const std::string& pointer, Json value);

/// A glTF file, seen by its own camera.
[[nodiscard]] SceneState scene_of_file(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height);
/// The same scene through another camera, or for another integrator.
[[nodiscard]] SceneState with_camera(const SceneState& state, const Camera& camera);
[[nodiscard]] SceneState with_integrator(const SceneState& state, Integrator integrator);
/// Compiled from scratch out of the look document as it is now, for the same integrator.
[[nodiscard]] SceneState compiled_again(const SceneState& state);
[[nodiscard]] Frame rendered(const Scene& scene, ViewOptions view);
[[nodiscard]] Image preprocessed(const Scene& scene, ViewOptions view);

/// Pixels that differ in at least one bit of one channel.
[[nodiscard]] std::vector<std::uint32_t> different_pixels(const Frame& a, const Frame& b);

}  // namespace relook
