// What materials, textures, images and variants refer to.
#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/gltf_textures.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

/// The textures that the slots below a value name.
void check_slots(const JsonView& root, const JsonView& owner, const Schema& schema) {
  owner.require_object();
  for (const SchemaField& field : schema.fields) {
    if (field.kind == FieldKind::name && field.target == Target::textures)
      (void)reference(owner.at(field.key), array_size(root, "textures"), "texture");
    if (field.kind != FieldKind::object || field.key == "extras") continue;
    if (const auto inner = member(owner, field.key)) check_slots(root, *inner, *field.inner);
  }
}

void check_image(const JsonView& root, const JsonView& image) {
  const auto uri = member(image, "uri");
  const auto mime_type = member(image, "mimeType");
  if (uri) (void)uri->text();
  if (mime_type) (void)mime_type->text();
  const auto view = optional_reference(image, "bufferView", array_size(root, "bufferViews"), "buffer view");
  if (!view) return;
  if (uri) image.fail("has both a uri and a buffer view");
  if (root.at("bufferViews").at(*view).has("byteStride"))
    image.at("bufferView").fail("the buffer view of an image may not have a byteStride");
}

}  // namespace

void check_materials(const JsonView& root) {
  const Schema& schema = file_material_schema();
  for_each_object(root, "materials",
                  [&](const JsonView& material, std::size_t) { check_slots(root, material, schema); });
  for_each_object(root, "textures", [&](const JsonView& texture, std::size_t) {
    (void)optional_reference(texture, "source", array_size(root, "images"), "image");
    for (const std::string_view name : kTextureSources)
      if (const auto other = extension(texture, name))
        (void)optional_reference(*other, "source", array_size(root, "images"), "image");
    (void)optional_reference(texture, "sampler", array_size(root, "samplers"), "sampler");
  });
  for_each_object(root, "samplers", [](const JsonView&, std::size_t) {});
  for_each_object(root, "images", [&](const JsonView& image, std::size_t) { check_image(root, image); });
  if (const auto variants = extension(root, "KHR_materials_variants"))
    for_each_object(*variants, "variants",
                    [](const JsonView& variant, std::size_t) { (void)variant.at("name").text(); });
}

}  // namespace relook
