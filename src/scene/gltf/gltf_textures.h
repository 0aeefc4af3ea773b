// The extensions that give a texture an image of another format: EXT_texture_webp and KHR_texture_basisu.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/mesh.h"

namespace relook {

inline constexpr std::array<std::string_view, 2> kTextureSources{"EXT_texture_webp", "KHR_texture_basisu"};

/// Gives every texture of a checked document the one source that is read: a WebP image rather than another, a KTX2
/// image only where there is no other (whoever decodes it says that it cannot), and the other one, with a warning,
/// where the WebP image is missing, damaged or animated. `images`: per image of the document.
void resolve_texture_sources(Json& gltf, const std::vector<EncodedImage>& images, std::vector<std::string>& warnings);

}  // namespace relook
