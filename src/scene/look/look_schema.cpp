// The tables of look_schema.h: glTF 2.0 and its extensions as far as relook supports them, and extras.relook. Bounds of
// what glTF defines are glTF's.
#include "scene/look/look_schema.h"

#include <utility>

namespace relook {
namespace {

constexpr double kMost = 1e6;         // of what is relook's own
constexpr double kLargest = kCeiling;
constexpr double kHuge = kUnbounded;  // where a float's infinity does no harm
constexpr double kRightAngle = 1.5707963267948966;
constexpr double kBelowPi = 3.1415926;

Field number(std::string_view key, Json fallback, double low, double high) {
  return {.key = key, .kind = FieldKind::number, .fallback = std::move(fallback), .low = low, .high = high};
}
Field integer(std::string_view key, Json fallback, double low, double high) {
  return {.key = key, .kind = FieldKind::integer, .fallback = std::move(fallback), .low = low, .high = high};
}
Field code(std::string_view key, Json fallback, std::vector<int> codes) {
  return {.key = key, .kind = FieldKind::integer, .fallback = std::move(fallback), .codes = std::move(codes)};
}
Field boolean(std::string_view key, bool fallback) {
  return {.key = key, .kind = FieldKind::boolean, .fallback = fallback};
}
Field text(std::string_view key) { return {.key = key, .kind = FieldKind::text, .fallback = {}}; }
Field reals(std::string_view key, Json fallback, double low, double high) {
  const std::size_t count = fallback.size();
  return {
      .key = key, .kind = FieldKind::reals, .fallback = std::move(fallback), .low = low, .high = high, .count = count};
}
/// Any number of them.
Field numbers(std::string_view key, double low, double high) {
  return {.key = key, .kind = FieldKind::reals, .fallback = {}, .low = low, .high = high};
}
Field choice(std::string_view key, Json fallback, std::vector<std::string_view> choices, bool required = false) {
  return {.key = key,
          .kind = FieldKind::choice,
          .fallback = std::move(fallback),
          .choices = std::move(choices),
          .required = required};
}
Field name(std::string_view key, Target target, bool required = false) {
  return {.key = key, .kind = FieldKind::name, .fallback = {}, .target = target, .required = required};
}
Field names(std::string_view key, Target target) {
  return {.key = key, .kind = FieldKind::names, .fallback = {}, .target = target};
}
Field implied(std::string_view key, const Schema& inner) {
  return {.key = key, .kind = FieldKind::object, .fallback = {}, .inner = &inner, .implied = true};
}
Field optional(std::string_view key, const Schema& inner) {
  return {.key = key, .kind = FieldKind::object, .fallback = {}, .inner = &inner};
}
/// A field whose default documents omit, see Field::unwritten.
Field unwritten(Field field) {
  field.unwritten = true;
  return field;
}
Field or_zero(Field field) {
  field.zero_too = true;
  return field;
}
Field list(std::string_view key, const Schema& inner) {
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

Field texture_coordinates() { return integer("texCoord", 0, 0, 1); }

/// KHR_texture_transform of a textureInfo or a displacement map.
Field texture_transform() {
  static const Schema transform{
      {reals("offset", {0.0, 0.0}, -kLargest, kLargest), number("rotation", 0.0, -kLargest, kLargest),
       reals("scale", {1.0, 1.0}, -kLargest, kLargest), integer("texCoord", {}, 0, 1)}};
  static const Schema extensions = wrapped("KHR_texture_transform", transform);
  return implied("extensions", extensions);
}

/// textureInfo, with the extra number of normal and occlusion textures if there is one.
Schema texture_info(std::vector<Field> extra = {}) {
  static const Schema relook{{unwritten(optional("mapping", mapping_schema()))}};
  static const Schema extras = wrapped("relook", relook, false);
  Schema info{
      {name("index", Target::textures, true), texture_coordinates(), texture_transform(), optional("extras", extras)}};
  for (Field& field : extra) info.fields.push_back(std::move(field));
  return info;
}

const Schema& plain_texture() {
  static const Schema info = texture_info();
  return info;
}
const Schema& normal_texture() {
  static const Schema info = texture_info({number("scale", 1.0, -kLargest, kLargest)});
  return info;
}

const Schema& material_extensions() {
  static const Schema ior{{or_zero(number("ior", 1.5, 1, kLargest))}};
  static const Schema dispersion{{number("dispersion", 0.0, 0, kLargest)}};
  static const Schema transmission{
      {number("transmissionFactor", 0.0, 0, 1), optional("transmissionTexture", plain_texture())}};
  static const Schema volume{{number("thicknessFactor", 0.0, 0, kLargest), optional("thicknessTexture", plain_texture()),
                              unwritten(number("attenuationDistance", {}, kAboveZero, kHuge)),
                              reals("attenuationColor", {1.0, 1.0, 1.0}, 0, 1)}};
  static const Schema specular{{number("specularFactor", 1.0, 0, 1), optional("specularTexture", plain_texture()),
                                reals("specularColorFactor", {1.0, 1.0, 1.0}, 0, kLargest),
                                optional("specularColorTexture", plain_texture())}};
  static const Schema clearcoat{{number("clearcoatFactor", 0.0, 0, 1), optional("clearcoatTexture", plain_texture()),
                                 number("clearcoatRoughnessFactor", 0.0, 0, 1),
                                 optional("clearcoatRoughnessTexture", plain_texture()),
                                 optional("clearcoatNormalTexture", normal_texture())}};
  static const Schema sheen{{reals("sheenColorFactor", {0.0, 0.0, 0.0}, 0, 1),
                             optional("sheenColorTexture", plain_texture()), number("sheenRoughnessFactor", 0.0, 0, 1),
                             optional("sheenRoughnessTexture", plain_texture())}};
  static const Schema anisotropy{{number("anisotropyStrength", 0.0, 0, 1),
                                  number("anisotropyRotation", 0.0, -kLargest, kLargest),
                                  optional("anisotropyTexture", plain_texture())}};
  static const Schema iridescence{
      {number("iridescenceFactor", 0.0, 0, 1), optional("iridescenceTexture", plain_texture()),
       number("iridescenceIor", 1.3, 1, kLargest), number("iridescenceThicknessMinimum", 100.0, 0, kLargest),
       number("iridescenceThicknessMaximum", 400.0, 0, kLargest),
       optional("iridescenceThicknessTexture", plain_texture())}};
  static const Schema emissive_strength{{number("emissiveStrength", 1.0, 0, kLargest)}};
  static const Schema unlit{};
  static const Schema extensions{
      {implied("KHR_materials_ior", ior), implied("KHR_materials_dispersion", dispersion),
       implied("KHR_materials_transmission", transmission),
       implied("KHR_materials_volume", volume), implied("KHR_materials_specular", specular),
       implied("KHR_materials_clearcoat", clearcoat), implied("KHR_materials_sheen", sheen),
       implied("KHR_materials_anisotropy", anisotropy), implied("KHR_materials_iridescence", iridescence),
       implied("KHR_materials_emissive_strength", emissive_strength), optional("KHR_materials_unlit", unlit)}};
  return extensions;
}

const Schema& material_schema() {
  static const Schema metallic_roughness{{reals("baseColorFactor", {1.0, 1.0, 1.0, 1.0}, 0, 1),
                                          number("metallicFactor", 1.0, 0, 1), number("roughnessFactor", 1.0, 0, 1),
                                          optional("baseColorTexture", plain_texture()),
                                          optional("metallicRoughnessTexture", plain_texture())}};
  static const Schema occlusion = texture_info({number("strength", 1.0, 0, 1)});
  static const Schema relook{{choice("model", "metallic-roughness", {"metallic-roughness", "blinn-phong", "unlit"}),
                              reals("ambient", {1.0, 1.0, 1.0}, 0, kMost), reals("diffuse", {1.0, 1.0, 1.0}, 0, kMost),
                              reals("specular", {0.5, 0.5, 0.5}, 0, kMost), number("shininess", 32.0, 0, kMost),
                              number("reflection", 0.0, 0, 1), number("refraction", 0.0, 0, 1),
                              number("transparency", 0.0, 0, 1)}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema material{
      {text("name"), implied("pbrMetallicRoughness", metallic_roughness), optional("normalTexture", normal_texture()),
       optional("occlusionTexture", occlusion), optional("emissiveTexture", plain_texture()),
       reals("emissiveFactor", {0.0, 0.0, 0.0}, 0, 1), choice("alphaMode", "OPAQUE", {"OPAQUE", "MASK", "BLEND"}),
       number("alphaCutoff", 0.5, 0, kHuge), boolean("doubleSided", false),
       implied("extensions", material_extensions()), implied("extras", extras)}};
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
  static const Schema mesh{
      {text("name"), list("primitives", primitive), numbers("weights", -kLargest, kLargest), implied("extras", extras)}};
  return mesh;
}

const Schema& light_schema() {
  static const Schema spot{{number("innerConeAngle", 0.0, 0, kRightAngle),
                            number("outerConeAngle", 0.7853981633974483, 0, kRightAngle)}};
  static const Schema light{{text("name"), choice("type", {}, {"point", "spot", "directional"}, true),
                             reals("color", {1.0, 1.0, 1.0}, 0, kMost), number("intensity", 1.0, 0, kLargest),
                             unwritten(number("range", {}, kAboveZero, kHuge)), optional("spot", spot)}};
  return light;
}

const Schema& node_schema() {
  static const Schema light{{name("light", Target::lights, true)}};
  static const Schema visibility{{boolean("visible", true)}};
  static const Schema extensions{{optional("KHR_lights_punctual", light), implied("KHR_node_visibility", visibility)}};
  static const Schema displacement{{name("texture", Target::textures, true), number("scale", 0.1, -kMost, kMost),
                                    number("midlevel", 0.5, -kMost, kMost), integer("subdivide", 0, 0, 6),
                                    texture_coordinates(), texture_transform(),
                                    unwritten(optional("mapping", mapping_schema()))}};
  static const Schema relook{{optional("displacement", displacement), text("instances")}};
  static const Schema extras = wrapped("relook", relook, false);
  static const Schema node = [] {
    Field children = names("children", Target::nodes);
    children.fallback = Json::array();
    Schema schema{
        {text("name"), name("mesh", Target::meshes), name("skin", Target::skins), numbers("weights", -kLargest, kLargest),
         children, name("camera", Target::cameras), implied("extensions", extensions), optional("extras", extras),
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
  static const Schema environment{{reals("color", {0.0, 0.0, 0.0}, 0, kMost),
                                   number("intensity", 1.0, 0, kLargest), number("rotation", 0.0, -kMost, kMost),
                                   name("image", Target::images)}};
  static const Schema relook{{reals("ambient", {0.0, 0.0, 0.0}, 0, kMost), implied("environment", environment)}};
  static const Schema extras = wrapped("relook", relook);
  static const Schema scene{{text("name"), implied("extras", extras)}};
  return scene;
}

const Schema& extensions_schema() {
  static const Schema variants{{{.key = "variants", .kind = FieldKind::texts, .fallback = {}}}};
  static const Schema extensions = wrapped("KHR_materials_variants", variants, false);
  return extensions;
}

const Schema& file_material_schema() {
  static const Schema specular_glossiness{
      {reals("diffuseFactor", {1.0, 1.0, 1.0, 1.0}, 0, 1), optional("diffuseTexture", plain_texture()),
       reals("specularFactor", {1.0, 1.0, 1.0}, 0, 1), number("glossinessFactor", 1.0, 0, 1),
       optional("specularGlossinessTexture", plain_texture())}};
  static const Schema extensions = [] {
    Schema all = material_extensions();
    all.fields.push_back(optional("KHR_materials_pbrSpecularGlossiness", specular_glossiness));
    return all;
  }();
  static const Schema material = [] {
    Schema all = material_schema();
    for (Field& field : all.fields)
      if (field.key == "extensions") field.inner = &extensions;
    return all;
  }();
  return material;
}

const Schema& camera_schema() {
  static const Schema perspective{{number("yfov", {}, kAboveZero, kBelowPi), number("aspectRatio", {}, kAboveZero, kLargest),
                                   number("znear", {}, kAboveZero, kHuge), number("zfar", {}, kAboveZero, kHuge)}};
  static const Schema orthographic{{number("xmag", {}, -kLargest, kLargest), number("ymag", {}, -kLargest, kLargest),
                                    number("znear", {}, 0, kHuge), number("zfar", {}, kAboveZero, kHuge)}};
  static const Schema camera{{text("name"), choice("type", {}, {"perspective", "orthographic"}, true),
                              optional("perspective", perspective), optional("orthographic", orthographic)}};
  return camera;
}

}  // namespace relook
