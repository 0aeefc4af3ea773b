#include "scene/gltf/check/gltf_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/error.h"
#include "scene/gltf/gltf_json.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 24> kSupportedExtensions = {
    "KHR_lights_punctual",
    "EXT_lights_area",
    "KHR_materials_ior",
    "KHR_materials_dispersion",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_specular",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",  // converted
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_texture_webp",
    "KHR_texture_basisu",  // its images are refused where they are decoded
    "KHR_animation_pointer",  // read for journals alone
};
constexpr std::string_view kVisibilityExtension = "KHR_node_visibility";

bool is_supported(std::string_view name) {
  return name == kVisibilityExtension || std::ranges::find(kSupportedExtensions, name) != kSupportedExtensions.end();
}

/// "2.0" to {2, 0}.
std::pair<int, int> parse_version(const JsonView& place) {
  const std::string text = place.text();
  std::pair<int, int> version{0, 0};
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.first);
  if (major.ec == std::errc() && major.ptr != end && *major.ptr == '.') {
    const auto minor = std::from_chars(major.ptr + 1, end, version.second);
    if (minor.ec == std::errc() && minor.ptr == end && version.first >= 0 && version.second >= 0) return version;
  }
  place.fail("must be a version such as \"2.0\"");
}

void check_asset(const JsonView& root) {
  const JsonView asset = root.at("asset");
  const JsonView place = asset.at("version");
  const auto version = parse_version(place);
  if (version.first != 2) place.fail("glTF version \"" + place.text() + "\" is not supported; 2.0 is");
  if (const auto minimum_place = member(asset, "minVersion")) {
    const auto minimum = parse_version(*minimum_place);
    if (minimum > std::pair(2, 0))
      minimum_place->fail("glTF version \"" + minimum_place->text() + "\" is required; 2.0 is supported");
  }
}

}  // namespace

void check_asset_and_extensions(const JsonView& root, std::vector<std::string>& warnings) {
  check_asset(root);
  for_each(root, "extensionsRequired", [&](const JsonView& name, std::size_t) {
    if (!is_supported(name.text())) name.fail("required extension " + name.text() + " is not supported");
  });
  for_each(root, "extensionsUsed", [&](const JsonView& name, std::size_t) {
    if (!is_supported(name.text())) warnings.push_back("extension " + printable(name.text()) + " is ignored");
  });
  if (const auto extensions = member(root, "extensions")) extensions->require_object();
}

void check_document(const Json& gltf, std::string_view file, std::vector<std::string>& warnings) {
  const JsonView root(gltf, file);
  check_asset_and_extensions(root, warnings);
  check_data_layout(root);
  check_materials(root);
  check_meshes(root);
  check_lights(root);
  check_nodes(root);
  if (array_size(root, "animations") > 0)
    warnings.emplace_back("animations are ignored; relook journal animation makes journals of them");
}

}  // namespace relook
