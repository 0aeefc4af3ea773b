// A wedge: a parameter and the values that it gets, a frame each; with a second parameter a grid, all pairs of values.
// A frame's edit is made when it is asked for: a wedge takes the memory of its text, whatever its count.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"
#include "edit/patch_operation.h"

namespace relook {

/// How the values of a range follow each other.
enum class RangeScale : std::uint8_t {
  linear,  // by equal differences
  log,     // by equal ratios: from and to are above 0
};

/// One parameter of a wedge, with a list of values or a range.
struct WedgeAxis {
  std::string path;
  std::string label;                // what people call the parameter; "": nothing
  std::vector<Json> values;         // empty for a range
  std::vector<std::string> labels;  // of the values; empty: none is given
  Json from, to;                    // a range: numbers or arrays of as many numbers
  RangeScale scale = RangeScale::linear;
  double step = 0;        // between the values of a range, added or (log) multiplied; 0: `count` of them end at `to`
  std::size_t count = 0;  // of values
  std::string where;      // "/steps/3/wedge", "/steps/3/wedge/1"

  /// The value with a number from 0. Ranges of rotations turn about one axis at an even rate (slerp), the shorter way.
  [[nodiscard]] Json value(std::size_t i) const;
  /// Its label, or what it is in few characters: "0.25", "0.8, 0.2, 0.1", "Studio".
  [[nodiscard]] std::string text(std::size_t i) const;
  [[nodiscard]] PatchOperation operation(std::size_t i) const;
};

struct Wedge {
  std::vector<WedgeAxis> axes;  // one, or two: rows, which vary slowest, and columns

  [[nodiscard]] bool empty() const { return axes.empty(); }
  [[nodiscard]] std::size_t size() const;  // frames
  /// The place along an axis of a frame, from 0.
  [[nodiscard]] std::size_t place(std::size_t frame, std::size_t axis) const;
  /// A "replace" for each axis.
  [[nodiscard]] Edit operator[](std::size_t frame) const;

  /// Of a frame, an object an axis: {"path", "label", "text", "value" unless it is long}.
  [[nodiscard]] Json values_json(std::size_t frame) const;
  /// An object an axis: {"path", "label", "texts"}; of more than 1,000 values no texts.
  [[nodiscard]] Json axes_json() const;
};

}  // namespace relook
