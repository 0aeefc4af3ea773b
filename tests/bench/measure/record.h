// All figures of a benchmark, to be summed up and written as JSON and HTML beside the text that each measure prints.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

/// What a figure is to reach (the project's own goals and the paper's ratios).
struct Goal {
  double value = 0;
  bool is_most = false;  // at most; else at least
};

struct Figure {
  std::string scene;               // "garden 1920x1080, 1 sample(s)"
  std::string table, row, column;  // "Table 3, colour rows", "ground color", "full render / later edit"
  double value = 0;
  std::string unit, paper;  // "ms"; what the paper has, or ""
  std::optional<Goal> goal = std::nullopt;
  [[nodiscard]] bool is_reached() const;  // true without a goal
};

class Record {
 public:
  /// Of all figures from here on. `has_goals`: else their goals are left out.
  void begin(std::string scene, bool has_goals) {
    scene_ = std::move(scene);
    has_goals_ = has_goals;
  }
  void add(Figure figure);
  /// The figures that have a goal, one a line.
  void print_goals() const;
  [[nodiscard]] Json json() const;
  [[nodiscard]] std::string html() const;

 private:
  std::string scene_;
  bool has_goals_ = true;
  std::vector<Figure> figures_;
};

}  // namespace relook
