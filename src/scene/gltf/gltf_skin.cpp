// Skins (glTF 2.0 section 3.7.3): their joints and inverse bind matrices.
#include <algorithm>
#include <cmath>

#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_json.h"

namespace relook {
namespace {

constexpr std::size_t kMostJoints = std::size_t{1} << 16;  // what JOINTS_n can name

std::vector<Transform> inverse_binds(const GltfModel& model, const JsonView& place, std::size_t joints) {
  const GltfAccessor& accessor = model.accessors[reference(place, model.accessors.size(), "accessor")];
  constexpr std::size_t kNumbers = 16;
  if (accessor.width != kNumbers || accessor.component != Component::f32)
    place.fail("inverse bind matrices must be 4x4 floats");
  if (accessor.count < joints)
    place.fail("has " + std::to_string(accessor.count) + " matrices for " + std::to_string(joints) + " joints");
  if (const auto fault = data_fault(model, accessor); !fault.empty()) place.fail(fault);
  const std::vector<float> numbers = read_floats(model, accessor);
  std::vector<Transform> matrices(joints);
  for (std::size_t i = 0; i < joints; ++i)
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) {
        const float number = numbers[i * kNumbers + static_cast<std::size_t>(row * 4 + column)];
        if (!(std::abs(number) <= kLargestMatrix))
          place.fail("matrix " + std::to_string(i) + " is not finite or too large");
        constexpr float kRounding = 1e-3F;
        const float affine = row == 3 ? 1.0F : 0.0F;
        if (column == 3 && std::abs(number - affine) > kRounding)
          place.fail("matrix " + std::to_string(i) + " is not affine: its fourth row must be 0 0 0 1");
        matrices[i][row][column] = column == 3 ? affine : number;
      }
  return matrices;
}

std::vector<std::size_t> joints_of(const JsonView& skin, std::size_t node_count) {
  const JsonView place = skin.at("joints");
  place.require_array();
  if (place.size() == 0) place.fail("a skin needs a joint");
  if (place.size() > kMostJoints) place.fail("more than " + std::to_string(kMostJoints) + " joints");
  std::vector<std::size_t> joints;
  for (std::size_t i = 0; i < place.size(); ++i) joints.push_back(reference(place.at(i), node_count, "node"));
  return joints;
}

}  // namespace

std::vector<std::vector<Transform>> decode_skins(Json& gltf, const GltfModel& model, std::string_view file,
                                                 std::vector<std::string>& warnings, ImportShare& share) {
  std::vector<std::vector<Transform>> skins;
  const JsonView root(gltf, file);
  const std::size_t node_count = array_size(root, "nodes");
  if (array_size(root, "skins") == 0) return skins;
  std::vector<bool> is_shown(node_count, false), is_used(array_size(root, "skins"), false);
  for (const std::size_t node : active_nodes(gltf)) {
    is_shown[node] = true;
    const JsonView place = root.at("nodes").at(node);
    if (const auto skin = member(place, "skin"); skin && place.has("mesh"))
      is_used[reference(*skin, is_used.size(), "skin")] = true;
  }
  for_each_object(root, "skins", [&](const JsonView& skin, std::size_t number) {
    (void)optional_reference(skin, "skeleton", node_count, "node");
    const std::vector<std::size_t> joints = joints_of(skin, node_count);
    const auto place = member(skin, "inverseBindMatrices");
    if (!is_used[number]) return void(skins.emplace_back());
    std::uint64_t matrices = joints.size();
    if (place) matrices += model.accessors[reference(*place, model.accessors.size(), "accessor")].count;
    share.add(ImportShare(bounded_product(matrices, sizeof(Transform)), file, skin.pointer() + ": the skin"));
    skins.push_back(place ? inverse_binds(model, *place, joints.size()) : std::vector<Transform>(joints.size()));
    const auto hidden = std::ranges::find_if(joints, [&](std::size_t joint) { return !is_shown[joint]; });
    if (hidden == joints.end()) return;
    skins.back().clear();
    warnings.push_back(skin.pointer() + ": the scene does not show joint node " + std::to_string(*hidden) +
                       ": the skin is left out");
  });
  if (const auto nodes = gltf.find("nodes"); nodes != gltf.end())
    for (Json& node : *nodes)
      if (const auto skin = node.find("skin"); skin != node.end() && skins[skin->get<std::size_t>()].empty())
        node.erase(skin);
  return skins;
}

}  // namespace relook
