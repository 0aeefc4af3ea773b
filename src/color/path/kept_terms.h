// Terms of light that are kept for the next edit of the same parameters (paper 3.3): of some ray trees, what of each
// term an edit of these parameters of opaque materials does not change. Evaluating it for two scenes gives the terms to
// take out of sums and those to put in, bit for bit as shading the trees does. Made by PathShader, evaluated by
// replay/path.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "color/compress/stored_columns.h"
#include "color/expression/parameter_set.h"
#include "color/path/path_programs.h"
#include "light/sums/tile_sums.h"

namespace relook {

/// Where a term goes: of which node's light it is, into which sum.
struct TermPlace {
  std::uint32_t node = 0;  // of KeptTerms
  std::uint16_t pixel = 0, sum = 0;
};

struct KeptTerms {
  /// A hit of a material whose parameters change, or a node below one; parents first.
  struct Node {
    std::uint32_t parent = kNoNode;  // kNoNode: no such hit is above
    Color weight;                    // of what comes from there to the eye; with a parent: to that
  };
  /// A term that changes by its node's weight alone.
  struct Term {
    TermPlace place;
    Color unit;
  };
  /// Hits of such materials that share a residual program, which gives the weights of their children, then what of
  /// emission gets out, ambient light, unlit colour, coverage.
  struct Hits {
    std::shared_ptr<const PathSplit> program;
    MaterialId material;
    std::uint32_t branches = 0;              // of each
    std::vector<std::uint32_t> children;     // [lanes * branches] nodes
    StoredColumns columns;
    std::size_t lanes = 0;
  };
  /// A term of such a hit's own.
  struct OwnTerm {
    TermPlace place;
    std::uint32_t hits = 0, lane = 0;  // whose
    std::uint32_t column = 0;          // behind the branches
    Color factor;
  };
  /// Terms of lights at such hits that share a residual program.
  struct LitHits {
    std::shared_ptr<const PathSplit> program;
    MaterialId material;
    std::vector<TermPlace> places;        // [lanes]
    std::vector<std::uint32_t> first_tint;  // [lanes + 1] into tints
    std::vector<Color> tints;
    StoredColumns columns;
  };

  std::vector<Node> nodes;
  std::vector<Term> terms;
  std::vector<Hits> hits;
  std::vector<OwnTerm> own_terms;
  std::vector<LitHits> lit_hits;

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

/// Memory to evaluate in.
struct TermMemory {
  std::array<std::vector<Color>, 2> weights;  // by node
  std::array<std::vector<std::vector<Color>>, 2> own;  // by batch of hits: [lanes * kOwnColumns]
  std::array<std::vector<Color>, 2> lit;      // of a batch
  Scratch scratch;
};

/// Columns of a surface behind its branches that bring terms: emission, ambient light, unlit colour.
inline constexpr std::size_t kOwnColumns = 3;

/// Takes out of `sums` what the terms are in `before`, puts in what they are in `after`. Terms that stay are not touched.
void exchange_terms(const KeptTerms& kept, const Scene& before, const Scene& after, TermMemory& memory, TileSums& sums);

}  // namespace relook
