// Colour trees compressed for a set of parameters (paper 3.3): of some ray trees, for each node that the parameters can
// reach the columns of its residual program, and how these nodes hang together. Evaluating it gives the colours of the
// trees for the parameters' current values, bit for bit as evaluating them whole. Made by Shader::compress(), kept and
// evaluated by replay/color_tree_store.h.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/math.h"
#include "color/compress/compressed_sum.h"
#include "color/expression/parameter_set.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Split programs by what may change in them, made on first use; thread-safe. There is one table for each set of
/// parameters.
class SplitTable {
 public:
  [[nodiscard]] const SplitProgram& get(const ColorProgram& program, const ChangingLeaves& leaves);

 private:
  std::mutex mutex_;
  std::map<std::pair<const ColorProgram*, ChangingLeaves>, std::unique_ptr<const SplitProgram>> splits_;
};

/// Nodes (or filters) that share a residual program and what its parameters point to.
struct CompressedBatch {
  const SplitProgram* program = nullptr;
  MaterialId material;
  bool are_filters = false;
  std::vector<std::uint32_t> out;                           // [lanes] slots for the results
  std::array<std::vector<std::uint32_t>, kBranches> child;  // [lanes] slots of changing children
  std::vector<std::pair<std::uint32_t, std::vector<LightLink>>>
      tints;  // by increasing place of a changing light in the light order: [lanes] slots of its filters
  StoredColumns columns;
  std::vector<CompressedSum> sums;  // of a program with sums: what lamps add

  [[nodiscard]] std::size_t lanes() const { return out.size(); }
  [[nodiscard]] std::size_t bytes() const;
};

/// The parameters that columns were evaluated with: the columns hold while none of them changes.
class Baked {
 public:
  /// Requires: read.lights are sorted, each once.
  void add(MaterialId material, const Dependencies& read);
  [[nodiscard]] bool depends_on(const ParameterSet& changed) const;
  /// Has add() noted the material? Then another structure of it would ask for other programs.
  [[nodiscard]] bool has(MaterialId material) const;

 private:
  std::vector<std::pair<MaterialId, FieldMask>> materials_;
  std::vector<LightId> lights_;  // sorted
  bool ambient_ = false, environment_ = false;
};

struct CompressedBlock {
  std::vector<std::uint32_t> roots;      // places in the given roots of trees that depend on the parameters, increasing
  std::uint32_t nodes = 0, filters = 0;  // numbers of slots; those of `roots` come first
  std::vector<std::pair<std::uint32_t, Rgba>> known_filters;  // slots of filters that do not depend on the parameters
  std::vector<CompressedBatch> batches;                       // filters first, then nodes, each after its children
  Baked baked;

  [[nodiscard]] std::size_t bytes() const;
  /// [roots]: their colours, which stay in memory.colors.nodes.
  [[nodiscard]] std::span<const Rgba> evaluate(const Scene& scene, ColorMemory& memory) const;
};

}  // namespace relook
