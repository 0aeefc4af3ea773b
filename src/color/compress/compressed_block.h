// Colour trees compressed for a set of parameters (paper 3.3): of some ray trees, for each node that the parameters can
// reach the columns of its residual program, and how these nodes hang together. Evaluating it gives the colours of the
// trees for the parameters' current values, bit for bit as evaluating them whole.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/math.h"
#include "color/compress/split.h"
#include "color/expression/parameter_set.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Split programs by what may change in them; thread-safe. One for each set of parameters.
class SplitTable {
 public:
  [[nodiscard]] const SplitProgram& get(const ColorProgram& program, const ChangingLeaves& leaves);

 private:
  std::mutex mutex_;
  std::map<std::pair<const ColorProgram*, ChangingLeaves>, std::unique_ptr<const SplitProgram>> splits_;
};

/// Nodes (or filters) that share a residual program and what its parameters point to.
struct CompressedBatch {
  /// Where a column's values are, or the one that all lanes share.
  struct Stored {
    std::uint32_t first = kShared;  // vector, into values
    float shared = 0;
  };
  static constexpr std::uint32_t kShared = 0xFFFFFFFFU;
  struct alignas(64) Vector {
    std::array<float, kVectorLanes> lanes;
  };

  const SplitProgram* program = nullptr;
  MaterialId material;
  bool are_filters = false;
  std::vector<std::uint32_t> out;                           // [lanes] slots for the results
  std::array<std::vector<std::uint32_t>, kBranches> child;  // [lanes] slots of changing children
  std::vector<std::pair<std::uint32_t, std::vector<LightLink>>>
      tints;  // by place of a changing light, in order: [lanes] filters
  std::vector<Stored> columns;
  std::vector<Vector> values;  // one column after the other, rounded up to whole vectors

  [[nodiscard]] std::size_t lanes() const { return out.size(); }
  [[nodiscard]] std::size_t bytes() const;
};

/// What evaluated columns depend on: they hold while none of it changes.
class Baked {
 public:
  /// Requires: of its lights each once, in order.
  void add(MaterialId material, const Dependencies& read);
  [[nodiscard]] bool depends_on(const ParameterSet& changed) const;
  /// Is the material met at all, so that another structure of it would ask for other programs?
  [[nodiscard]] bool has(MaterialId material) const;

 private:
  std::vector<std::pair<MaterialId, FieldMask>> materials_;
  std::vector<LightId> lights_;  // in order
  bool ambient_ = false, environment_ = false;
};

struct CompressedBlock {
  std::vector<std::uint32_t> roots;      // which trees of the block depend on the parameters, increasing
  std::uint32_t nodes = 0, filters = 0;  // slots; those of `roots` come first
  std::vector<std::pair<std::uint32_t, Rgba>> known_filters;  // slots of filters that do not depend on the parameters
  std::vector<CompressedBatch> batches;                       // filters first, then nodes, each after its children
  Baked baked;

  [[nodiscard]] std::size_t bytes() const;
  /// The colours of `roots`, in memory.colors.nodes: they come first.
  [[nodiscard]] std::span<const Rgba> evaluate(const Scene& scene, ColorMemory& memory) const;
};

/// Stores the outputs of a batch's constants as columns. `nodes`: of the batch.
void store_columns(CompressedBatch& batch, const Scene& scene, const NodeBatch& nodes, Scratch& scratch);

}  // namespace relook
