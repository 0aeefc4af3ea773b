// EXT_mesh_gpu_instancing: one local matrix per instance from the TRANSLATION, ROTATION and SCALE accessors.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_json.h"

namespace relook {
namespace {

constexpr std::size_t kMostInstances = std::size_t{1} << 24;

/// An attribute's numbers, `width` per instance; empty without the attribute.
std::vector<float> instance_values(const JsonView& attributes, const GltfModel& model, std::string_view semantic,
                                   std::size_t width, bool may_be_integer, ImportShare& share) {
  const auto place = member(attributes, semantic);
  if (!place) return {};
  const GltfAccessor& accessor = model.accessors[static_cast<std::size_t>(place->integer(0, INT64_MAX))];
  const bool is_signed = accessor.component == Component::i8 || accessor.component == Component::i16;
  const bool fits = accessor.width == width &&
                    (accessor.component == Component::f32 || (may_be_integer && accessor.normalized && is_signed));
  if (!fits) place->fail("the accessor's type is not one that this attribute may have");
  if (accessor.count > kMostInstances) place->fail("more than " + std::to_string(kMostInstances) + " instances");
  if (const auto fault = data_fault(model, accessor); !fault.empty()) place->fail(fault);
  share.add(ImportShare(accessor.count * (width * sizeof(float) + sizeof(Transform)), place->file(),
                        place->pointer() + ": the instances"));
  std::vector<float> values = read_floats(model, accessor);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(std::abs(values[i]) <= kLargestMatrix))
      place->fail("element " + std::to_string(i / width) + " is not finite or too large");
  return values;
}

/// Scale, then rotation, then translation. q: xyzw, any length but zero.
Transform composed(const float* t, const float* q, const float* s, const JsonView& place) {
  const double length = std::sqrt(
      static_cast<double>(q[0]) * static_cast<double>(q[0]) + static_cast<double>(q[1]) * static_cast<double>(q[1]) +
      static_cast<double>(q[2]) * static_cast<double>(q[2]) + static_cast<double>(q[3]) * static_cast<double>(q[3]));
  if (length < 1e-6) place.fail("a ROTATION quaternion is zero");
  const double x = static_cast<double>(q[0]) / length, y = static_cast<double>(q[1]) / length,
               z = static_cast<double>(q[2]) / length, w = static_cast<double>(q[3]) / length;
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                             {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                             {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
  Transform matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix[i][j] = static_cast<float>(rows[i][j] * static_cast<double>(s[i]));
  for (int j = 0; j < 3; ++j) matrix[3][j] = t[j];
  return matrix;
}

/// Where the axes go, as an export of relook has it beside rotations and scales, which need not come to the same bits;
/// nothing in other files.
std::array<std::vector<float>, 3> written_axes(const JsonView& attributes, const GltfModel& model, std::size_t count,
                                               ImportShare& share) {
  std::array<std::vector<float>, 3> axes;
  constexpr std::array<std::string_view, 3> kNames{"_RELOOK_X", "_RELOOK_Y", "_RELOOK_Z"};
  if (!std::ranges::all_of(kNames, [&](std::string_view name) { return attributes.has(name); })) return axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    axes[axis] = instance_values(attributes, model, kNames[axis], 3, false, share);
    if (axes[axis].size() != count * 3) attributes.fail("TRANSLATION and _RELOOK_X, _Y, _Z differ in count");
  }
  return axes;
}

std::vector<Transform> node_instances(const JsonView& attributes, const GltfModel& model, ImportShare& share) {
  const auto translations = instance_values(attributes, model, "TRANSLATION", 3, false, share);
  const auto rotations = instance_values(attributes, model, "ROTATION", 4, true, share);
  const auto scales = instance_values(attributes, model, "SCALE", 3, false, share);
  const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
  const auto fits = [&](const std::vector<float>& values, std::size_t width) {
    return values.empty() || values.size() == count * width;
  };
  if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3))
    attributes.fail("TRANSLATION, ROTATION and SCALE differ in count");
  constexpr float kNoTranslation[3] = {0, 0, 0}, kNoRotation[4] = {0, 0, 0, 1}, kNoScale[3] = {1, 1, 1};
  const auto axes = written_axes(attributes, model, count, share);
  std::vector<Transform> instances;
  instances.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    instances.push_back(composed(translations.empty() ? kNoTranslation : &translations[3 * i],
                                 rotations.empty() ? kNoRotation : &rotations[4 * i],
                                 scales.empty() ? kNoScale : &scales[3 * i], attributes));
  for (std::size_t axis = 0; axis < axes.size(); ++axis)
    for (std::size_t i = 0; i < axes[axis].size() / 3; ++i)
      std::copy_n(&axes[axis][3 * i], 3, instances[i][static_cast<int>(axis)]);
  return instances;
}

}  // namespace

std::vector<std::vector<Transform>> decode_instances(const Json& gltf, const GltfModel& model, const GltfUse& use,
                                                     std::string_view file, ImportShare& share) {
  std::vector<std::vector<Transform>> instances;
  std::size_t total = 0;
  for_each_object(JsonView(gltf, file), "nodes", [&](const JsonView& node, std::size_t i) {
    auto& of_node = instances.emplace_back();
    const auto instancing = extension(node, "EXT_mesh_gpu_instancing");
    if (!instancing || !node.has("mesh") || !use.nodes[i]) return;
    of_node = node_instances(instancing->at("attributes"), model, share);
    total += of_node.size();
    if (total > kMostInstances) node.fail("more than " + std::to_string(kMostInstances) + " instances in the file");
  });
  return instances;
}

}  // namespace relook
