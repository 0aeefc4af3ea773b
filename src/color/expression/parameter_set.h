// A set of parameters of colour expressions: those whose values an edit changes, or may change again.
#pragma once
#include <utility>
#include <vector>

#include "color/expression/evaluate.h"

namespace relook {

struct ParameterSet {
  std::vector<std::pair<MaterialId, FieldMask>> materials;  // each once, in the order of their ids
  std::vector<LightId> lights;                              // their colour parameters, each once, in order
  bool ambient = false, environment = false;

  [[nodiscard]] bool empty() const { return materials.empty() && lights.empty() && !ambient && !environment; }
  bool operator==(const ParameterSet&) const = default;
  /// The fields of a material that are in the set.
  [[nodiscard]] FieldMask fields_of(MaterialId material) const;
  [[nodiscard]] bool has(LightId light) const;
  /// Are all of `others` in the set?
  [[nodiscard]] bool contains(const ParameterSet& others) const;
  void add(const ParameterSet& others);
  /// Does a program read any of them? Not counted: those of lamps that reach the node (Dependencies::lamps).
  [[nodiscard]] bool reaches(const BoundProgram& bound) const {
    return reaches(bound.material, bound.program->dependencies);
  }
  [[nodiscard]] bool reaches(MaterialId material, const Dependencies& read) const;
};

}  // namespace relook
