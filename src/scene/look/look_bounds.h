// Where the nodes of a look document stand in the world, without compiling it: for cameras,
// automatic lights and warnings.
#pragma once
#include <functional>
#include <string>

#include "scene/compile/compile_transform.h"
#include "scene/look/look.h"

namespace relook {

/// World matrix of a node that hangs on a root, without the node's own scale: what a camera on it has.
[[nodiscard]] WideTransform unscaled_transform(const LookDocument& document, const std::string& node);

/// A primitive as a node, or an instance of it, shows it: deformed, but not displaced.
using PlacedMeshVisit = std::function<void(const std::string& node, const Mesh& mesh, const WideTransform& world)>;
/// Everything visible, by node name. Requires: check_values() passed.
void for_each_placed_mesh(const LookDocument& document, const PlacedMeshVisit& visit);

/// Every visible node with its place in the world.
void for_each_place(const LookDocument& document,
                    const std::function<void(const std::string& name, const Json& node, const WideTransform&)>& visit);

/// World bounds of everything visible; empty if there is nothing.
[[nodiscard]] WideBox world_bounds(const LookDocument& document);

}  // namespace relook
