// From ray trees to colours (paper 2.1): gives every node its program, batches nodes that share one, and evaluates
// generation by generation, the deepest first, a parent combining its children. What a colour is: SHADING.md. Called by
// render and preprocess (image/render.cpp) and, for the samples that an edit reaches, by replay/.
#pragma once
#include <map>
#include <memory>
#include <shared_mutex>
#include <span>
#include <vector>

#include "color/compress/compressed_block.h"
#include "color/expression/evaluate.h"
#include "color/surface/illumination.h"
#include "trace/tree/path_cursor.h"

namespace relook {

/// Programs by key, built on first use and shared between materials of the same structure; thread-safe. Programs hold
/// no parameter values, so they outlive colour edits.
class ProgramTable {
 public:
  /// The program for a node of this key. `scene`: as it is now; a program that is not there yet is built from it.
  [[nodiscard]] BoundProgram get(const Scene& scene, const NodeKey& key);
  /// The three are to be called when the structure of a material, the environment's image, or the lights may have
  /// changed. Not while another thread calls get().
  void forget(MaterialId material);
  void forget_environment();
  void clear();

 private:
  using Shape = std::pair<MaterialStructure, NodeKey>;  // the key has no material

  std::shared_mutex mutex_;
  std::map<NodeKey, BoundProgram> bound_;
  std::map<Shape, std::unique_ptr<const ColorProgram>> programs_;
};

/// Evaluates blocks of ray trees. Keeps its working memory and what it has looked up between calls; one per thread.
class Shader {
 public:
  /// The scene and the table's programs must not change while the shader lives.
  Shader(const ColorScene& scene, ProgramTable& programs);
  ~Shader();
  /// Colours of the samples in `block`: out[k] is that of the tree rooted at node roots[k].
  void shade(const TreeBlock& block, std::span<const std::uint32_t> roots, std::span<Rgba> out);
  /// Compresses the trees rooted at `roots` that depend on `parameters`. The result holds pointers into `splits`.
  /// Requires: `parameters` has no field of kMappingMask, by which textures are looked up elsewhere.
  [[nodiscard]] CompressedBlock compress(const TreeBlock& block, std::span<const std::uint32_t> roots,
                                         const ParameterSet& parameters, SplitTable& splits);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Appends the keys of all nodes and filters of a path to `keys`: with them the colours that an edit can change are
/// found from paths alone. `lights`, `shadow_bits`: the light order and the counters with which the path was recorded.
void append_keys(const ColorScene& scene, std::span<const std::uint32_t> path, std::span<const LightId> lights,
                 std::uint32_t shadow_bits, std::vector<NodeKey>& keys);

}  // namespace relook
