// Accessor data as numbers (glTF 2.0 section 3.6): interleaved, normalized and sparse accessors read alike.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scene/gltf/gltf_model.h"

namespace relook {

/// 1, 2 or 4.
[[nodiscard]] std::size_t component_bytes(Component component);

/// All elements, `accessor.width` floats each; integers converted, normalized ones divided. May contain non-finite
/// values. Requires: no matrix.
[[nodiscard]] std::vector<float> read_floats(const GltfModel& model, const GltfAccessor& accessor);

/// The same of some elements only. Requires: `elements` increase and are below the accessor's count.
[[nodiscard]] std::vector<float> read_floats(const GltfModel& model, const GltfAccessor& accessor,
                                             std::span<const std::uint32_t> elements);

/// A SCALAR accessor of an unsigned type.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const GltfModel& model, const GltfAccessor& accessor);

inline constexpr std::string_view kNoData = "the accessor's buffer has no data";
/// Empty, or why the accessor cannot be read: its buffer is a placeholder, or its sparse indices do not increase or
/// reach count. Must be empty before the functions above are called.
[[nodiscard]] std::string_view data_fault(const GltfModel& model, const GltfAccessor& accessor);

}  // namespace relook
