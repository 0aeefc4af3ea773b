#include "scene/compile/compile_material.h"

#include <set>

#include "base/parallel.h"
#include "scene/look/look_schema.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

struct SlotPlace {
  Slot slot;
  std::string_view group, owner;  // keys on the way down, empty: none
  std::string_view key;
};
constexpr std::array<SlotPlace, kSlotCount> kSlotPlaces{{
    {Slot::base_color, "", "pbrMetallicRoughness", "baseColorTexture"},
    {Slot::metallic_roughness, "", "pbrMetallicRoughness", "metallicRoughnessTexture"},
    {Slot::normal, "", "", "normalTexture"},
    {Slot::occlusion, "", "", "occlusionTexture"},
    {Slot::emissive, "", "", "emissiveTexture"},
    {Slot::transmission, "extensions", "KHR_materials_transmission", "transmissionTexture"},
    {Slot::thickness, "extensions", "KHR_materials_volume", "thicknessTexture"},
    {Slot::specular, "extensions", "KHR_materials_specular", "specularTexture"},
    {Slot::specular_color, "extensions", "KHR_materials_specular", "specularColorTexture"},
    {Slot::clearcoat, "extensions", "KHR_materials_clearcoat", "clearcoatTexture"},
    {Slot::clearcoat_roughness, "extensions", "KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
    {Slot::clearcoat_normal, "extensions", "KHR_materials_clearcoat", "clearcoatNormalTexture"},
    {Slot::sheen_color, "extensions", "KHR_materials_sheen", "sheenColorTexture"},
    {Slot::sheen_roughness, "extensions", "KHR_materials_sheen", "sheenRoughnessTexture"},
    {Slot::anisotropy, "extensions", "KHR_materials_anisotropy", "anisotropyTexture"},
    {Slot::iridescence, "extensions", "KHR_materials_iridescence", "iridescenceTexture"},
    {Slot::iridescence_thickness, "extensions", "KHR_materials_iridescence", "iridescenceThicknessTexture"},
}};

const Json* slot_info(const Json& material, const SlotPlace& place) {
  if (place.owner.empty()) return member_at(material, {place.key});
  if (place.group.empty()) return member_at(material, {place.owner, place.key});
  return member_at(material, {place.group, place.owner, place.key});
}

std::string pointer_to(const SlotPlace& place) {
  std::string pointer;
  for (std::string_view key : {place.group, place.owner, place.key})
    if (!key.empty()) pointer += "/" + std::string(key);
  return pointer;
}

/// The enumerator of `Enum` whose word in `words` is the value's.
template <class Enum, std::size_t Count>
Enum enum_of(const Json& value, const std::array<std::string_view, Count>& words) {
  const auto& word = value.get_ref<const std::string&>();
  std::size_t i = 0;
  while (i < Count && words[i] != word) ++i;
  require(i < Count, "a choice that passed the schema has an enumerator");
  return static_cast<Enum>(i);
}

Wrap wrap_of(const Json& sampler, std::string_view key) {
  switch (sampler.value(std::string(key), 10497)) {
    case 33071:
      return Wrap::clamp;
    case 33648:
      return Wrap::mirror;
    default:
      return Wrap::repeat;
  }
}

/// glTF 2.0, 5.26: what a minFilter takes of a level, and which levels. Without one, what we like best.
void set_filters(const Json& sampler, TextureSampler& filters) {
  if (sampler.value("magFilter", 9729) == 9728) filters.magnified = TexelFilter::nearest;
  const int minified = sampler.value("minFilter", 9987);
  if (minified == 9728 || minified == 9984 || minified == 9986) filters.minified = TexelFilter::nearest;
  if (minified == 9728 || minified == 9729) filters.levels = LevelFilter::full;
  if (minified == 9984 || minified == 9985) filters.levels = LevelFilter::nearest;
}

void set_procedural(const Json& value, TextureSlot& slot) {
  constexpr std::array<std::string_view, 4> kKinds{"marble", "wood", "checker", "noise"};
  slot.kind = TextureKind::procedural;
  Procedural& procedural = slot.procedural;
  procedural.kind = enum_of<ProceduralKind>(value["kind"], kKinds);
  procedural.scale = float_of(value["scale"]);
  procedural.turbulence = float_of(value["turbulence"]);
  procedural.octaves = value["octaves"].get<std::int32_t>();
  procedural.color1 = color_of(value["color1"]);
  procedural.color2 = color_of(value["color2"]);
}

std::shared_ptr<const TexturePyramid> pyramid_of(const CompileContext& context, const std::string& image, bool is_color,
                                                 const std::string& pointer) {
  const Json& value = context.document.look["images"][image];
  const std::string& content = value["extras"]["relook"]["content"].get_ref<const std::string&>();
  if (!context.document.assets->images.contains(content))
    throw LookError(context.file, "/images/" + escape_token(image),
                    "this image has no bytes (unknown content \"" + content + "\")");
  const auto& bytes = context.document.assets->images.at(content).bytes;
  if (bytes && is_ktx2(*bytes))
    throw LookError(context.file, "/images/" + escape_token(image), std::string(kNoKtxImages));
  return context.pyramids.get(*context.document.assets, content, is_color, context.file, pointer);
}

void set_texture(const CompileContext& context, const std::string& name, bool is_color, TextureSlot& slot,
                 const std::string& pointer) {
  const Json& texture = context.document.look["textures"][name];
  if (const Json* procedural = member_at(texture, {"extras", "relook", "procedural"})) {
    set_procedural(*procedural, slot);
  } else if (texture.contains("source")) {
    slot.kind = TextureKind::image;
    slot.pyramid = pyramid_of(context, texture["source"], is_color, pointer);
  } else {
    return;
  }
  if (!texture.contains("sampler") || slot.kind == TextureKind::procedural) return;
  const Json& sampler = context.document.look["samplers"][texture["sampler"].get_ref<const std::string&>()];
  slot.sampler.wrap_s = wrap_of(sampler, "wrapS");
  slot.sampler.wrap_t = wrap_of(sampler, "wrapT");
  set_filters(sampler, slot.sampler);
}

void set_mapping(const Json& mapping, TextureSlot& slot) {
  constexpr std::array<std::string_view, 5> kKinds{"uv", "planar", "spherical", "cylindrical", "solid"};
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  slot.mapping = enum_of<Mapping>(mapping["kind"], kKinds);
  slot.axis = enum_of<std::uint8_t>(mapping["axis"], kAxes);
}

/// texCoord and KHR_texture_transform.
void set_coordinates(const Json& info, TextureSlot& slot) {
  slot.texcoord = info["texCoord"].get<std::uint8_t>();
  const Json& transform = info["extensions"]["KHR_texture_transform"];
  slot.offset = {float_of(transform["offset"][0]), float_of(transform["offset"][1])};
  slot.scale = {float_of(transform["scale"][0]), float_of(transform["scale"][1])};
  slot.rotation = float_of(transform["rotation"]);
  if (transform.contains("texCoord")) slot.texcoord = transform["texCoord"].get<std::uint8_t>();
}

TextureSlot slot_of(const CompileContext& context, const Json& info, bool is_color, const std::string& pointer) {
  TextureSlot slot;
  set_texture(context, info["index"], is_color, slot, pointer + "/index");
  if (slot.kind == TextureKind::none) return slot;
  set_coordinates(info, slot);
  if (const Json* mapping = member_at(info, {"extras", "relook", "mapping"})) set_mapping(*mapping, slot);
  return slot;
}

void set_core(const Json& value, Material& m) {
  constexpr std::array<std::string_view, 3> kAlphaModes{"OPAQUE", "MASK", "BLEND"};
  const Json& pbr = value["pbrMetallicRoughness"];
  const Json& base = pbr["baseColorFactor"];
  m.base_color = {float_of(base[0]), float_of(base[1]), float_of(base[2]), float_of(base[3])};
  m.metallic = float_of(pbr["metallicFactor"]);
  m.roughness = float_of(pbr["roughnessFactor"]);
  m.emissive = color_of(value["emissiveFactor"]);
  m.alpha_mode = enum_of<AlphaMode>(value["alphaMode"], kAlphaModes);
  m.alpha_cutoff = float_of(value["alphaCutoff"]);
  m.double_sided = value["doubleSided"].get<bool>();
  if (value.contains("normalTexture")) m.normal_scale = float_of(value["normalTexture"]["scale"]);
  if (value.contains("occlusionTexture")) m.occlusion_strength = float_of(value["occlusionTexture"]["strength"]);
}

void set_extensions(const Json& extensions, Material& m) {
  m.ior = float_of(extensions["KHR_materials_ior"]["ior"]);
  m.dispersion = float_of(extensions["KHR_materials_dispersion"]["dispersion"]);
  m.transmission = float_of(extensions["KHR_materials_transmission"]["transmissionFactor"]);
  const Json& volume = extensions["KHR_materials_volume"];
  m.thickness = float_of(volume["thicknessFactor"]);
  if (volume.contains("attenuationDistance")) m.attenuation_distance = float_of(volume["attenuationDistance"]);
  m.attenuation_color = color_of(volume["attenuationColor"]);
  const Json& specular = extensions["KHR_materials_specular"];
  m.specular = float_of(specular["specularFactor"]);
  m.specular_color = color_of(specular["specularColorFactor"]);
  const Json& coat = extensions["KHR_materials_clearcoat"];
  m.clearcoat = float_of(coat["clearcoatFactor"]);
  m.clearcoat_roughness = float_of(coat["clearcoatRoughnessFactor"]);
  if (coat.contains("clearcoatNormalTexture"))
    m.clearcoat_normal_scale = float_of(coat["clearcoatNormalTexture"]["scale"]);
  const Json& sheen = extensions["KHR_materials_sheen"];
  m.sheen_color = color_of(sheen["sheenColorFactor"]);
  m.sheen_roughness = float_of(sheen["sheenRoughnessFactor"]);
  const Json& anisotropy = extensions["KHR_materials_anisotropy"];
  m.anisotropy = float_of(anisotropy["anisotropyStrength"]);
  m.anisotropy_rotation = float_of(anisotropy["anisotropyRotation"]);
  const Json& film = extensions["KHR_materials_iridescence"];
  m.iridescence = float_of(film["iridescenceFactor"]);
  m.iridescence_ior = float_of(film["iridescenceIor"]);
  m.iridescence_minimum = float_of(film["iridescenceThicknessMinimum"]);
  m.iridescence_maximum = float_of(film["iridescenceThicknessMaximum"]);
  m.emissive_strength = float_of(extensions["KHR_materials_emissive_strength"]["emissiveStrength"]);
}

void set_relook(const Json& relook, Material& m) {
  constexpr std::array<std::string_view, 3> kModels{"metallic-roughness", "blinn-phong", "unlit"};
  m.model = enum_of<IlluminationModel>(relook["model"], kModels);
  m.phong_ambient = color_of(relook["ambient"]);
  m.phong_diffuse = color_of(relook["diffuse"]);
  m.phong_specular = color_of(relook["specular"]);
  m.shininess = float_of(relook["shininess"]);
  m.reflection = float_of(relook["reflection"]);
  m.refraction = float_of(relook["refraction"]);
  m.transparency = float_of(relook["transparency"]);
}

}  // namespace

const Json* member_at(const Json& value, std::initializer_list<std::string_view> keys) {
  const Json* at = &value;
  for (std::string_view key : keys) {
    if (!at->is_object()) return nullptr;
    const auto found = at->find(key);
    if (found == at->end()) return nullptr;
    at = &*found;
  }
  return at;
}

Color color_of(const Json& rgb) { return {float_of(rgb[0]), float_of(rgb[1]), float_of(rgb[2])}; }
float float_of(const Json& number) { return static_cast<float>(number.get<double>()) + 0.0F; }

Material compile_material(const CompileContext& context, const std::string& name, const Json& value,
                          const std::string& pointer) {
  Material m;
  m.name = name;
  set_core(value, m);
  set_extensions(value["extensions"], m);
  set_relook(value["extras"]["relook"], m);
  for (const SlotPlace& place : kSlotPlaces)
    if (const Json* info = slot_info(value, place))
      m.slot(place.slot) = slot_of(context, *info, is_color_slot(place.slot), pointer + pointer_to(place));
  return m;
}

void decode_images(const LookDocument& document, PyramidStore& pyramids) {
  std::set<std::pair<std::string, bool>> wanted;
  for (const Json& material : document.look["materials"])
    for (const SlotPlace& place : kSlotPlaces) {
      const Json* info = slot_info(material, place);
      const Json* texture = info == nullptr ? nullptr : member_at(*info, {"index"});
      if (texture == nullptr || !texture->is_string()) continue;
      const Json* image = member_at(document.look, {"textures", texture->get_ref<const std::string&>(), "source"});
      if (image == nullptr || !image->is_string()) continue;
      const Json* content =
          member_at(document.look, {"images", image->get_ref<const std::string&>(), "extras", "relook", "content"});
      if (content != nullptr && content->is_string())
        wanted.emplace(content->get<std::string>(), is_color_slot(place.slot));
    }
  const std::vector<std::pair<std::string, bool>> list(wanted.begin(), wanted.end());
  parallel_for(list.size(), [&](std::size_t i) {
    try {
      (void)pyramids.get(*document.assets, list[i].first, list[i].second, document.file,
                         "/images/" + escape_token(list[i].first));
    } catch (const InputError&) {
      // Reported, with its place, when the slot that needs it is compiled.
    }
  });
}

Displacement compile_displacement(const CompileContext& context, const Json& value, const std::string& pointer) {
  Displacement displacement;
  set_texture(context, value["texture"], false, displacement.texture, pointer + "/texture");
  if (displacement.texture.kind != TextureKind::none) set_coordinates(value, displacement.texture);
  if (value.contains("mapping")) set_mapping(value["mapping"], displacement.texture);
  displacement.scale = float_of(value["scale"]);
  displacement.midlevel = float_of(value["midlevel"]);
  displacement.subdivide = value["subdivide"].get<std::int32_t>();
  return displacement;
}

Light compile_light(std::string_view file, const std::string& name, const Json& value, const std::string& pointer) {
  constexpr std::array<std::string_view, 3> kKinds{"point", "spot", "directional"};
  Light light;
  light.light = name;
  light.kind = enum_of<LightKind>(value["type"], kKinds);
  light.color = color_of(value["color"]);
  light.intensity = float_of(value["intensity"]);
  if (value.contains("range") && light.kind != LightKind::directional) light.range = float_of(value["range"]);
  if (light.kind != LightKind::spot) return light;
  light.inner_cone = float_of(value["spot"]["innerConeAngle"]);
  light.outer_cone = float_of(value["spot"]["outerConeAngle"]);
  if (!(light.inner_cone <= light.outer_cone))
    throw LookError(file, pointer + "/spot/innerConeAngle", "the inner cone is not inside the outer cone");
  return light;
}

Environment compile_environment(const CompileContext& context, const Json& value) {
  Environment environment;
  environment.color = color_of(value["color"]);
  environment.intensity = float_of(value["intensity"]);
  environment.rotation = float_of(value["rotation"]);
  if (value.contains("image"))
    environment.image = pyramid_of(context, value["image"], true, "/scene/extras/relook/environment/image");
  return environment;
}

void check_texture_entity(const LookDocument& document, std::string_view file, Section section, const Json& value,
                          const std::string& pointer) {
  if (section != Section::images) return;
  const std::string& content = value["extras"]["relook"].value("content", "");
  if (!document.assets->images.contains(content))
    throw LookError(file, pointer, "an image needs a \"uri\", or the \"content\" of another image");
}

}  // namespace relook
