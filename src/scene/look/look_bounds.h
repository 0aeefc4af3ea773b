// Where the nodes of a look document stand in the world, without compiling it: for cameras (camera.cpp), automatic
// lights (look_lights.cpp) and warnings (look_warnings.cpp). Requires: check_values() (look_check.h) passed.
#pragma once
#include <functional>
#include <string>

#include "scene/compile/compile_transform.h"
#include "scene/look/look.h"

namespace relook {

/// The world matrix of a node of the document, without the node's own scale: what a camera on it has.
[[nodiscard]] WideTransform unscaled_transform(const LookDocument& document, const std::string& node);

/// A primitive as a node, or an instance of it, shows it: deformed, but not displaced.
using PlacedMeshVisit = std::function<void(const std::string& node, const Mesh& mesh, const WideTransform& world)>;
/// Visits the meshes of all visible nodes, by node name.
void for_each_placed_mesh(const LookDocument& document, const PlacedMeshVisit& visit);

/// Visits every visible node with its world matrix.
void for_each_place(const LookDocument& document,
                    const std::function<void(const std::string& name, const Json& node, const WideTransform&)>& visit);

/// World bounds of everything visible; empty if there is nothing.
[[nodiscard]] WideBox world_bounds(const LookDocument& document);

}  // namespace relook
