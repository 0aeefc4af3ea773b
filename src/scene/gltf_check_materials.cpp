// Materials with the supported KHR_materials_* extensions, textures, samplers, images and variants.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/gltf_check.h"
#include "scene/gltf_json.h"

namespace relook {
namespace {

/// What a number or an array of numbers of a material may be.
struct FactorRule {
  std::string_view key;
  std::size_t count;  // 1: a plain number; otherwise an array of that length
  float low, high;
};
struct SlotRule {
  std::string_view key;
  std::string_view strength;  // "scale", "strength" or ""
};
struct ExtensionRules {
  std::string_view name;
  std::vector<FactorRule> factors;
  std::vector<SlotRule> slots;
};

constexpr float kUnbounded = std::numeric_limits<float>::max();

std::vector<ExtensionRules> extension_rules() {
  return {
      {"KHR_materials_ior", {{"ior", 1, 0, 10}}, {}},
      {"KHR_materials_dispersion", {{"dispersion", 1, 0, kLargestFactor}}, {}},
      {"KHR_materials_transmission", {{"transmissionFactor", 1, 0, 1}}, {{"transmissionTexture", ""}}},
      {"KHR_materials_volume",
       {{"thicknessFactor", 1, 0, kUnbounded},
        {"attenuationDistance", 1, 0, kUnbounded},
        {"attenuationColor", 3, 0, 1}},
       {{"thicknessTexture", ""}}},
      {"KHR_materials_specular",
       {{"specularFactor", 1, 0, 1}, {"specularColorFactor", 3, 0, kLargestFactor}},
       {{"specularTexture", ""}, {"specularColorTexture", ""}}},
      {"KHR_materials_clearcoat",
       {{"clearcoatFactor", 1, 0, 1}, {"clearcoatRoughnessFactor", 1, 0, 1}},
       {{"clearcoatTexture", ""}, {"clearcoatRoughnessTexture", ""}, {"clearcoatNormalTexture", "scale"}}},
      {"KHR_materials_sheen",
       {{"sheenColorFactor", 3, 0, 1}, {"sheenRoughnessFactor", 1, 0, 1}},
       {{"sheenColorTexture", ""}, {"sheenRoughnessTexture", ""}}},
      {"KHR_materials_emissive_strength", {{"emissiveStrength", 1, 0, kLargestFactor}}, {}},
      {"KHR_materials_unlit", {}, {}},
  };
}

void check_factor(const JsonView& owner, const FactorRule& rule) {
  const auto place = member(owner, rule.key);
  if (!place) return;
  if (rule.count == 1) {
    (void)place->real(rule.low, rule.high);
  } else {
    std::array<float, 4> values{};
    place->reals(std::span(values).first(rule.count), rule.low, rule.high);
  }
}

void check_texture_coordinate(const JsonView& owner) {
  const auto place = member(owner, "texCoord");
  if (place && place->integer(0, INT32_MAX) > 1)
    place->fail("texture coordinate set " + std::to_string(place->integer(0, INT32_MAX)) +
                " is not supported; 0 and 1 are");
}

void check_slot(const JsonView& root, const JsonView& owner, const SlotRule& rule) {
  const auto info = member(owner, rule.key);
  if (!info) return;
  (void)reference(info->at("index"), array_size(root, "textures"), "texture");
  check_texture_coordinate(*info);
  if (!rule.strength.empty()) {
    const bool is_strength = rule.strength == "strength";
    check_factor(*info, {rule.strength, 1, is_strength ? 0.0F : -kLargestFactor, is_strength ? 1.0F : kLargestFactor});
  }
  if (const auto transform = extension(*info, "KHR_texture_transform")) {
    check_factor(*transform, {"offset", 2, -kLargestFactor, kLargestFactor});
    check_factor(*transform, {"scale", 2, -kLargestFactor, kLargestFactor});
    check_factor(*transform, {"rotation", 1, -kLargestFactor, kLargestFactor});
    check_texture_coordinate(*transform);
  }
}

void check_material_extensions(const JsonView& root, const JsonView& material,
                               const std::vector<ExtensionRules>& all_rules) {
  for (const auto& rules : all_rules) {
    const auto object = extension(material, rules.name);
    if (!object) continue;
    for (const auto& rule : rules.factors) check_factor(*object, rule);
    for (const auto& rule : rules.slots) check_slot(root, *object, rule);
  }
  if (const auto index = extension(material, "KHR_materials_ior"); index && index->has("ior"))
    if (const float ior = index->at("ior").real(0, 10); ior != 0 && ior < 1)
      index->at("ior").fail("must be 0 or from 1 to 10");
  if (const auto volume = extension(material, "KHR_materials_volume"); volume && volume->has("attenuationDistance"))
    if (const JsonView distance = volume->at("attenuationDistance"); distance.real(0) <= 0)
      distance.fail("must be greater than 0");
}

void check_material(const JsonView& root, const JsonView& material, const std::vector<ExtensionRules>& rules) {
  if (const auto surface = member(material, "pbrMetallicRoughness")) {
    surface->require_object();
    check_factor(*surface, {"baseColorFactor", 4, 0, 1});
    check_factor(*surface, {"metallicFactor", 1, 0, 1});
    check_factor(*surface, {"roughnessFactor", 1, 0, 1});
    check_slot(root, *surface, {"baseColorTexture", ""});
    check_slot(root, *surface, {"metallicRoughnessTexture", ""});
  }
  check_slot(root, material, {"normalTexture", "scale"});
  check_slot(root, material, {"occlusionTexture", "strength"});
  check_slot(root, material, {"emissiveTexture", ""});
  check_factor(material, {"emissiveFactor", 3, 0, 1});
  check_factor(material, {"alphaCutoff", 1, 0, kUnbounded});
  static constexpr std::array<std::string_view, 3> kAlphaModes = {"OPAQUE", "MASK", "BLEND"};
  if (const auto mode = member(material, "alphaMode")) (void)mode->one_of(kAlphaModes);
  if (const auto sided = member(material, "doubleSided")) (void)sided->boolean();
  check_material_extensions(root, material, rules);
}

/// One of a few integers, if present.
template <std::size_t N>
void check_choice(const JsonView& owner, std::string_view key, const std::array<std::int64_t, N>& choices) {
  const auto place = member(owner, key);
  if (place && std::ranges::find(choices, place->integer(0, INT32_MAX)) == choices.end())
    place->fail(std::to_string(place->integer(0, INT32_MAX)) + " is not a value that glTF defines");
}

void check_sampler(const JsonView& sampler) {
  check_choice(sampler, "magFilter", std::array<std::int64_t, 2>{9728, 9729});
  check_choice(sampler, "minFilter", std::array<std::int64_t, 6>{9728, 9729, 9984, 9985, 9986, 9987});
  check_choice(sampler, "wrapS", std::array<std::int64_t, 3>{33071, 33648, 10497});
  check_choice(sampler, "wrapT", std::array<std::int64_t, 3>{33071, 33648, 10497});
}

void check_image(const JsonView& root, const JsonView& image) {
  const auto uri = member(image, "uri");
  const auto mime_type = member(image, "mimeType");
  if (uri) (void)uri->text();
  if (mime_type) (void)mime_type->text();
  const auto view = optional_reference(image, "bufferView", array_size(root, "bufferViews"), "buffer view");
  if (!view) return;
  if (uri) image.fail("has both a uri and a buffer view");
  if (!mime_type) image.fail("\"mimeType\" is missing");
  if (root.at("bufferViews").at(*view).has("byteStride"))
    image.at("bufferView").fail("the buffer view of an image may not have a byteStride");
}

}  // namespace

void check_materials(const JsonView& root) {
  const auto rules = extension_rules();
  for_each_object(root, "materials",
                  [&](const JsonView& material, std::size_t) { check_material(root, material, rules); });
  for_each_object(root, "textures", [&](const JsonView& texture, std::size_t) {
    (void)optional_reference(texture, "source", array_size(root, "images"), "image");
    (void)optional_reference(texture, "sampler", array_size(root, "samplers"), "sampler");
  });
  for_each_object(root, "samplers", [&](const JsonView& sampler, std::size_t) { check_sampler(sampler); });
  for_each_object(root, "images", [&](const JsonView& image, std::size_t) { check_image(root, image); });
  if (const auto variants = extension(root, "KHR_materials_variants"))
    for_each_object(*variants, "variants",
                    [](const JsonView& variant, std::size_t) { (void)variant.at("name").text(); });
}

}  // namespace relook
