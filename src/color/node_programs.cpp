// Keys of nodes and filters, from hits (node_programs.h) and from paths alone (append_keys() of shade.h), and the table
// of programs by key (ProgramTable of shade.h).
#include "color/node_programs.h"

#include <algorithm>
#include <mutex>

namespace relook {
namespace {

/// The key of a hit on an object, without lights and children.
NodeKey surface_key(const ColorScene& scene, ObjectId id, bool inside) {
  const RayObject& object = scene.object(id);
  NodeKey key;
  key.kind = NodeKind::surface;
  key.material = scene.scene().object(id).material;
  key.inside = inside;
  key.vertex_colors = !object.mesh->colors.empty();
  key.interface_only = object.optics.volume && inside;
  return key;
}

/// Adds a light to a key if it reaches the node. `order`: its place in the light order.
void note_light(NodeKey& key, LightId light, std::uint32_t order, ShadowState state) {
  if (reaches(state))
    key.lights.push_back({light, order, state == ShadowState::filtered});
}

NodeKey key_of(const ColorScene& scene, const TreeBlock& block, const RayNode& node) {
  if (node.object.is_none()) return {};
  NodeKey key = surface_key(scene, node.object, node.point.inside);
  key.children = children_of(node);
  const auto& order = scene.light_order();
  for (std::uint32_t light = 0; light < order.size(); ++light)
    note_light(key, order[light], light, block.lights[node.first_light + light].state);
  return key;
}

}  // namespace

NodeKey filter_key(const ColorScene& scene, ObjectId id) {
  NodeKey key = surface_key(scene, id, false);
  key.kind = NodeKind::filter;
  return key;
}

std::uint32_t NodePrograms::number(const TreeBlock& block, const RayNode& node) {
  const std::vector<LightId>& order = scene_.light_order();
  if (order.size() <= kMostTellingLights)
    return number(signature_of(block, node, order.size()),
                  [&] { return restricted(key_of(scene_, block, node), part_); });
  if (part_.all_lamps)
    return number(signature_of(block, node, 0), [&] {
      NodeKey key = key_of(scene_, block, node);
      key.sums = key.kind == NodeKind::surface;
      return restricted(std::move(key), part_);
    });
  Signature signature = signature_of(block, node, 0);
  if (!node.object.is_none() && lamp_place_ < order.size())
    signature.add_light(0, block.lights[node.first_light + lamp_place_].state);
  return number(signature, [&] { return restricted(key_of(scene_, block, node), part_); });
}

std::size_t NodePrograms::place_of_lamp() const {
  const std::vector<LightId>& order = scene_.light_order();
  return static_cast<std::size_t>(std::ranges::find(order, part_.lamp) - order.begin());
}

BoundProgram ProgramTable::get(const Scene& scene, const NodeKey& key) {
  if (key.sums && !key.lights.empty()) {
    NodeKey any = key;
    any.lights.clear();
    return get(scene, any);
  }
  {
    const std::shared_lock lock(mutex_);
    const auto it = bound_.find(key);
    if (it != bound_.end()) return it->second;
  }
  Shape shape{key.material.is_none() ? MaterialStructure{} : structure_of(scene.material(key.material)), key};
  shape.second.material = MaterialId::none();
  const std::unique_lock lock(mutex_);
  auto& program = programs_[shape];
  if (!program) program = std::make_unique<const ColorProgram>(build_program(scene, shape.first, shape.second));
  return bound_.try_emplace(key, BoundProgram{program.get(), key.material}).first->second;
}

void ProgramTable::forget(MaterialId material) {
  std::erase_if(bound_, [&](const auto& entry) { return entry.first.material == material; });
}
void ProgramTable::forget_environment() {
  std::erase_if(bound_, [](const auto& entry) { return entry.first.kind == NodeKind::environment; });
  std::erase_if(programs_, [](const auto& entry) { return entry.first.second.kind == NodeKind::environment; });
}
void ProgramTable::clear() {
  bound_.clear();
  programs_.clear();
}

void append_keys(const ColorScene& scene, std::span<const std::uint32_t> path, std::span<const LightId> lights,
                 std::uint32_t shadow_bits, std::vector<NodeKey>& keys) {
  for (PathCursor cursor(path, {lights.size(), shadow_bits}); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (node.is_miss()) {
      keys.emplace_back();
      continue;
    }
    NodeKey key = surface_key(scene, node.object, node.inside());
    key.children = node.branches();
    EntryReader entries(node.entries, shadow_bits);
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
      const ShadowState state = shadow_state(node.lights, light);
      note_light(key, lights[light], light, state);
      const LightEntry entry = entries.next(state);
      if (state != ShadowState::filtered) continue;
      for (const std::uint32_t object : entry.objects) {
        keys.push_back(filter_key(scene, ObjectId(object)));
        keys.push_back(keys.back());
        keys.back().inside = true;
      }
    }
    key.sums = lights.size() > kMostTellingLights;
    keys.push_back(std::move(key));
  }
}

}  // namespace relook
