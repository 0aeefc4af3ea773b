// Terms of light that are kept for the next edit of the same parameters (paper 3.3): of some ray trees, all that such
// an edit changes. A term is the weight of its node's light on the way to the eye times what the node has of unit
// light; both are products, of factors that stay and of some that residual programs yield: weights of rays, what hits
// make of light, tints of what stands on shadow segments, coverage. Multiplied in the order of shading, for two scenes,
// they give the terms to take out of sums and those to put in, bit for bit. Made by PathShader, evaluated by
// replay/path.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "color/compress/stored_columns.h"
#include "color/expression/parameter_set.h"
#include "color/path/path_programs.h"
#include "color/path/sum_places.h"
#include "light/sums/tile_sums.h"

namespace relook {

/// A factor of KeptTerms: one that stays, or one that the edit may change.
class FactorId {
 public:
  [[nodiscard]] static FactorId constant(std::size_t place) {
    return FactorId(static_cast<std::uint32_t>(place) | kConstant);
  }
  [[nodiscard]] static FactorId yielded(std::size_t place) { return FactorId(static_cast<std::uint32_t>(place)); }

  [[nodiscard]] bool is_constant() const { return (bits_ & kConstant) != 0; }
  /// Among those of its kind.
  [[nodiscard]] std::uint32_t place() const { return bits_ & ~kConstant; }

 private:
  static constexpr std::uint32_t kConstant = 0x80000000U;
  explicit FactorId(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};
static_assert(sizeof(FactorId) == 4);

struct KeptTerms {
  /// A node with terms that may change, or one above it; parents first.
  struct Node {
    std::uint32_t parent;  // kNoNode: nothing changes above it
    FactorId weight;       // of what comes from there to its parent; without one: to the eye
    std::uint16_t pixel = 0;
    std::uint16_t terms = 0;  // how many of `units` are its
  };
  /// A term whose unit light changes.
  struct Product {
    std::uint32_t node = 0;
    FactorId first;            // of its unit light's factors
    std::uint16_t more = 0;    // how many of `more_factors` follow
    std::uint16_t source = 0;  // as below
  };
  /// What the eye's straight ray adds to the coverage of its pixel.
  struct Opening {
    std::uint32_t parent =
        kNoNode;  // among openings: the one before it on the ray; kNoNode: `share` of the ray gets here
    float share = 1;
    FactorId coverage;
    std::uint16_t pixel = 0;
  };
  /// Hits, terms of lights or filters that share a residual program.
  struct Batch {
    std::shared_ptr<const PathSplit> program;
    MaterialId material;
    std::size_t lanes = 0;
    StoredColumns columns;
    std::vector<float> scales{};  // by lane: multiplies what the program yields; empty: nothing does
    /// Triples that a lane yields, the next factors of their kind.
    [[nodiscard]] std::size_t width() const { return program->residual.outputs.size() / 3; }
  };

  std::vector<Color> constants;
  std::vector<Batch> batches;
  std::vector<Node> nodes;
  // Terms that change by their node's weight alone, in the order of nodes. Source: SumPlaces tells whose light it is.
  std::vector<Color> units;
  std::vector<std::uint16_t> sources;
  std::vector<Product> products;
  std::vector<FactorId> more_factors;  // in the order of products
  std::vector<Opening> openings;       // in the order of the ray

  [[nodiscard]] std::size_t bytes() const;
};

/// Of one tile.
struct TileTerms {
  ParameterSet parameters;        // of materials alone
  std::vector<KeptTerms> blocks;
  std::uint64_t samples = 0;      // whose terms these are
  [[nodiscard]] bool empty() const { return parameters.empty(); }
  [[nodiscard]] std::size_t bytes() const;
};

/// Memory to evaluate in: of the scene before, and of that after.
struct TermMemory {
  std::array<std::vector<Color>, 2> factors;  // that batches yield
  std::array<std::vector<Color>, 2> weights;  // by node, to the eye
  std::array<std::vector<float>, 2> shares;   // by opening
  Scratch scratch;
};

/// The columns of a surface behind its branches.
enum class OwnColumn : std::uint32_t { emission, ambient, unlit, coverage };

/// Takes out of `sums` what the terms are in `before`, puts in what they are in `after`. Terms that stay are not
/// touched. `places`: of both scenes.
void exchange_terms(const KeptTerms& kept, const Scene& before, const Scene& after, const SumPlaces& places,
                    TermMemory& memory, TileSums& sums);

}  // namespace relook
