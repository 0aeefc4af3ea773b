// KHR_materials_pbrSpecularGlossiness as metallic-roughness. KHR_materials_ior and KHR_materials_specular were made to
// hold it: with an index of 0 a dielectric's reflectance at normal incidence is the specular colour itself, f90 is 1,
// and what is not reflected is diffuse. So nothing is guessed (a metallic share would be), and both lobes keep their
// colours, texel by texel. Only the weight of the diffuse lobe differs: it follows the angle, as everywhere in
// SHADING.md.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/import_memory.h"
#include "base/json.h"
#include "scene/mesh.h"

namespace relook {

/// Rewrites the materials of a checked document that have the extension, a warning each. Glossiness, the alpha of its
/// texture, becomes roughness in images that are added to `images` and to the document. `share` takes their bytes.
/// An image that does not decode is left to who compiles the slots to report. Throws ResourceError.
void convert_specular_glossiness(Json& gltf, std::vector<EncodedImage>& images, std::string_view file,
                                 std::vector<std::string>& warnings, ImportShare& share);

}  // namespace relook
