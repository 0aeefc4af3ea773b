// Checks of a glTF document's structure before any parser or decoder trusts it (glTF 2.0 sections 3 and 5): every
// reference, count and byte range sound, the nodes a forest; of used and unused things alike. What values say is for
// gltf_values.h. Animations are checked where they are read for journals (gltf_animation.cpp); what relook does not
// read (min and max of accessors) is not checked.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"

namespace relook {

/// Throws InputError{file, pointer, ...}. Appends sentences about what will be ignored.
void check_document(const Json& gltf, std::string_view file, std::vector<std::string>& warnings);

/// Parts of check_document().
void check_asset_and_extensions(const JsonView& root, std::vector<std::string>& warnings);
void check_data_layout(const JsonView& root);  // buffers, bufferViews, accessors
void check_meshes(const JsonView& root);
void check_nodes(const JsonView& root);      // nodes, scenes, cameras
void check_materials(const JsonView& root);  // materials, textures, samplers, images, variants
void check_lights(const JsonView& root);
void check_meshopt_view(const JsonView& root, const JsonView& view);
void check_draco_primitive(const JsonView& root, const JsonView& primitive);

/// Per accessor: whether a primitive has it from Draco data, so that it needs no buffer view.
[[nodiscard]] std::vector<bool> accessors_of_draco(const JsonView& root);

}  // namespace relook
