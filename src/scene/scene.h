// The scene, compiled from a look document (compile/state.h): tables of plain values, ready for rays and colour
// programs. Ids are slots that are never reused for something else within a run; nothing that reaches a pixel may
// depend on their order: use the keys.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/id.h"
#include "base/math.h"
#include "scene/camera.h"
#include "scene/integrator.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace relook {

/// A displacement map of a node (extras.relook.displacement): vertices move along their normals by
/// scale * (red - midlevel), after `subdivide` rounds of 1-to-4 subdivision.
struct Displacement {
  TextureSlot texture;
  float scale = 0;         // object-space units
  float midlevel = 0.5F;
  std::int32_t subdivide = 0;  // 0..6
  bool operator==(const Displacement&) const = default;
};

/// The morph weights and joints that bend a mesh (compile/deformation.h).
struct Deformation {
  std::vector<float> weights;     // of the mesh's targets, in their order; empty: none adds anything
  std::vector<Transform> joints;  // inverse bind matrix, then the joint's place from the object's; empty: no skin
  bool operator==(const Deformation&) const = default;
};

/// A deformation shared by the copies of an object, compared by value; none: the mesh stays as it is.
struct SharedDeformation {
  std::shared_ptr<const Deformation> value;
  explicit operator bool() const { return value != nullptr; }
  const Deformation& operator*() const { return *value; }
  bool operator==(const SharedDeformation& other) const {
    return value == other.value || (value && other.value && *value == *other.value);
  }
};

/// One glTF primitive placed by one node (or one instance of it): what a ray path names.
struct Object {
  std::string node;            // look-document name of the node
  std::uint32_t primitive = 0, instance = 0;
  std::uint64_t key = 0;       // hash of (node, primitive, instance): orders coincident hits, the same in every run
  bool alive = true;           // false: deleted or hidden
  MeshId mesh;                 // geometry as imported
  MaterialId material;
  Transform to_world;          // affine, row vectors; from the camera's eye
  SharedDeformation deformation;            // before displacement
  std::optional<Displacement> displacement;
  bool operator==(const Object&) const = default;
};

/// What the camera sees instead of the environment, directly and through what does not bend its rays.
struct Background {
  Color color{0, 0, 0};        // multiplies the image, if there is one
  float intensity = 1;
  float rotation = 0;          // radians about +y
  std::shared_ptr<const TexturePyramid> image;  // as the environment's
  bool operator==(const Background&) const = default;
};

/// What rays that miss everything see (extras.relook of the scene). Under Integrator::path it lights everything.
struct Environment {
  Color color{0, 0, 0};        // multiplies the image, if there is one
  float intensity = 1;
  float rotation = 0;          // radians about +y
  std::shared_ptr<const TexturePyramid> image;  // lat-long, +y up, -z in the middle
  std::optional<Background> background;         // none: the camera sees the environment; none under whitted
  bool operator==(const Environment&) const = default;
};

struct Scene {
  Integrator integrator = Integrator::whitted;
  std::shared_ptr<const Assets> assets;
  Camera camera;
  std::vector<Material> materials;  // indexed by MaterialId; the default material stands behind the first document's
  std::vector<Object> objects;      // indexed by ObjectId
  std::vector<Light> lights;        // indexed by LightId
  // Living lights: the order of every sum over lights. By node name; under Integrator::path then the suns, then the
  // emission of materials by their names.
  std::vector<LightId> light_order;
  Color ambient{0, 0, 0};
  Environment environment;

  [[nodiscard]] const Object& object(ObjectId id) const { return objects[id.index()]; }
  [[nodiscard]] const Material& material(MaterialId id) const { return materials[id.index()]; }
  [[nodiscard]] const Light& light(LightId id) const { return lights[id.index()]; }
  [[nodiscard]] const Mesh& mesh(MeshId id) const { return assets->meshes[id.index()]; }
};

/// What one edit changed, with the values before it; the scene has those after it. Entities whose compiled value did
/// not change do not appear. An object or light that did not live before has before.alive == false.
struct SceneDelta {
  struct MaterialChange { MaterialId id; Material before; };
  struct ObjectChange { ObjectId id; Object before; };
  struct LightChange { LightId id; Light before; };
  std::vector<MaterialChange> materials;
  std::vector<ObjectChange> objects;
  std::vector<LightChange> lights;
  std::optional<Color> ambient_before;
  std::optional<Environment> environment_before;

  [[nodiscard]] bool empty() const {
    return materials.empty() && objects.empty() && lights.empty() && !ambient_before && !environment_before;
  }
};

}  // namespace relook
