// Atoms (paper 3.2): paths that differ only in which part of an atom they meet count as the same for groups and
// tunnels, so that these are fewer. Everything below stays exact: samples are told apart by their own paths.
#pragma once
#include <vector>

#include "scene/compile/state.h"
#include "trace/tree/path_cursor.h"

namespace relook {

/// By ObjectId, the object that stands for its atom: of the objects below one node at depth `depth` of the node
/// hierarchy (roots are at depth 1) the first; objects further up stand for themselves. Depth 0: every object does.
[[nodiscard]] std::vector<ObjectId> atoms_of(const SceneState& state, std::uint32_t depth);

class PathClasses {
 public:
  /// Without atoms each path is a class of its own.
  explicit PathClasses(bool has_atoms) : has_atoms_(has_atoms) {}
  /// Takes in the paths that the table has got since the last call. `atoms`: see atoms_of(); not read without atoms.
  void extend(const PathTable& paths, const PathLayout& layout, const std::vector<ObjectId>& atoms);
  void clear();

  [[nodiscard]] PathId of(PathId path) const { return has_atoms_ ? class_of_[path.index()] : path; }
  [[nodiscard]] std::size_t size() const { return has_atoms_ ? classes_.size() : paths_; }

 private:
  bool has_atoms_;
  std::size_t paths_ = 0;
  std::vector<PathId> class_of_;
  PathTable classes_;  // paths with the objects that stand for their atoms
};

}  // namespace relook
