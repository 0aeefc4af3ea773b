#include "color/compress/compress.h"

#include <algorithm>

#include "color/compress/compress_sums.h"
#include "color/node_programs.h"

namespace relook {
namespace {

/// What of the colours that a node combines may change, beside its own parameters.
struct ChangingBelow {
  WideLightSet tints;
  BranchSet children;
};

class Compressor {
 public:
  Compressor(const TreeBlock& block, std::span<const std::uint32_t> roots, const ParameterSet& parameters,
             const CompressContext& context)
      : block_(block), roots_(roots), parameters_(parameters), c_(context) {}

  CompressedBlock compress() {
    find_programs();
    find_changing();
    give_slots();
    evaluate_known();
    compress_filters();
    compress_nodes();
    return std::move(result_);
  }

 private:
  void find_programs() {
    for (const FilterNode& filter : block_.filters) filter_program_.push_back(c_.programs.number(block_, filter));
    for (const RayNode& node : block_.nodes) node_program_.push_back(c_.programs.number(block_, node));
    for (std::size_t i = 0; i < c_.programs.size(); ++i)
      reached_.push_back(parameters_.reaches(c_.programs.program(static_cast<std::uint32_t>(i))));
    const std::vector<LightId>& order = c_.scene.light_order();
    for (std::uint32_t place = 0; place < order.size(); ++place)
      if (parameters_.has(order[place])) changing_lamps_.push_back(place);
  }
  /// Does a node that adds whichever lamps reach it add one that changes?
  [[nodiscard]] bool adds_changing(std::size_t n) const {
    if (changing_lamps_.empty() || !c_.programs.program(node_program_[n]).program->dependencies.lamps) return false;
    const LightLink* links = block_.lights.data() + block_.nodes[n].first_light;
    return std::ranges::any_of(changing_lamps_, [&](std::uint32_t place) { return reaches(links[place].state); });
  }

  /// Nodes stand in preorder: children come after their parents.
  void find_changing() {
    for (const std::uint32_t program : filter_program_) filter_changes_.push_back(reached_[program]);
    node_changes_.resize(block_.nodes.size());
    below_.resize(block_.nodes.size());
    for (std::size_t n = block_.nodes.size(); n-- > 0;) {
      below_[n] = changing_below(block_.nodes[n]);
      node_changes_[n] = reached_[node_program_[n]] || adds_changing(n) || !below_[n].children.empty() ||
                         !below_[n].tints.empty();
    }
  }
  [[nodiscard]] ChangingBelow changing_below(const RayNode& node) const {
    ChangingBelow below;
    for (std::size_t b = 0; b < kBranches; ++b)
      if (node.child[b] != kNoNode && node_changes_[node.child[b]])
        below.children.add(static_cast<Branch>(b));
    if (node.object.is_none() || block_.filters.empty()) return below;
    for_each_tint(node, [&](std::uint32_t order, const LightLink& link) {
      for (std::uint32_t f = link.first; f < link.first + link.filters; ++f)
        if (filter_changes_[f]) below.tints.add(order);
    });
    return below;
  }
  template <class Visit>
  void for_each_tint(const RayNode& node, const Visit& visit) const {
    const std::size_t lights = c_.scene.light_order().size();
    for (std::uint32_t order = 0; order < lights; ++order)
      if (const LightLink& link = block_.lights[node.first_light + order]; link.state == ShadowState::filtered)
        visit(order, link);
  }

  void give_slots() {
    node_slot_.assign(block_.nodes.size(), kNoNode);
    filter_slot_.assign(block_.filters.size(), kNoNode);
    for (std::uint32_t k = 0; k < roots_.size(); ++k) {
      if (!node_changes_[roots_[k]]) continue;
      node_slot_[roots_[k]] = result_.nodes++;
      result_.roots.push_back(k);
    }
    for (std::size_t n = 0; n < block_.nodes.size(); ++n)
      if (node_changes_[n] && node_slot_[n] == kNoNode) node_slot_[n] = result_.nodes++;
    // The filters of one segment stand together in the block, and so do their slots.
    for (std::size_t n = 0; n < block_.nodes.size(); ++n)
      if (!below_[n].tints.empty())
        for_each_tint(block_.nodes[n], [&](std::uint32_t order, const LightLink& link) {
          if (!below_[n].tints.has(order)) return;
          for (std::uint32_t f = link.first; f < link.first + link.filters; ++f) filter_slot_[f] = result_.filters++;
        });
  }

  /// Evaluates the nodes and filters that do not change, in trees that do.
  void evaluate_known() {
    c_.memory.colors.filters.resize(block_.filters.size());
    c_.memory.colors.nodes.resize(block_.nodes.size());
    bool tree_changes = false;
    std::uint32_t generations = 0;
    std::vector<bool> is_known(block_.nodes.size()), is_known_filter(block_.filters.size());
    for (std::size_t n = 0; n < block_.nodes.size(); ++n) {
      const RayNode& node = block_.nodes[n];
      if (node.parent == kNoNode) tree_changes = node_changes_[n];
      if (!tree_changes) continue;
      is_known[n] = !node_changes_[n];
      if (is_known[n]) generations = std::max<std::uint32_t>(generations, node.ray.generation);
      if (node.object.is_none() || block_.filters.empty()) continue;
      for_each_tint(node, [&](std::uint32_t, const LightLink& link) {
        for (std::uint32_t f = link.first; f < link.first + link.filters; ++f) is_known_filter[f] = !filter_changes_[f];
      });
    }
    evaluate_batches(true, batches_of(block_.filters.size(), [&](std::size_t f) {
                       return is_known_filter[f] ? filter_program_[f] : kNoNode;
                     }));
    for (std::size_t f = 0; f < block_.filters.size(); ++f)
      if (!filter_changes_[f] && filter_slot_[f] != kNoNode)
        result_.known_filters.emplace_back(filter_slot_[f], c_.memory.colors.filters[f]);
    for (std::uint32_t generation = generations; generation > 1; --generation)
      evaluate_batches(false, batches_of(block_.nodes.size(), [&](std::size_t n) {
                         return is_known[n] && block_.nodes[n].ray.generation == generation ? node_program_[n]
                                                                                            : kNoNode;
                       }));
  }
  /// Indices by program; `program_of`: kNoNode leaves an index out.
  template <class ProgramOf>
  [[nodiscard]] std::map<std::uint32_t, std::vector<std::uint32_t>> batches_of(std::size_t count,
                                                                               const ProgramOf& program_of) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> batches;
    std::vector<std::uint32_t>* last = nullptr;
    std::uint32_t last_program = kNoNode;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t program = program_of(i);
      if (program == kNoNode) continue;
      if (program != last_program) last = &batches[program];
      last_program = program;
      last->push_back(static_cast<std::uint32_t>(i));
    }
    return batches;
  }
  void evaluate_batches(bool are_filters, const std::map<std::uint32_t, std::vector<std::uint32_t>>& batches) {
    for (const auto& [number, indices] : batches) {
      const BoundProgram& bound = c_.programs.program(number);
      evaluate(bound, c_.scene, block_, are_filters, indices, c_.memory);
      const Dependencies& read = bound.program->dependencies;
      result_.baked.add(bound.material, read.lamps ? with_lamps(read, c_.scene, block_, indices) : read);
    }
  }

  void compress_filters() {
    const auto batches = batches_of(block_.filters.size(),
                                    [&](std::size_t f) { return filter_changes_[f] ? filter_program_[f] : kNoNode; });
    for (const auto& [number, indices] : batches) {
      CompressedBatch batch = new_batch(number, {});
      batch.are_filters = true;
      for (const std::uint32_t f : indices) batch.out.push_back(filter_slot_[f]);
      keep(std::move(batch), number, true, indices);
    }
  }

  /// Nodes of one batch have all of this in common.
  struct BatchKey {
    std::uint32_t generation = 0, program = 0;
    BranchSet children;
    WideLightSet tints;
    bool operator==(const BatchKey&) const = default;
    bool operator<(const BatchKey& other) const {  // the deepest first
      return std::tuple(other.generation, program, children, tints) <
             std::tuple(generation, other.program, other.children, other.tints);
    }
  };
  void compress_nodes() {
    std::map<BatchKey, std::vector<std::uint32_t>> batches;
    std::vector<std::uint32_t>* last = nullptr;
    BatchKey last_key;
    for (std::uint32_t n = 0; n < block_.nodes.size(); ++n) {
      if (!node_changes_[n]) continue;
      WideLightSet tints = below_[n].tints;
      if (has_sums(node_program_[n]) && !tints.empty()) tints = WideLightSet::all();  // told apart lamp by lamp
      const BatchKey key{block_.nodes[n].ray.generation, node_program_[n], below_[n].children, tints};
      if (last == nullptr || key != last_key) last = &batches[key];
      last_key = key;
      last->push_back(n);
    }
    for (const auto& [key, indices] : batches) {
      CompressedBatch batch = new_batch(key.program, {key.tints, key.children});
      for (const std::uint32_t n : indices) batch.out.push_back(node_slot_[n]);
      note_children(batch, key.children, indices);
      if (!key.tints.empty() && !has_sums(key.program)) note_tints(batch, key.tints, indices);
      keep(std::move(batch), key.program, false, indices);
    }
  }
  void note_children(CompressedBatch& batch, BranchSet children, const std::vector<std::uint32_t>& indices) const {
    for (std::size_t b = 0; b < kBranches; ++b) {
      if (!children.has(static_cast<Branch>(b))) continue;
      for (const std::uint32_t n : indices) batch.child[b].push_back(node_slot_[block_.nodes[n].child[b]]);
    }
  }
  void note_tints(CompressedBatch& batch, WideLightSet tints, const std::vector<std::uint32_t>& indices) const {
    const std::size_t lights = c_.scene.light_order().size();
    for (std::uint32_t order = 0; order < lights; ++order) {
      if (!tints.has(order)) continue;
      auto& [light, links] = batch.tints.emplace_back();
      light = order;
      for (const std::uint32_t n : indices) {
        LightLink link = block_.lights[block_.nodes[n].first_light + order];
        if (link.state == ShadowState::filtered) link.first = filter_slot_[link.first];
        links.push_back(link);
      }
    }
  }

  [[nodiscard]] CompressedBatch new_batch(std::uint32_t number, const ChangingBelow& below) const {
    const BoundProgram& bound = c_.programs.program(number);
    const Dependencies& read = bound.program->dependencies;
    ChangingLeaves leaves;
    leaves.fields = parameters_.fields_of(bound.material) & read.material;
    for (const LightId light : read.lights)
      if (parameters_.has(light)) leaves.lights.push_back(light);
    leaves.lamps = read.lamps && !parameters_.lights.empty();
    leaves.ambient = parameters_.ambient && read.ambient;
    leaves.environment = parameters_.environment && read.environment;
    leaves.children = below.children;
    leaves.tints = below.tints;
    CompressedBatch batch;
    batch.program = &c_.splits.get(*bound.program, leaves);
    batch.material = bound.material;
    return batch;
  }
  [[nodiscard]] bool has_sums(std::uint32_t program) const {
    return !c_.programs.program(program).program->sums.empty();
  }
  void keep(CompressedBatch batch, std::uint32_t number, bool are_filters, const std::vector<std::uint32_t>& indices) {
    const NodeBatch nodes{c_.scene, block_, c_.memory.colors, are_filters, indices};
    if (has_sums(number)) {
      compress_sums(batch, c_.programs.program(number), nodes, {parameters_, filter_changes_, filter_slot_}, c_.memory,
                    result_.baked);
    } else {
      const Parameters parameters{c_.scene.scene(), batch.material};
      batch.columns =
          stored_columns(batch.program->constants, parameters, nodes, batch.lanes(), c_.memory.scratch);
      result_.baked.add(batch.material, batch.program->baked);
    }
    result_.batches.push_back(std::move(batch));
  }

  const TreeBlock& block_;
  std::span<const std::uint32_t> roots_;
  const ParameterSet& parameters_;
  const CompressContext& c_;
  std::vector<std::uint32_t> node_program_, filter_program_;
  std::vector<bool> reached_;  // by program number
  std::vector<std::uint32_t> changing_lamps_;  // places in the light order
  std::vector<bool> node_changes_, filter_changes_;
  std::vector<ChangingBelow> below_;
  std::vector<std::uint32_t> node_slot_, filter_slot_;
  CompressedBlock result_;
};

}  // namespace

CompressedBlock compress_block(const TreeBlock& block, std::span<const std::uint32_t> roots,
                               const ParameterSet& parameters, const CompressContext& context) {
  return Compressor(block, roots, parameters, context).compress();
}

}  // namespace relook
