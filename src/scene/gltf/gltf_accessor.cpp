#include "scene/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace relook {
namespace {

const unsigned char* view_data(const GltfModel& model, std::size_t view, std::size_t offset) {
  return model.buffers[model.views[view].buffer].data() + model.views[view].offset + offset;
}

template <class Number>
Number load(const unsigned char* from) {
  Number number;
  std::memcpy(&number, from, sizeof number);
  return number;
}

template <class Number>
float as_float(Number number, bool normalized) {
  const auto value = static_cast<float>(number);
  if (!normalized) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<Number>::max()), -1.0F);
}

/// `count` elements of `width` numbers, `stride` bytes apart.
template <class Number>
void convert(const unsigned char* from, std::size_t stride, std::size_t count, std::size_t width, bool normalized,
             float* out) {
  for (std::size_t i = 0; i < count; ++i, from += stride)
    for (std::size_t c = 0; c < width; ++c) {
      const auto number = load<Number>(from + c * sizeof(Number));
      if constexpr (std::is_same_v<Number, float>)
        *out++ = number;
      else
        *out++ = as_float(number, normalized);
    }
}

void convert_elements(const GltfAccessor& accessor, const unsigned char* from, std::size_t stride, std::size_t count,
                      float* out) {
  const std::size_t width = accessor.width;
  const bool normalized = accessor.normalized;
  switch (accessor.component) {
    case Component::i8:
      return convert<std::int8_t>(from, stride, count, width, normalized, out);
    case Component::u8:
      return convert<std::uint8_t>(from, stride, count, width, normalized, out);
    case Component::i16:
      return convert<std::int16_t>(from, stride, count, width, normalized, out);
    case Component::u16:
      return convert<std::uint16_t>(from, stride, count, width, normalized, out);
    case Component::u32:
      return convert<std::uint32_t>(from, stride, count, width, false, out);
    case Component::f32:
      return convert<float>(from, stride, count, width, false, out);
  }
}

std::uint32_t load_index(const unsigned char* from, Component component) {
  switch (component) {
    case Component::u8:
      return *from;
    case Component::u16:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

std::size_t element_stride(const GltfModel& model, const GltfAccessor& accessor) {
  const std::size_t stride = model.views[accessor.view].stride;
  return stride != 0 ? stride : component_bytes(accessor.component) * accessor.width;
}

std::uint32_t sparse_index(const GltfModel& model, const GltfAccessor& accessor, std::size_t i) {
  const std::size_t bytes = component_bytes(accessor.sparse_index_component);
  return load_index(view_data(model, accessor.sparse_index_view, accessor.sparse_index_offset) + i * bytes,
                    accessor.sparse_index_component);
}

}  // namespace

std::size_t component_bytes(Component component) {
  switch (component) {
    case Component::i8:
    case Component::u8:
      return 1;
    case Component::i16:
    case Component::u16:
      return 2;
    default:
      return 4;
  }
}

std::vector<float> read_floats(const GltfModel& model, const GltfAccessor& accessor) {
  std::vector<float> values(accessor.count * accessor.width, 0.0F);
  if (accessor.view != kNoIndex)
    convert_elements(accessor, view_data(model, accessor.view, accessor.offset), element_stride(model, accessor),
                     accessor.count, values.data());
  const std::size_t bytes = component_bytes(accessor.component) * accessor.width;
  for (std::size_t i = 0; i < accessor.sparse_count; ++i)
    convert_elements(accessor, view_data(model, accessor.sparse_value_view, accessor.sparse_value_offset) + i * bytes,
                     bytes, 1, values.data() + sparse_index(model, accessor, i) * accessor.width);
  return values;
}

std::vector<float> read_floats(const GltfModel& model, const GltfAccessor& accessor,
                               std::span<const std::uint32_t> elements) {
  if (elements.size() == accessor.count) return read_floats(model, accessor);
  const std::size_t width = accessor.width;
  std::vector<float> values(elements.size() * width, 0.0F);
  if (accessor.view != kNoIndex) {
    const unsigned char* from = view_data(model, accessor.view, accessor.offset);
    const std::size_t stride = element_stride(model, accessor);
    for (std::size_t i = 0; i < elements.size(); ++i)
      convert_elements(accessor, from + elements[i] * stride, stride, 1, values.data() + i * width);
  }
  const std::size_t bytes = component_bytes(accessor.component) * width;
  for (std::size_t i = 0; i < accessor.sparse_count; ++i) {
    const auto found = std::ranges::lower_bound(elements, sparse_index(model, accessor, i));
    if (found == elements.end() || *found != sparse_index(model, accessor, i)) continue;
    convert_elements(accessor, view_data(model, accessor.sparse_value_view, accessor.sparse_value_offset) + i * bytes,
                     bytes, 1, values.data() + static_cast<std::size_t>(found - elements.begin()) * width);
  }
  return values;
}

std::vector<std::uint32_t> read_indices(const GltfModel& model, const GltfAccessor& accessor) {
  std::vector<std::uint32_t> values(accessor.count, 0);
  if (accessor.view != kNoIndex) {
    const unsigned char* from = view_data(model, accessor.view, accessor.offset);
    const std::size_t stride = element_stride(model, accessor);
    for (std::size_t i = 0; i < accessor.count; ++i) values[i] = load_index(from + i * stride, accessor.component);
  }
  const std::size_t bytes = component_bytes(accessor.component);
  for (std::size_t i = 0; i < accessor.sparse_count; ++i)
    values[sparse_index(model, accessor, i)] = load_index(
        view_data(model, accessor.sparse_value_view, accessor.sparse_value_offset) + i * bytes, accessor.component);
  return values;
}

std::string_view data_fault(const GltfModel& model, const GltfAccessor& accessor) {
  const auto has_data = [&](std::size_t view) { return !model.buffers[model.views[view].buffer].empty(); };
  const bool is_sparse = accessor.sparse_count > 0;
  if ((accessor.view != kNoIndex && !has_data(accessor.view)) ||
      (is_sparse && !(has_data(accessor.sparse_index_view) && has_data(accessor.sparse_value_view))))
    return kNoData;
  for (std::size_t i = 0; i < accessor.sparse_count; ++i) {
    const std::uint32_t index = sparse_index(model, accessor, i);
    if (index >= accessor.count) return "a sparse index is not below count";
    if (i > 0 && index <= sparse_index(model, accessor, i - 1)) return "sparse indices do not increase";
  }
  return {};
}

}  // namespace relook
