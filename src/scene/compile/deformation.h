// Morph targets and skins (glTF 2.0 sections 3.7.2.2 and 3.7.3), object by object. The compiler turns weights and
// joints of the look document into a Deformation (deformation_of()); trace/ray_scene.cpp bends the mesh by it
// (deformed()).
#pragma once
#include <functional>
#include <span>

#include "scene/compile/compile_transform.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace relook {

/// `mesh` morphed, then skinned, with its bounds, without targets and joints. The same bits on every machine. Triangles
/// that the joints turn inside out are wound the other way, so that their front stays outside. Coordinates end at 1e9.
/// Requires: weights.size() <= targets.size(), and joints.size() >= mesh.joint_count() unless joints is empty.
[[nodiscard]] Mesh deformed(const Mesh& mesh, const Deformation& deformation);

/// The joints of a skin as a node of it has them.
struct Pose {
  std::vector<Transform> joints;  // as in Deformation; empty: the node has no skin
  WidePoint place{0, 0, 0};       // of the object in the world: where the first joint is, whatever the node's transform
};

/// Poses `skin`, an entry of the look document that was checked. `world_of`: a joint's matrix in the world.
[[nodiscard]] Pose posed(const Json& skin, std::span<const Transform> inverse_binds,
                         const std::function<WideTransform(const std::string& node)>& world_of);

/// The morph weights of a node, or else of its mesh, as entries of the look document; null without any.
[[nodiscard]] const Json* weights_of(const Json& node, const Json& mesh);

/// The deformation of a primitive by these, of which it may have no use; none if it stays as it is. A primitive without
/// joints keeps the transform of its node.
[[nodiscard]] SharedDeformation deformation_of(const Mesh& mesh, const Json* weights, const Pose& pose);

}  // namespace relook
