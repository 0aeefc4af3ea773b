#include "scene/compile/compile_material.h"

#include <algorithm>
#include <set>
#include <type_traits>

#include "base/parallel.h"
#include "scene/compile/place_light.h"
#include "scene/look/look_schema.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

/// The value at a row's pointer below a material, or nullptr.
const Json* value_at(const Json& material, std::string_view pointer) {
  const Json* at = &material;
  while (at != nullptr && !pointer.empty()) {
    const std::size_t length = std::min(pointer.find('/'), pointer.size());
    at = member_at(*at, {pointer.substr(0, length)});
    pointer.remove_prefix(std::min(length + 1, pointer.size()));
  }
  return at;
}

/// The enumerator of `Enum` whose word in `words` is the value's.
template <class Enum>
Enum enum_of(const Json& value, std::span<const std::string_view> words) {
  const auto found = std::ranges::find(words, value.get_ref<const std::string&>());
  require(found != words.end(), "a choice that passed the schema has an enumerator");
  return static_cast<Enum>(found - words.begin());
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

double number_or(const Json& value, std::initializer_list<std::string_view> keys, double fallback) {
  const Json* number = member_at(value, keys);
  return number == nullptr ? fallback : number->get<double>();
}

/// What of a light only Integrator::path reads.
void set_path_members(const Json& value, Light& light) {
  const LightTraits& traits = traits_of(light.kind);
  const auto at_least = [](double x, float smallest) { return x > 0 ? std::max(static_cast<float>(x), smallest) : 0; };
  if (traits.has_radius) light.radius = at_least(number_or(value, {"extras", "relook", "radius"}, 0), kSmallestLight);
  if (traits.has_angle) light.angle = at_least(number_or(value, {"extras", "relook", "angle"}, 0), kSmallestAngle);
  light.rate = std::max(static_cast<float>(number_or(value, {"extras", "relook", "rate"}, 1)), kSmallestRate);
  if (const Json* sum = member_at(value, {"extras", "relook", "sum"})) light.sum = sum->get<std::string>();
  if (!traits.has_size) return;
  const double height = number_or(value, {"size"}, 1);
  const double aspect = light.kind == LightKind::rect ? number_or(value, {"rect", "aspect"}, 1) : 1;
  light.right.x = static_cast<float>(height * aspect / 2);
  light.up.y = static_cast<float>(height / 2);
}

/// What an environment and a background have in common.
template <class Sky>
void set_sky(const CompileContext& context, const Json& value, const std::string& pointer, Sky& sky) {
  if (value.contains("image")) sky.image = pyramid_of(context, value["image"], true, pointer + "/image");
  if (value.contains("color"))
    sky.color = color_of(value["color"]);
  else if (sky.image != nullptr)
    sky.color = Color(1, 1, 1);
  sky.intensity = float_of(value["intensity"]);
  sky.rotation = float_of(value["rotation"]);
}

void set_member(const Json& value, const MaterialRow&, float& member) { member = float_of(value); }
void set_member(const Json& value, const MaterialRow&, bool& member) { member = value.get<bool>(); }
void set_member(const Json& value, const MaterialRow&, Color& member) { member = color_of(value); }
void set_member(const Json& rgba, const MaterialRow&, Rgba& member) {
  member = {float_of(rgba[0]), float_of(rgba[1]), float_of(rgba[2]), float_of(rgba[3])};
}
template <class Enum>
void set_member(const Json& value, const MaterialRow& row, Enum& member) {
  member = enum_of<Enum>(value, row.choices);
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

void set_fields(const Json& value, Material& material, std::span<const MaterialRow> rows) {
  for (const MaterialRow& row : rows) {
    const Json* given = value_at(value, row.pointer);
    if (given == nullptr) continue;
    std::visit(
        [&](const auto member) {
          if constexpr (!std::is_same_v<decltype(member), const Slot>) set_member(*given, row, material.*member);
        },
        row.member);
  }
}

Material compile_material(const CompileContext& context, const std::string& name, const Json& value,
                          const std::string& pointer) {
  Material m;
  m.name = name;
  set_fields(value, m);
  for (const MaterialRow& row : material_rows()) {
    const Json* info = row.slot() == nullptr ? nullptr : value_at(value, row.pointer);
    if (info == nullptr) continue;
    m.slot(*row.slot()) = slot_of(context, *info, row.has(MaterialRow::srgb), pointer + "/" + std::string(row.pointer));
  }
  return m;
}

void decode_images(const LookDocument& document, PyramidStore& pyramids) {
  std::set<std::pair<std::string, bool>> wanted;
  for (const Json& material : document.look["materials"])
    for (const MaterialRow& row : material_rows()) {
      const Json* info = row.slot() == nullptr ? nullptr : value_at(material, row.pointer);
      const Json* texture = info == nullptr ? nullptr : member_at(*info, {"index"});
      if (texture == nullptr || !texture->is_string()) continue;
      const Json* image = member_at(document.look, {"textures", texture->get_ref<const std::string&>(), "source"});
      if (image == nullptr || !image->is_string()) continue;
      const Json* content =
          member_at(document.look, {"images", image->get_ref<const std::string&>(), "extras", "relook", "content"});
      if (content != nullptr && content->is_string())
        wanted.emplace(content->get<std::string>(), row.has(MaterialRow::srgb));
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

const Json* light_name_of(const Json& node) {
  for (const char* extension : {"KHR_lights_punctual", "EXT_lights_area"})
    if (const Json* light = member_at(node, {"extensions", extension, "light"})) return light;
  return nullptr;
}

Light compile_light(std::string_view file, const std::string& name, const Json& value, const std::string& pointer,
                    Integrator integrator) {
  Light light;
  light.light = name;
  light.kind = enum_of<LightKind>(value["type"], light_words());
  light.color = color_of(value["color"]);
  light.intensity = float_of(value["intensity"]);
  if (const double kelvin = number_or(value, {"extras", "relook", "temperature"}, 0); kelvin > 0)
    light.color *= temperature_color(kelvin);
  if (integrator == Integrator::path) set_path_members(value, light);
  if (value.contains("range") && traits_of(light.kind).has_place) light.range = float_of(value["range"]);
  if (!traits_of(light.kind).has_cone) return light;
  light.inner_cone = float_of(value["spot"]["innerConeAngle"]);
  light.outer_cone = float_of(value["spot"]["outerConeAngle"]);
  if (!(light.inner_cone <= light.outer_cone))
    throw LookError(file, pointer + "/spot/innerConeAngle", "the inner cone is not inside the outer cone");
  return light;
}

Environment compile_environment(const CompileContext& context, const Json& value, Integrator integrator) {
  const std::string pointer = "/scene/extras/relook/environment";
  Environment environment;
  set_sky(context, value, pointer, environment);
  const Json* background = member_at(value, {"background"});
  if (background != nullptr && !background->is_null()) {
    Background sky;
    set_sky(context, *background, pointer + "/background", sky);
    if (integrator == Integrator::path) environment.background = std::move(sky);
  }
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
