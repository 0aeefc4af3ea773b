#include "color/shade.h"

#include <algorithm>
#include <mutex>
#include <unordered_map>

#include "base/hash.h"

namespace relook {
namespace {

NodeKey surface_key(const RayScene& scene, ObjectId id, bool inside) {
  const RayObject& object = scene.object(id);
  NodeKey key;
  key.kind = NodeKind::surface;
  key.material = scene.scene().object(id).material;
  key.inside = inside;
  key.vertex_colors = !object.mesh->colors.empty();
  key.interface_only = object.optics.volume && inside;
  return key;
}

NodeKey filter_key(const RayScene& scene, ObjectId id) {
  // The side is left open here: it depends on the hit, not on the path.
  NodeKey key = surface_key(scene, id, false);
  key.kind = NodeKind::filter;
  return key;
}

void note_light(NodeKey& key, LightId light, std::uint32_t order, ShadowState state) {
  if (state == ShadowState::open || state == ShadowState::filtered)
    key.lights.push_back({light, order, state == ShadowState::filtered});
}

NodeKey key_of(const RayScene& scene, const TreeBlock& block, const RayNode& node) {
  if (node.object.is_none()) return {};
  NodeKey key = surface_key(scene, node.object, node.point.inside);
  for (std::size_t b = 0; b < kBranches; ++b)
    if (node.child[b] != kNoNode) key.children = static_cast<std::uint8_t>(key.children | 1U << b);
  const auto& order = scene.scene().light_order;
  for (std::uint32_t light = 0; light < order.size(); ++light)
    note_light(key, order[light], light, block.lights[node.first_light + light].state);
  return key;
}

/// A short form of NodeKey that is cheap to make and compare: (material, flags), light states.
struct Signature {
  std::uint64_t surface = 0, lights = 0;
  bool operator==(const Signature&) const = default;
};
struct SignatureHash {
  std::size_t operator()(const Signature& s) const {
    return (s.surface * 0x9E3779B97F4A7C15ULL) ^ (s.lights * 0xC2B2AE3D27D4EB4FULL);
  }
};

/// Gives nodes dense program numbers within one block.
class Programs {
 public:
  Programs(const RayScene& scene, ProgramTable& table) : scene_(scene), table_(table) {}

  std::uint32_t number(const TreeBlock& block, const RayNode& node) {
    if (scene_.scene().light_order.size() > kMostSignatureLights) return number_of(key_of(scene_, block, node));
    const Signature signature = signature_of(block, node);
    return number(signature, [&] { return key_of(scene_, block, node); });
  }
  std::uint32_t number(const TreeBlock&, const FilterNode& filter) {
    Signature signature{surface_bits(filter.object, filter.point.inside, 0) | kFilterBit, 0};
    return number(signature, [&] {
      NodeKey key = filter_key(scene_, filter.object);
      key.inside = filter.point.inside;
      return key;
    });
  }
  [[nodiscard]] const BoundProgram& program(std::uint32_t number) const { return programs_[number]; }
  [[nodiscard]] std::size_t size() const { return programs_.size(); }

 private:
  static constexpr std::size_t kMostSignatureLights = 32;  // two bits each
  static constexpr std::uint64_t kFilterBit = std::uint64_t{1} << 63;

  [[nodiscard]] std::uint64_t surface_bits(ObjectId id, bool inside, std::uint64_t children) const {
    const RayObject& object = scene_.object(id);
    return std::uint64_t{scene_.scene().object(id).material.index()} << 16 | children << 8 | (inside ? 1U : 0U) |
           (object.mesh->colors.empty() ? 0U : 2U) | (object.optics.volume && inside ? 4U : 0U) | 8U;
  }
  [[nodiscard]] Signature signature_of(const TreeBlock& block, const RayNode& node) const {
    if (node.object.is_none()) return {};
    std::uint64_t children = 0;
    for (std::size_t b = 0; b < kBranches; ++b) children |= std::uint64_t{node.child[b] != kNoNode} << b;
    Signature signature{surface_bits(node.object, node.point.inside, children), 0};
    const std::size_t lights = scene_.scene().light_order.size();
    const LightLink* links = block.lights.data() + node.first_light;
    for (std::size_t light = 0; light < lights; ++light) {
      const ShadowState state = links[light].state;
      const std::uint64_t bits = state == ShadowState::open ? 1 : state == ShadowState::filtered ? 2 : 0;
      signature.lights |= bits << (2 * light);  // only how a light reaches the node counts
    }
    return signature;
  }
  /// The slow way, for scenes with more lights than a signature holds.
  std::uint32_t number_of(const NodeKey& key) {
    const auto [it, is_new] = key_numbers_.try_emplace(key, static_cast<std::uint32_t>(programs_.size()));
    if (is_new) programs_.push_back(table_.get(scene_.scene(), key));
    return it->second;
  }
  template <class MakeKey>
  std::uint32_t number(const Signature& signature, const MakeKey& make_key) {
    if (has_last_ && signature == last_) return last_number_;
    const auto [it, is_new] = numbers_.try_emplace(signature, static_cast<std::uint32_t>(programs_.size()));
    if (is_new) programs_.push_back(table_.get(scene_.scene(), make_key()));
    has_last_ = true;
    last_ = signature;
    last_number_ = it->second;
    return last_number_;
  }

  const RayScene& scene_;
  ProgramTable& table_;
  std::unordered_map<Signature, std::uint32_t, SignatureHash> numbers_;
  std::map<NodeKey, std::uint32_t> key_numbers_;
  std::vector<BoundProgram> programs_;
  bool has_last_ = false;
  Signature last_;
  std::uint32_t last_number_ = 0;
};

/// Indices sorted by batch, stable.
class Batches {
 public:
  /// Calls run(batch, indices) for each batch that occurs, in increasing order. `batch_of`: of index i, below
  /// `batches`.
  template <class Run>
  void for_each(std::span<const std::uint32_t> batch_of, std::size_t batches, const Run& run) {
    first_.assign(batches + 1, 0);
    for (std::uint32_t batch : batch_of) ++first_[batch + 1];
    for (std::size_t b = 0; b < batches; ++b) first_[b + 1] += first_[b];
    next_.assign(first_.begin(), first_.end() - 1);
    sorted_.resize(batch_of.size());
    for (std::size_t i = 0; i < batch_of.size(); ++i) sorted_[next_[batch_of[i]]++] = static_cast<std::uint32_t>(i);
    for (std::size_t b = 0; b < batches; ++b)
      if (first_[b] != first_[b + 1]) run(b, std::span(sorted_).subspan(first_[b], first_[b + 1] - first_[b]));
  }

 private:
  std::vector<std::uint32_t> first_, next_, sorted_;
};

}  // namespace

BoundProgram ProgramTable::get(const Scene& scene, const NodeKey& key) {
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

struct Shader::Impl {
  const RayScene& scene;
  Programs programs;
  BlockColors colors;
  Scratch scratch;
  Batches batches;
  std::vector<std::uint32_t> batch_of;

  Impl(const RayScene& s, ProgramTable& table) : scene(s), programs(s, table) {}

  void run(const TreeBlock& block, bool are_filters, std::size_t batch, std::span<const std::uint32_t> indices) {
    const auto number = static_cast<std::uint32_t>(batch % programs.size());
    evaluate(programs.program(number), scene, block, are_filters, indices, colors, scratch);
  }

  void shade_filters(const TreeBlock& block) {
    colors.filters.resize(block.filters.size());
    batch_of.clear();
    for (const FilterNode& filter : block.filters) batch_of.push_back(programs.number(block, filter));
    batches.for_each(batch_of, programs.size(), [&](std::size_t batch, std::span<const std::uint32_t> indices) {
      run(block, true, batch, indices);
    });
  }

  /// Deepest generation first.
  void shade_nodes(const TreeBlock& block) {
    colors.nodes.resize(block.nodes.size());
    batch_of.clear();
    std::uint32_t generations = 0;
    for (const RayNode& node : block.nodes) {
      batch_of.push_back(programs.number(block, node));
      generations = std::max<std::uint32_t>(generations, node.ray.generation);
    }
    const auto count = static_cast<std::uint32_t>(programs.size());
    for (std::size_t i = 0; i < batch_of.size(); ++i)
      batch_of[i] += (generations - block.nodes[i].ray.generation) * count;
    batches.for_each(
        batch_of, std::size_t{generations} * count,
        [&](std::size_t batch, std::span<const std::uint32_t> indices) { run(block, false, batch, indices); });
  }
};

Shader::Shader(const RayScene& scene, ProgramTable& programs) : impl_(std::make_unique<Impl>(scene, programs)) {}
Shader::~Shader() = default;

void Shader::shade(const TreeBlock& block, std::span<const std::uint32_t> roots, std::span<Rgba> out) {
  if (!block.filters.empty()) impl_->shade_filters(block);
  impl_->shade_nodes(block);
  for (std::size_t k = 0; k < roots.size(); ++k) out[k] = impl_->colors.nodes[roots[k]];
}

void append_keys(const RayScene& scene, std::span<const std::uint32_t> path, std::span<const LightId> lights,
                 std::uint32_t shadow_bits, std::vector<NodeKey>& keys) {
  for (PathCursor cursor(path, {lights.size(), shadow_bits}); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (node.is_miss()) {
      keys.emplace_back();
      continue;
    }
    NodeKey key = surface_key(scene, node.object(), node.inside());
    key.children = static_cast<std::uint8_t>(node.flags & 0xFU);
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
    keys.push_back(std::move(key));
  }
}

}  // namespace relook
