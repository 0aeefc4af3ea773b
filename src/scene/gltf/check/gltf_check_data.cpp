// Buffers, buffer views, accessors and mesh primitives: all ranges in checked 64-bit arithmetic.
#include <algorithm>
#include <array>
#include <limits>

#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/packed/gltf_unpack.h"

namespace relook {
namespace {

constexpr std::int64_t kMostBytes = std::int64_t{1} << 40;
constexpr std::int64_t kMostElements = std::int64_t{1} << 32;
/// Accessors without a buffer view are all zeros: nothing in the file bounds their size.
constexpr std::int64_t kMostZeroElements = std::int64_t{1} << 22;

constexpr std::array<std::int64_t, 6> kComponentTypes = {5120, 5121, 5122, 5123, 5125, 5126};

std::int64_t component_bytes(std::int64_t type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

std::int64_t component_type(const JsonView& owner, bool indices_only) {
  const JsonView place = owner.at("componentType");
  const std::int64_t type = place.integer(0, INT64_MAX);
  const bool is_known = std::ranges::find(kComponentTypes, type) != kComponentTypes.end();
  const bool is_index = type == 5121 || type == 5123 || type == 5125;
  if (!is_known || (indices_only && !is_index))
    place.fail("component type " + std::to_string(type) + " is not allowed here");
  return type;
}

/// Bytes of one element. Matrix columns start at multiples of 4, but the last one needs no padding after it.
struct ElementSize {
  std::int64_t spacing = 0, used = 0;
};
ElementSize element_size(const JsonView& accessor, std::int64_t component) {
  static constexpr std::array<std::string_view, 7> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  const std::size_t type = accessor.at("type").one_of(kTypes);
  const std::int64_t size = component_bytes(component);
  const auto width = static_cast<std::int64_t>(type < 4 ? type + 1 : type - 2);
  if (type < 4) return {size * width, size * width};
  const std::int64_t column = (width * size + 3) / 4 * 4;
  return {column * width, column * (width - 1) + width * size};
}

std::int64_t byte_offset(const JsonView& owner) {
  const auto offset = member(owner, "byteOffset");
  return offset ? offset->integer(0, kMostBytes) : 0;
}

struct ViewPart {
  std::int64_t offset = 0;  // in the buffer view
  std::int64_t count = 0;   // elements, at least 1
  ElementSize element;
  std::int64_t component = 0;
  bool may_stride = false;
};

/// `part` must lie inside the buffer view that `owner` names, aligned to its components.
void check_part(const JsonView& root, const JsonView& owner, const ViewPart& part) {
  const std::size_t index = reference(owner.at("bufferView"), array_size(root, "bufferViews"), "buffer view");
  const JsonView view = root.at("bufferViews").at(index);
  const std::int64_t view_bytes = view.at("byteLength").integer(1, kMostBytes);
  const auto stride_place = member(view, "byteStride");
  if (stride_place && !part.may_stride) owner.fail("the buffer view has a byteStride, which only vertex data may have");
  const std::int64_t stride = stride_place ? stride_place->integer(4, 252) : part.element.spacing;
  if (stride < part.element.spacing)
    owner.fail("elements of " + std::to_string(part.element.spacing) + " bytes do not fit the stride of " +
               std::to_string(stride));
  const std::int64_t component = component_bytes(part.component);
  if (part.offset % component != 0 || (byte_offset(view) + part.offset) % component != 0)
    owner.fail("is not aligned to its components of " + std::to_string(component) + " bytes");
  const std::int64_t end = part.offset + stride * (part.count - 1) + part.element.used;
  if (end > view_bytes)
    owner.fail("reaches to byte " + std::to_string(end) + " of a buffer view of " + std::to_string(view_bytes));
}

void check_sparse(const JsonView& root, const JsonView& accessor, std::int64_t count, std::int64_t component,
                  const ElementSize& element) {
  const auto sparse = member(accessor, "sparse");
  if (!sparse) return;
  const std::int64_t replaced = sparse->at("count").integer(1, count);
  const JsonView indices = sparse->at("indices"), values = sparse->at("values");
  const std::int64_t index_type = component_type(indices, true);
  const std::int64_t index_bytes = component_bytes(index_type);
  check_part(root, indices, {byte_offset(indices), replaced, {index_bytes, index_bytes}, index_type, false});
  check_part(root, values, {byte_offset(values), replaced, element, component, false});
}

/// `is_of_draco`: what is there without a buffer view is bounded where it is decoded.
void check_accessor(const JsonView& root, const JsonView& accessor, bool is_of_draco) {
  const std::int64_t component = component_type(accessor, false);
  const ElementSize element = element_size(accessor, component);
  const std::int64_t count = accessor.at("count").integer(1, kMostElements);
  if (const auto normalized = member(accessor, "normalized");
      normalized && normalized->boolean() && (component == 5126 || component == 5125))
    normalized->fail("only 8-bit and 16-bit components can be normalized");
  if (accessor.has("bufferView"))
    check_part(root, accessor, {byte_offset(accessor), count, element, component, true});
  else if (accessor.has("byteOffset"))
    accessor.at("byteOffset").fail("a byte offset without a buffer view");
  else if (count > kMostZeroElements && !is_of_draco)
    accessor.at("count").fail("at most " + std::to_string(kMostZeroElements) + " elements without a buffer view");
  check_sparse(root, accessor, count, component, element);
}

void check_buffer_view(const JsonView& root, const JsonView& view) {
  const std::size_t buffer_count = array_size(root, "buffers");
  const std::size_t buffer = reference(view.at("buffer"), buffer_count, "buffer");
  const std::int64_t buffer_bytes = root.at("buffers").at(buffer).at("byteLength").integer(1, kMostBytes);
  const std::int64_t length = view.at("byteLength").integer(1, kMostBytes);
  if (byte_offset(view) + length > buffer_bytes)
    view.fail("reaches to byte " + std::to_string(byte_offset(view) + length) + " of a buffer of " +
              std::to_string(buffer_bytes));
  if (const auto stride = member(view, "byteStride")) {
    if (stride->integer(4, 252) % 4 != 0) stride->fail("must be a multiple of 4");
    if (stride->integer(4, 252) > length) stride->fail("is larger than the buffer view");
  }
  check_meshopt_view(root, view);
}

/// POSITION, NORMAL, ...: all accessors of a primitive have the same count.
void check_primitive(const JsonView& root, const JsonView& primitive) {
  const std::size_t accessor_count = array_size(root, "accessors");
  const JsonView attributes = primitive.at("attributes");
  attributes.require_object();
  std::int64_t vertices = 0;
  for (const auto& [name, value] : attributes.value().items()) {
    const JsonView place = attributes.at(name);
    const std::size_t index = reference(place, accessor_count, "accessor");
    const std::int64_t count = root.at("accessors").at(index).at("count").integer(1, kMostElements);
    if (vertices != 0 && count != vertices)
      place.fail("has " + std::to_string(count) + " elements, another attribute has " + std::to_string(vertices));
    vertices = count;
  }
  if (const auto indices = optional_reference(primitive, "indices", accessor_count, "accessor")) {
    const JsonView accessor = root.at("accessors").at(*indices);
    if (!accessor.has("bufferView") && !draco_extension(primitive))
      primitive.at("indices").fail("indices need a buffer view");
    if (accessor.has("bufferView")) {
      const JsonView view =
          root.at("bufferViews").at(static_cast<std::size_t>(accessor.at("bufferView").integer(0, INT64_MAX)));
      if (view.has("byteStride")) primitive.at("indices").fail("the buffer view of indices may not have a byteStride");
    }
  }
  check_draco_primitive(root, primitive);
  if (const auto mode = member(primitive, "mode")) (void)mode->integer(0, 6);
  (void)optional_reference(primitive, "material", array_size(root, "materials"), "material");
  for_each(primitive, "targets", [&](const JsonView& target, std::size_t) {
    target.require_object();
    for (const auto& [name, value] : target.value().items())
      (void)reference(target.at(name), accessor_count, "accessor");
  });
}

/// KHR_materials_variants: every variant is mapped at most once by a primitive.
void check_variant_mappings(const JsonView& root, const JsonView& primitive) {
  const auto variants = extension(primitive, "KHR_materials_variants");
  if (!variants) return;
  const auto declared = extension(root, "KHR_materials_variants");
  const std::size_t variant_count = declared ? array_size(*declared, "variants") : 0;
  std::vector<bool> is_mapped(variant_count, false);
  for_each_object(*variants, "mappings", [&](const JsonView& mapping, std::size_t) {
    (void)reference(mapping.at("material"), array_size(root, "materials"), "material");
    mapping.at("variants").require_array();
    for_each(mapping, "variants", [&](const JsonView& place, std::size_t) {
      const std::size_t variant = reference(place, variant_count, "variant");
      if (is_mapped[variant]) place.fail("this variant is mapped twice");
      is_mapped[variant] = true;
    });
  });
}

}  // namespace

void check_data_layout(const JsonView& root) {
  for_each_object(root, "buffers", [&](const JsonView& buffer, std::size_t) {
    (void)buffer.at("byteLength").integer(1, kMostBytes);
    if (const auto uri = member(buffer, "uri")) (void)uri->text();
  });
  for_each_object(root, "bufferViews", [&](const JsonView& view, std::size_t) { check_buffer_view(root, view); });
  const std::vector<bool> are_of_draco = accessors_of_draco(root);
  for_each_object(root, "accessors", [&](const JsonView& accessor, std::size_t i) {
    check_accessor(root, accessor, are_of_draco[i]);
  });
}

void check_meshes(const JsonView& root) {
  for_each_object(root, "meshes", [&](const JsonView& mesh, std::size_t) {
    mesh.at("primitives").require_array();
    for_each_object(mesh, "primitives", [&](const JsonView& primitive, std::size_t) {
      check_primitive(root, primitive);
      check_variant_mappings(root, primitive);
    });
  });
}

}  // namespace relook
