#include "scene/gltf/gltf_textures.h"

#include "base/error.h"
#include "scene/texture/decode_pyramid.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

/// The image that an extension names; null without it.
Json source_of(const Json& texture, std::string_view name) {
  const auto extensions = texture.find("extensions");
  if (extensions == texture.end()) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() ? Json(nullptr) : found->value("source", Json(nullptr));
}

/// Why a texture's other image is better; "" if the image can be read, as far as its header tells.
std::string webp_fault(const EncodedImage& image) {
  if (!image.bytes) return "is not there";
  if (is_animated_webp(*image.bytes)) return "is an animated WebP image";
  try {
    (void)read_image_header(*image.bytes, "", "");
  } catch (const InputError&) {
    return "cannot be read";
  }
  return "";
}

}  // namespace

void resolve_texture_sources(Json& gltf, const std::vector<EncodedImage>& images, std::vector<std::string>& warnings) {
  const auto textures = gltf.find("textures");
  if (textures == gltf.end()) return;
  std::size_t passed_over = 0;
  for (std::size_t i = 0; i < textures->size(); ++i) {
    Json& texture = (*textures)[i];
    const Json webp = source_of(texture, "EXT_texture_webp"), ktx = source_of(texture, "KHR_texture_basisu");
    bool has_source = texture.contains("source");
    if (!webp.is_null()) {
      const std::string fault = webp_fault(images[webp.get<std::size_t>()]);
      if (has_source && !fault.empty()) {
        warnings.push_back("/textures/" + std::to_string(i) + ": image " + std::to_string(webp.get<std::size_t>()) +
                           " " + fault + ": the texture's other image is read");
      } else {
        texture["source"] = webp;
        has_source = true;
      }
    }
    if (ktx.is_null()) continue;
    if (has_source)
      ++passed_over;
    else
      texture["source"] = ktx;
  }
  if (passed_over > 0)
    warnings.push_back("KHR_texture_basisu: the other images of " + std::to_string(passed_over) +
                       (passed_over == 1 ? " texture" : " textures") + " are read instead of KTX2 images");
}

}  // namespace relook
