// An object ready for rays: what intersection, surface points and spawning need of it, derived from Scene; and its
// maker, which derives each shape once. Called by RayScene.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scene/compile/tangents.h"
#include "scene/scene.h"
#include "scene/surface_optics.h"

namespace relook {

/// One object, ready for rays.
struct RayObject {
  std::shared_ptr<const Mesh> mesh;                               // deformed, displaced, flattened if the object is
  std::array<std::shared_ptr<const CornerTangents>, 2> tangents;  // by uv set: derived where a map or brush needs them
  std::shared_ptr<const Material> material;  // the values that bend and cut rays, as of this state of the scene
  MaterialId material_id;
  Transform to_world;
  Imath::M33f normal_to_world;  // inverse transpose of the linear part, not normalised
  float condition = 1;          // of the linear part: how much it stretches rounding errors, at least 1
  float offset = 0;             // metres along the normal that clear a hit of rounding errors
  bool flipped = false;         // negative determinant: counter-clockwise triangles are back faces
  bool alive = false;
  bool blurs = false;           // under Integrator::path, what goes through is scattered by a lobe (scene/surface_optics.h)
  bool turns = false;           // likewise, rays through it count as bent or blurred: segments do not stand for them
  std::uint64_t key = 0;  // orders coincident hits, the same whatever the history of edits
  SurfaceOptics optics;
};

/// Makes the entries of objects. What several need, a deformed mesh or its tangents, is made once, while one uses it.
class RayObjectMaker {
 public:
  explicit RayObjectMaker(Integrator integrator) : integrator_(integrator) {}
  /// `material`: of the object, as it is to be.
  [[nodiscard]] RayObject make(const Scene& scene, const Object& object, std::shared_ptr<const Material> material);
  void set_material(RayObject& object, std::shared_ptr<const Material> material);
  /// Forgets derived tangents that no object uses any more; make() forgets shapes of the mesh that it is asked for.
  void drop_unused();

 private:
  struct Shaped {
    SharedDeformation deformation;
    std::optional<Displacement> displacement;
    std::optional<Transform> sheet;  // flattened by it
    std::weak_ptr<const Mesh> result;
  };
  struct Derived {
    std::weak_ptr<const Mesh> mesh;  // expired: the address may belong to another mesh by now
    std::weak_ptr<const CornerTangents> result;
  };

  [[nodiscard]] std::shared_ptr<const Mesh> mesh_of(const Scene& scene, const Object& object,
                                                    const std::optional<Transform>& sheet);
  [[nodiscard]] std::shared_ptr<const CornerTangents> tangents_of(const std::shared_ptr<const Mesh>& mesh,
                                                                  std::uint8_t texcoord);

  Integrator integrator_;
  std::map<MeshId, std::vector<Shaped>> shaped_;
  std::map<std::pair<const Mesh*, std::uint8_t>, Derived> derived_;  // by mesh and uv set
};

}  // namespace relook
