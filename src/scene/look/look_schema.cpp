// The tables of look_schema.h: glTF 2.0 and its extensions as far as relook supports them, and extras.relook. Bounds of
// what glTF defines are glTF's. That of materials is made of the rows of material_fields.h.
#include "scene/look/look_schema.h"

#include <algorithm>
#include <utility>

#include "scene/light.h"

namespace relook {
namespace {

constexpr double kMost = kOwnCeiling;
constexpr double kLargest = kCeiling;
constexpr double kHuge = kUnbounded;  // where a float's infinity does no harm
constexpr double kRightAngle = 1.5707963267948966;
constexpr double kBelowPi = 3.1415926;
constexpr double kPi = 3.141592653589793;
constexpr double kCoolest = 1000, kHottest = 40000;  // kelvin: of temperature_color(), compile/place_light.h

SchemaField number(std::string_view key, Json fallback, double low, double high) {
  return {.key = key, .kind = FieldKind::number, .fallback = std::move(fallback), .low = low, .high = high};
}
SchemaField integer(std::string_view key, Json fallback, double low, double high) {
  return {.key = key, .kind = FieldKind::integer, .fallback = std::move(fallback), .low = low, .high = high};
}
SchemaField code(std::string_view key, Json fallback, std::vector<int> codes) {
  return {.key = key, .kind = FieldKind::integer, .fallback = std::move(fallback), .codes = std::move(codes)};
}
SchemaField boolean(std::string_view key, Json fallback) {
  return {.key = key, .kind = FieldKind::boolean, .fallback = std::move(fallback)};
}
SchemaField text(std::string_view key) { return {.key = key, .kind = FieldKind::text, .fallback = {}}; }
SchemaField reals(std::string_view key, Json fallback, double low, double high) {
  const std::size_t count = fallback.size();
  return {
      .key = key, .kind = FieldKind::reals, .fallback = std::move(fallback), .low = low, .high = high, .count = count};
}
/// A colour without a default.
SchemaField color(std::string_view key) {
  return {.key = key, .kind = FieldKind::reals, .fallback = {}, .low = 0, .high = kMost, .count = 3};
}
/// Any number of them.
SchemaField numbers(std::string_view key, double low, double high) {
  return {.key = key, .kind = FieldKind::reals, .fallback = {}, .low = low, .high = high};
}
SchemaField choice(std::string_view key, Json fallback, std::vector<std::string_view> choices, bool required = false) {
  return {.key = key,
          .kind = FieldKind::choice,
          .fallback = std::move(fallback),
          .choices = std::move(choices),
          .required = required};
}
SchemaField name(std::string_view key, Target target, bool required = false) {
  return {.key = key, .kind = FieldKind::name, .fallback = {}, .target = target, .required = required};
}
SchemaField names(std::string_view key, Target target) {
  return {.key = key, .kind = FieldKind::names, .fallback = {}, .target = target};
}
SchemaField implied(std::string_view key, const Schema& inner) {
  return {.key = key, .kind = FieldKind::object, .fallback = {}, .inner = &inner, .implied = true};
}
SchemaField optional(std::string_view key, const Schema& inner) {
  return {.key = key, .kind = FieldKind::object, .fallback = {}, .inner = &inner};
}
/// A field whose default documents omit, see SchemaField::unwritten.
SchemaField unwritten(SchemaField field) {
  field.unwritten = true;
  return field;
}
SchemaField nullable(SchemaField field) {
  field.nullable = true;
  return field;
}
SchemaField or_zero(SchemaField field) {
  field.zero_too = true;
  return field;
}
SchemaField list(std::string_view key, const Schema& inner) {
  return {.key = key, .kind = FieldKind::list, .fallback = {}, .inner = &inner};
}

/// {"relook": inner} or any other object with one implied member.
Schema wrapped(std::string_view key, const Schema& inner, bool is_implied = true) {
  return {{is_implied ? implied(key, inner) : optional(key, inner)}};
}

const Schema& mapping_schema() {
  static const Schema mapping{{choice("kind", {}, {"uv", "planar", "spherical", "cylindrical", "solid"}, true),
                               choice("axis", "y", {"x", "y", "z"})}};
  return mapping;
}

SchemaField texture_coordinates() { return integer("texCoord", 0, 0, 1); }

/// KHR_texture_transform of a textureInfo or a displacement map.
SchemaField texture_transform() {
  static const Schema transform{
      {reals("offset", {0.0, 0.0}, -kLargest, kLargest), number("rotation", 0.0, -kLargest, kLargest),
       reals("scale", {1.0, 1.0}, -kLargest, kLargest), integer("texCoord", {}, 0, 1)}};
  static const Schema extensions = wrapped("KHR_texture_transform", transform);
  return implied("extensions", extensions);
}

/// textureInfo, with the extra number of normal and occlusion textures if there is one.
Schema texture_info(std::vector<SchemaField> extra = {}) {
  static const Schema relook{{unwritten(optional("mapping", mapping_schema()))}};
  static const Schema extras = wrapped("relook", relook, false);
  Schema info{
      {name("index", Target::textures, true), texture_coordinates(), texture_transform(), optional("extras", extras)}};
  for (SchemaField& field : extra) info.fields.push_back(std::move(field));
  return info;
}

const Schema& plain_texture() {
  static const Schema info = texture_info();
  return info;
}

/// The value of a field that is no texture slot.
SchemaField value_of(const MaterialRow& row, std::string_view key) {
  const auto& fallback = row.fallback;
  if (!row.choices.empty())
    return choice(key, row.choices[static_cast<std::size_t>(fallback[0])], {row.choices.begin(), row.choices.end()});
  if (std::holds_alternative<bool Material::*>(row.member)) return boolean(key, fallback[0] != 0);
  if (std::holds_alternative<Color Material::*>(row.member))
    return reals(key, {fallback[0], fallback[1], fallback[2]}, row.low, row.high);
  if (std::holds_alternative<Rgba Material::*>(row.member)) return reals(key, fallback, row.low, row.high);
  SchemaField field = number(key, fallback[0], row.low, row.high);
  if (row.has(MaterialRow::zero_too)) field = or_zero(std::move(field));
  if (!row.has(MaterialRow::unwritten)) return field;
  field.fallback = {};
  return unwritten(std::move(field));
}

/// The members of an object of a material: of the rows with pointers below `prefix`, "" or "extensions/".
std::vector<SchemaField> members_below(const std::string& prefix, std::span<const MaterialRow> rows,
                                       std::deque<Schema>& parts) {
  std::vector<SchemaField> members;
  for (const MaterialRow& row : rows) {
    if (!row.pointer.starts_with(prefix)) continue;
    std::string_view key = row.pointer.substr(prefix.size());
    key = key.substr(0, key.find('/'));
    if (std::ranges::find(members, key, &SchemaField::key) != members.end()) continue;
    const bool is_inner = prefix.size() + key.size() < row.pointer.size();
    if (!is_inner && row.slot() == nullptr) {
      members.push_back(value_of(row, key));
      continue;
    }
    std::vector<SchemaField> inner = members_below(prefix + std::string(key) + "/", rows, parts);
    parts.push_back(is_inner ? Schema{std::move(inner)} : texture_info(std::move(inner)));
    members.push_back(is_inner ? implied(key, parts.back()) : optional(key, parts.back()));
  }
  if (prefix == "extensions/") {
    static const Schema unlit{};
    members.push_back(optional("KHR_materials_unlit", unlit));
  }
  return members;
}

const Schema& material_schema() {
  static std::deque<Schema> parts;
  static const Schema material = material_schema(material_rows(), parts);
  return material;
}

const Schema& texture_schema() {
  static const Schema procedural{{choice("kind", {}, {"marble", "wood", "checker", "noise"}, true),
                                  number("scale", 1.0, -kMost, kMost), number("turbulence", 1.0, -kMost, kMost),
                                  integer("octaves", 4, 1, 16), reals("color1", {0.0, 0.0, 0.0}, 0, kMost),
                                  reals("color2", {1.0, 1.0, 1.0}, 0, kMost)}};
  static const Schema relook{{optional("procedural", procedural)}};
  static const Schema extras = wrapped("relook", relook, false);
  static const Schema texture{
      {text("name"), name("source", Target::images), name("sampler", Target::samplers), optional("extras", extras)}};
  return texture;
}

const Schema& image_schema() {
  static const Schema relook{{text("content")}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema image{{text("name"), text("uri"), text("mimeType"), implied("extras", extras)}};
  return image;
}

const Schema& sampler_schema() {
  static const std::vector<int> wraps{10497, 33071, 33648};  // repeat, clamp, mirror
  static const Schema sampler{{text("name"), code("magFilter", 9729, {9728, 9729}),
                               code("minFilter", {}, {9728, 9729, 9984, 9985, 9986, 9987}),
                               code("wrapS", 10497, wraps), code("wrapT", 10497, wraps)}};
  return sampler;
}

const Schema& mesh_schema() {
  static const Schema mapping{
      {text("name"), name("material", Target::materials, true), names("variants", Target::variants)}};
  static const Schema variants{{list("mappings", mapping)}};
  static const Schema extensions = wrapped("KHR_materials_variants", variants, false);
  static const Schema primitive{
      {name("material", Target::materials), integer("mode", 4, 0, 6), optional("extensions", extensions)}};
  static const Schema relook{{text("geometry")}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema mesh{{text("name"), list("primitives", primitive), numbers("weights", -kLargest, kLargest),
                            implied("extras", extras)}};
  return mesh;
}

/// What lights have wherever they stand. `types`: words that their type may be.
std::vector<SchemaField> light_fields(std::span<const std::string_view> types) {
  return {text("name"), choice("type", {}, {types.begin(), types.end()}, true),
          reals("color", {1.0, 1.0, 1.0}, 0, kMost), number("intensity", 1.0, 0, kLargest)};
}
std::vector<SchemaField> punctual_fields() {
  static const Schema spot{{number("innerConeAngle", 0.0, 0, kRightAngle),
                            number("outerConeAngle", 0.7853981633974483, 0, kRightAngle)}};
  return {unwritten(number("range", {}, kAboveZero, kHuge)), optional("spot", spot)};
}
/// EXT_lights_area; fill_defaults() gives lights with an area what is missing.
std::vector<SchemaField> area_fields() {
  static const Schema rect{{number("aspect", 1.0, kAboveZero, kLargest)}};
  return {number("size", {}, kAboveZero, kLargest), optional("rect", rect)};
}
Schema joined(std::initializer_list<std::vector<SchemaField>> parts) {
  Schema schema;
  for (const std::vector<SchemaField>& part : parts)
    schema.fields.insert(schema.fields.end(), part.begin(), part.end());
  return schema;
}

constexpr auto kLightWords = light_words();
constexpr std::span<const std::string_view> kDocumentWords(kLightWords.data(), kDocumentLightKinds);
/// Rows with an area come after those without.
constexpr std::size_t kPunctualKinds = static_cast<std::size_t>(LightKind::rect);

const Schema& light_schema() {
  static const Schema relook{{unwritten(number("radius", {}, 0, kMost)), unwritten(number("angle", {}, 0, kPi)),
                              unwritten(or_zero(number("temperature", {}, kCoolest, kHottest))),
                              unwritten(number("rate", {}, kAboveZero, 1)), unwritten(text("sum"))}};
  static const Schema extras = wrapped("relook", relook, false);
  static const Schema light =
      joined({light_fields(kDocumentWords), punctual_fields(), area_fields(), {optional("extras", extras)}});
  return light;
}

const Schema& node_schema() {
  static const Schema light{{name("light", Target::lights, true)}};
  static const Schema visibility{{boolean("visible", true)}};
  static const Schema extensions{{optional("KHR_lights_punctual", light), optional("EXT_lights_area", light),
                                  implied("KHR_node_visibility", visibility)}};
  static const Schema displacement{{name("texture", Target::textures, true), number("scale", 0.1, -kMost, kMost),
                                    number("midlevel", 0.5, -kMost, kMost), integer("subdivide", 0, 0, 6),
                                    texture_coordinates(), texture_transform(),
                                    unwritten(optional("mapping", mapping_schema()))}};
  static const Schema relook{{optional("displacement", displacement), text("instances"),
                              unwritten(boolean("visible", {})), unwritten(names("excludes", Target::nodes))}};
  static const Schema extras = wrapped("relook", relook, false);
  static const Schema node = [] {
    SchemaField children = names("children", Target::nodes);
    children.fallback = Json::array();
    Schema schema{{text("name"), name("mesh", Target::meshes), name("skin", Target::skins),
                   numbers("weights", -kLargest, kLargest), children, name("camera", Target::cameras),
                   implied("extensions", extensions), optional("extras", extras),
                   reals("translation", {0.0, 0.0, 0.0}, -kHuge, kHuge),
                   reals("rotation", {0.0, 0.0, 0.0, 1.0}, -kHuge, kHuge),
                   reals("scale", {1.0, 1.0, 1.0}, -kHuge, kHuge)}};
    schema.fields.push_back(
        {.key = "matrix", .kind = FieldKind::reals, .fallback = {}, .low = -kHuge, .high = kHuge, .count = 16});
    return schema;
  }();
  return node;
}

const Schema& skin_schema() {
  static const Schema relook{{text("inverseBinds")}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema skin{{text("name"), names("joints", Target::nodes), implied("extras", extras)}};
  return skin;
}

}  // namespace

const Schema& schema_of(Section section) {
  switch (section) {
    case Section::materials:
      return material_schema();
    case Section::textures:
      return texture_schema();
    case Section::images:
      return image_schema();
    case Section::samplers:
      return sampler_schema();
    case Section::meshes:
      return mesh_schema();
    case Section::lights:
      return light_schema();
    case Section::skins:
      return skin_schema();
    case Section::nodes:
      break;
  }
  return node_schema();
}

const Schema& scene_schema() {
  // Without a colour, an image stands as it is, and no image is black.
  const auto sky = [] {
    return std::vector<SchemaField>{unwritten(color("color")), number("intensity", 1.0, 0, kLargest),
                                    number("rotation", 0.0, -kMost, kMost), name("image", Target::images)};
  };
  static const Schema background{sky()};
  static const Schema environment = [&] {
    Schema all{sky()};
    all.fields.push_back(nullable(unwritten(optional("background", background))));
    return all;
  }();
  static const Schema relook{{reals("ambient", {0.0, 0.0, 0.0}, 0, kMost), implied("environment", environment)}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema scene{{text("name"), implied("extras", extras)}};
  return scene;
}

const Schema& punctual_light_schema() {
  static const Schema light = joined({light_fields(kDocumentWords.first(kPunctualKinds)), punctual_fields()});
  return light;
}

const Schema& area_light_schema() {
  static const Schema light = joined({light_fields(kDocumentWords.subspan(kPunctualKinds)), area_fields()});
  return light;
}

const Schema& extensions_schema() {
  static const Schema variants{{{.key = "variants", .kind = FieldKind::texts, .fallback = {}}}};
  static const Schema extensions = wrapped("KHR_materials_variants", variants, false);
  return extensions;
}

Schema material_schema(std::span<const MaterialRow> rows, std::deque<Schema>& parts) {
  Schema material{{text("name")}};
  for (SchemaField& member : members_below("", rows, parts)) material.fields.push_back(std::move(member));
  return material;
}

const Schema& file_material_schema() {
  static const Schema specular_glossiness{
      {reals("diffuseFactor", {1.0, 1.0, 1.0, 1.0}, 0, 1), optional("diffuseTexture", plain_texture()),
       reals("specularFactor", {1.0, 1.0, 1.0}, 0, 1), number("glossinessFactor", 1.0, 0, 1),
       optional("specularGlossinessTexture", plain_texture())}};
  static const Schema extensions = [] {
    Schema all = *std::ranges::find(material_schema().fields, "extensions", &SchemaField::key)->inner;
    all.fields.push_back(optional("KHR_materials_pbrSpecularGlossiness", specular_glossiness));
    return all;
  }();
  static const Schema material = [] {
    Schema all = material_schema();
    std::ranges::find(all.fields, "extensions", &SchemaField::key)->inner = &extensions;
    return all;
  }();
  return material;
}

const Schema& camera_schema() {
  static const Schema perspective{{number("yfov", {}, kAboveZero, kBelowPi),
                                   number("aspectRatio", {}, kAboveZero, kLargest),
                                   number("znear", {}, kAboveZero, kHuge), number("zfar", {}, kAboveZero, kHuge)}};
  static const Schema orthographic{{number("xmag", {}, -kLargest, kLargest), number("ymag", {}, -kLargest, kLargest),
                                    number("znear", {}, 0, kHuge), number("zfar", {}, kAboveZero, kHuge)}};
  static const Schema camera{{text("name"), choice("type", {}, {"perspective", "orthographic"}, true),
                              optional("perspective", perspective), optional("orthographic", orthographic)}};
  return camera;
}

}  // namespace relook
