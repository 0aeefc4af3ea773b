// Programs of the path integrator by key: built on first use, shared between materials of the same structure, run over
// many hits at once.
#pragma once
#include <map>
#include <memory>
#include <shared_mutex>
#include <span>
#include <vector>

#include "color/color_scene.h"
#include "color/expression/lanes.h"
#include "color/expression/program.h"
#include "color/path/path_key.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Its outputs: red, green and blue of every column, then those that stand alone.
struct PathProgram {
  Code code;  // of `light` the whole of it, textures and all
  std::vector<Value> outputs;
  Kernel kernel;
};

/// A program cut in two by what an edit of some fields of its material does not change: columns, and the rest.
struct PathSplit {
  Kernel constants;  // outputs: the columns; reads hits, of `light` the terms, too
  Kernel residual;   // reads columns as Op::column; outputs: the program's
};

/// A program and the material whose parameters its leaves read.
struct BoundPathProgram {
  std::shared_ptr<const PathProgram> program;
  MaterialId material;
};

/// Thread-safe. Programs hold no parameter values, so they outlive colour edits.
class PathPrograms {
 public:
  [[nodiscard]] BoundPathProgram get(const Scene& scene, const PathKey& key);
  /// Is to be called when the structure of a material may have changed. Not while another thread calls get().
  void forget(MaterialId material);

 private:
  using Shape = std::pair<MaterialStructure, PathKey>;  // the key has no material

  std::shared_mutex mutex_;
  std::map<PathKey, BoundPathProgram> bound_;
  std::map<Shape, std::shared_ptr<const PathProgram>> programs_;
};

/// `fields`: none of kMappingMask, since where textures are looked up is in the columns.
[[nodiscard]] std::shared_ptr<const PathSplit> split(const PathProgram& program, FieldMask fields);

/// A sample of a light at a hit, weighted for each lobe.
struct LightTerm {
  std::uint32_t node = 0;   // of the block
  std::uint32_t light = 0;  // place in the light order
  Direction way;            // unit, to the sample
  std::array<float, 4> weights{};  // of diffuse, specular, coat and transmitted lobe
  Color radiance;                  // at unit colour and intensity
  const float* columns = nullptr;  // of the node: what the program of its surface yields for that of lights
};

/// Nodes, filters or light terms that share a program, as what a kernel runs over.
struct PathBatch {
  const ColorScene& scene;
  const TreeBlock& block;
  bool are_filters = false;
  std::span<const std::uint32_t> hits;     // nodes or filters
  std::span<const LightTerm* const> terms;  // of the same nodes; empty: the program reads no light

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
            Scratch& scratch) const;
};

}  // namespace relook
