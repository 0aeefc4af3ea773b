// Runs side by side, from their reports: a row for each step, a column for each run, as in Table 3 of the paper. For
// `relook compare`: its JSON, its text and its page.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"

namespace relook {

/// What a table shows of a step: its name, and the JSON pointer to it in the step's entry of the report.
struct Measure {
  std::string_view name, pointer;
  bool is_time = false;  // seconds, which differ from run to run; all else is counted
};
inline constexpr std::array<Measure, 15> kMeasures{{{"seconds", "/seconds/total", true},
                                                    {"classify", "/seconds/classify", true},
                                                    {"select", "/seconds/select", true},
                                                    {"test", "/seconds/test", true},
                                                    {"update", "/seconds/update", true},
                                                    {"evaluate", "/seconds/evaluate", true},
                                                    {"write", "/seconds/write", true},
                                                    {"samples_affected", "/samples_affected"},
                                                    {"pixels_changed", "/pixels_changed"},
                                                    {"ray_tests", "/ray_tests"},
                                                    {"ray_tests_culled", "/ray_tests_culled"},
                                                    {"ray_updates", "/ray_updates"},
                                                    {"shadow_updates", "/shadow_updates"},
                                                    {"color_trees_evaluated", "/color_trees_evaluated"},
                                                    {"resident_bytes", "/resident/total"}}};

struct RunSteps {
  struct Step {
    std::string label, name, change_class;  // label: "3", or "3_01" for a frame of a drag or wedge
    std::array<double, kMeasures.size()> values{};
  };
  std::string run, scene_hash, journal_hash;
  std::map<std::string, std::string> settings;  // options, resolution, samples, threads
  std::optional<double> full_render_seconds;
  std::vector<Step> steps;
};

/// Reads RUN/report.json; none when there is no such file. Throws InputError when it is not a report.
[[nodiscard]] std::optional<RunSteps> read_run_steps(const std::filesystem::path& run);

struct RunTable {
  struct Column {
    std::string run;
    std::map<std::string, std::string> settings;  // those that are not the same in all runs
    std::optional<double> full_render_seconds;
  };
  struct Row {
    std::string label, name, change_class;                                    // as in the first run that has it
    std::vector<std::optional<std::array<double, kMeasures.size()>>> values;  // [columns]
  };
  std::vector<Column> columns;
  std::vector<Row> rows;
  bool has_one_journal = true, has_one_scene = true;
  /// Whether a measure has the same value in all runs, for each step.
  [[nodiscard]] bool is_same(std::size_t measure) const;
};

[[nodiscard]] RunTable run_table(const std::vector<RunSteps>& runs);
[[nodiscard]] Json run_table_json(const RunTable& table);

}  // namespace relook
