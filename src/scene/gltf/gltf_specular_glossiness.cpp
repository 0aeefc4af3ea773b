#include "scene/gltf/gltf_specular_glossiness.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/png_chunks.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

constexpr const char* kExtension = "KHR_materials_pbrSpecularGlossiness";

/// 8 bits of grey, not compressed: the same bytes whatever zlib.
Bytes grey_png(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& rows) {
  Bytes header;
  append_png_number(header, width);
  append_png_number(header, height);
  for (const int value : {8, 0, 0, 0, 0}) header.push_back(static_cast<std::byte>(value));
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes stream(size);
  const int answer = compress2(reinterpret_cast<Bytef*>(stream.data()), &size, rows.data(),
                               static_cast<uLong>(rows.size()), Z_NO_COMPRESSION);
  require(answer == Z_OK, "zlib stores into a buffer of its own bound");
  stream.resize(size);
  const BytesView signature = bytes_of(kPngSignature);
  Bytes png(signature.begin(), signature.end());
  append_png_chunk(png, "IHDR", header);
  append_png_chunk(png, "IDAT", stream);
  append_png_chunk(png, "IEND", {});
  return png;
}

/// 1 - factor * alpha as an image; none where alpha is 1 everywhere.
std::optional<Bytes> roughness_image(const TexturePyramid& glossiness, float factor) {
  if (glossiness.smallest.a >= 1) return std::nullopt;
  const TexturePyramid::Level& level = glossiness.levels.front();
  const bool is_float = glossiness.format == TexelFormat::float32;
  std::vector<unsigned char> rows;
  rows.reserve((std::size_t{level.width} + 1) * level.height);
  for (std::size_t texel = 0; texel < std::size_t{level.width} * level.height; ++texel) {
    if (texel % level.width == 0) rows.push_back(0);  // the filter of a row: none
    const std::size_t at = texel * 4 + 3;
    const float alpha = is_float ? std::min(glossiness.texels32[at], 1.0F)
                                 : static_cast<float>(glossiness.texels8[at]) / 255.0F;
    rows.push_back(static_cast<unsigned char>((1.0F - factor * alpha) * 255.0F + 0.5F));
  }
  return grey_png(level.width, level.height, rows);
}

std::string name_or(const Json& item, std::string_view noun, std::size_t index) {
  const std::string name = printable(item.value("name", ""));
  return name.empty() ? std::string(noun) + "_" + std::to_string(index) : name;
}

class Converter {
 public:
  Converter(Json& gltf, std::vector<EncodedImage>& images, std::string_view file, ImportShare& share)
      : gltf_(gltf), images_(images), file_(file), share_(share) {}

  void convert(Json& material) {
    Json& extensions = material["extensions"];
    const Json old = std::move(extensions[kExtension]);
    extensions.erase(kExtension);
    if (extensions.contains("KHR_materials_unlit")) return;  // its base colour is the file's own
    Json specular = {{"specularFactor", 1.0}, {"specularColorFactor", old.value("specularFactor", Json({1, 1, 1}))}};
    Json surface = {{"baseColorFactor", old.value("diffuseFactor", Json({1, 1, 1, 1}))}, {"metallicFactor", 0.0}};
    if (old.contains("diffuseTexture")) surface["baseColorTexture"] = old["diffuseTexture"];
    const auto glossiness = old.value("glossinessFactor", 1.0F);
    surface["roughnessFactor"] = 1.0F - glossiness;
    if (old.contains("specularGlossinessTexture")) {
      Json texture = old["specularGlossinessTexture"];
      specular["specularColorTexture"] = texture;
      if (const auto index = roughness_texture(texture["index"].get<std::size_t>(), glossiness)) {
        texture["index"] = *index;
        surface["metallicRoughnessTexture"] = std::move(texture);
        surface["roughnessFactor"] = 1.0;
      }
    }
    material["pbrMetallicRoughness"] = std::move(surface);
    extensions["KHR_materials_specular"] = std::move(specular);
    extensions["KHR_materials_ior"] = {{"ior", 0.0}};
  }

 private:
  using Source = std::pair<std::size_t, float>;  // index, glossiness factor

  /// The texture of the roughness that a glossiness texture makes; none where the roughness is the same everywhere.
  std::optional<std::size_t> roughness_texture(std::size_t texture, float factor) {
    const Json old = gltf_["textures"][texture];
    if (!old.contains("source") || factor == 0) return std::nullopt;
    const auto [known, is_new] = textures_.try_emplace({texture, factor});
    if (!is_new) return known->second;
    const auto image = roughness_image_of(old["source"].get<std::size_t>(), factor);
    if (!image) return std::nullopt;
    Json added = {{"name", name_or(old, "texture", texture) + " roughness"}, {"source", *image}};
    if (old.contains("sampler")) added["sampler"] = old["sampler"];
    known->second = gltf_["textures"].size();
    gltf_["textures"].push_back(std::move(added));
    return known->second;
  }

  std::optional<std::size_t> roughness_image_of(std::size_t source, float factor) {
    if (without_alpha_.contains(source)) return std::nullopt;
    const auto [known, is_new] = made_.try_emplace({source, factor});
    if (!is_new) return known->second;
    std::optional<Bytes> png = png_of(source, factor);
    if (!png) {
      without_alpha_.insert(source);
      return std::nullopt;
    }
    share_.add(ImportShare(png->size(), file_, place_of(source) + ": its roughness"));
    gltf_["images"].push_back({{"name", name_or(gltf_["images"][source], "image", source) + " roughness"}});
    images_.push_back({"", std::make_shared<const Bytes>(std::move(*png))});
    known->second = images_.size() - 1;
    return known->second;
  }

  std::optional<Bytes> png_of(std::size_t source, float factor) {
    if (images_[source].bytes == nullptr) return std::nullopt;
    try {
      return roughness_image(*decode_pyramid(*images_[source].bytes, false, file_, place_of(source)), factor);
    } catch (const InputError&) {
      return std::nullopt;
    }
  }
  static std::string place_of(std::size_t image) { return "/images/" + std::to_string(image); }

  Json& gltf_;
  std::vector<EncodedImage>& images_;
  std::string_view file_;
  ImportShare& share_;
  std::map<Source, std::optional<std::size_t>> textures_, made_;  // by texture, by image
  std::set<std::size_t> without_alpha_;                           // images; decoded once, whatever the factors
};

}  // namespace

void convert_specular_glossiness(Json& gltf, std::vector<EncodedImage>& images, std::string_view file,
                                 std::vector<std::string>& warnings, ImportShare& share) {
  const auto materials = gltf.find("materials");
  if (materials == gltf.end()) return;
  Converter converter(gltf, images, file, share);
  for (std::size_t i = 0; i < materials->size(); ++i) {
    Json& material = (*materials)[i];
    if (!material.contains("extensions") || !material["extensions"].contains(kExtension)) continue;
    converter.convert(material);
    warnings.push_back("material \"" + name_or(material, "material", i) + "\": " + kExtension +
                       " is converted to metallic-roughness, with its colours in KHR_materials_specular and ior 0");
  }
}

}  // namespace relook
