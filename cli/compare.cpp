// `relook compare`: frames or runs against the first one, printed and, if asked for, as JSON and as a page.
#include <algorithm>
#include <array>

#include "compare_text.h"
#include "input/compare_inputs.h"
#include "page/compare_page.h"
#include "report/run_table.h"
#include "verbs.h"

namespace relook {
namespace {

Json pair_json(const std::string& a, const std::string& b, const PairComparison& pair) {
  Json frames = Json::object();
  for (const auto& [name, comparison] : pair.frames) frames[printable(name)] = comparison_json(comparison);
  Json missing = Json::array();
  for (const std::string& name : pair.missing) missing.push_back(printable(name));
  Json total = difference_json(pair.total);
  total["layers_different"] = pair.layers_different;
  return {{"a", a},
          {"b", b},
          {"total", std::move(total)},
          {"frames", std::move(frames)},
          {"missing", std::move(missing)},
          {"verdict", verdict_name(pair.verdict)}};
}

void print_pair(const PairComparison& pair, const std::string& prefix, bool are_folders, Console& console) {
  for (const std::string& name : pair.missing) console.line(prefix + printable(name) + ": in one run only");
  for (const auto& [name, comparison] : pair.frames)
    for (const std::string& line : comparison_text(prefix + printable(name), comparison)) console.line(line);
  if (!are_folders) return;
  const std::string layers =
      pair.layers_different > 0 ? ", in " + std::to_string(pair.layers_different) + " layers" : "";
  console.line(difference_text(prefix + "total", pair.total) + layers);
}

void warn_of_pair(const PairComparison& pair, const Arguments& arguments, const std::string& b, Console& console) {
  std::vector<std::string> warnings;
  for (const auto& [name, comparison] : pair.frames) {
    const std::array counts{comparison.not_finite_a, comparison.not_finite_b};
    const std::array inputs{arguments.inputs[0], b};
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (counts[i] > 0)
        warnings.push_back(inputs[i] + ": " + name + ": " + std::to_string(counts[i]) + " pixels are not finite");
    if (comparison.verdict == Verdict::warning) warnings.push_back(b + ": " + name + ": above a threshold of --warn");
  }
  console.warn(warnings);
}

std::string column_name(std::size_t column) { return std::string(1, static_cast<char>('A' + column)); }

std::string padded(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

constexpr std::size_t kCellWidth = 12;

void print_measure(const RunTable& table, std::size_t measure, Console& console) {
  std::string head = padded(std::string(kMeasures[measure].name), kCellWidth * 2);
  for (std::size_t column = 0; column < table.columns.size(); ++column) head += padded(column_name(column), kCellWidth);
  console.line(head);
  std::vector<double> sums(table.columns.size());
  const auto print_row = [&](const std::string& label, const auto& cell, const std::string& note) {
    std::string line = padded(label, kCellWidth * 2);
    for (std::size_t column = 0; column < table.columns.size(); ++column) line += padded(cell(column), kCellWidth);
    console.line(line + note);
  };
  const bool is_time = kMeasures[measure].is_time;
  const auto number = [&](double value) {
    return is_time ? short_number(value) : std::to_string(static_cast<std::uint64_t>(value));
  };
  for (const RunTable::Row& row : table.rows) {
    const auto cell = [&](std::size_t column) {
      if (column >= row.values.size() || !row.values[column]) return std::string("-");
      sums[column] += (*row.values[column])[measure];
      return number((*row.values[column])[measure]);
    };
    print_row(row.label + " " + row.change_class, cell, "  " + printable(row.name));
  }
  if (kMeasures[measure].name != "resident_bytes")
    print_row(
        "all", [&](std::size_t column) { return number(sums[column]); }, "");
}

/// Seconds, and those counters that are not the same in all runs.
void print_table(const RunTable& table, Console& console) {
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    std::string line = column_name(column) + ": " + printable(table.columns[column].run);
    for (const auto& [name, value] : table.columns[column].settings) line += ", " + name + " " + printable(value);
    if (const auto& seconds = table.columns[column].full_render_seconds)
      line += ", full render " + short_number(*seconds) + " s";
    console.line(line);
  }
  std::string same;
  for (std::size_t measure = 0; measure < kMeasures.size(); ++measure) {
    if (measure == 0 || (!kMeasures[measure].is_time && !table.is_same(measure)))
      print_measure(table, measure, console);
    else if (!kMeasures[measure].is_time)
      same += (same.empty() ? "" : ", ") + std::string(kMeasures[measure].name);
  }
  if (!same.empty()) console.line("the same in all: " + same);
}

/// Requires the same kind of all inputs. Whether they are folders.
bool check_kinds(const std::vector<std::string>& inputs) {
  std::error_code error;
  const bool are_folders = std::filesystem::is_directory(inputs[0], error);
  for (const std::string& input : inputs) {
    if (std::filesystem::is_directory(input, error) == are_folders) continue;
    throw InputError(are_folders ? input : inputs[0], "", "not a run folder: two frames or two runs are compared");
  }
  return are_folders;
}

std::optional<RunTable> read_table(const std::vector<std::string>& inputs, Console& console) {
  std::vector<RunSteps> runs;
  for (const std::string& input : inputs) {
    std::optional<RunSteps> run = read_run_steps(input);
    if (run) runs.push_back(std::move(*run));
  }
  if (runs.size() < 2) return std::nullopt;
  RunTable table = run_table(runs);
  if (!table.has_one_scene) console.warn({"these are runs of different scenes"});
  if (!table.has_one_journal) console.warn({"these are runs of different journals"});
  return table;
}

void write_json(const Arguments& arguments, const Json& result, Console& console) {
  const std::string text = json_text(result, 2) + "\n";
  console.json(result);
  if (!arguments.json_file.empty()) write_file(arguments.json_file, text);
  if (arguments.output.empty()) return;
  write_file(std::filesystem::path(arguments.output) / "compare.json", text);
}

}  // namespace

ExitCode run_compare(const Arguments& arguments, Console& console) {
  const std::vector<std::string>& inputs = arguments.inputs;
  const bool are_folders = check_kinds(inputs);
  if (!arguments.output.empty()) make_folders(arguments.output);  // found out before the work
  Json pairs = Json::array();
  Verdict verdict = Verdict::equal;
  ComparePage page(inputs[0], arguments.white, arguments.exposure);
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    const auto share = [&](std::size_t done) {
      return static_cast<double>(done) / static_cast<double>(inputs.size() - 1);
    };
    console.part(share(i - 1), share(i), "compare " + inputs[i]);
    const PairComparison pair = are_folders ? compare_folders(inputs[0], inputs[i], arguments, console)
                                            : compare_files(inputs[0], inputs[i], arguments);
    print_pair(pair, inputs.size() > 2 ? printable(inputs[i]) + ": " : "", are_folders, console);
    warn_of_pair(pair, arguments, inputs[i], console);
    page.add_pair(inputs[i], pair);
    pairs.push_back(pair_json(printable(inputs[0]), printable(inputs[i]), pair));
    verdict = std::max(verdict, pair.verdict);
  }
  console.part_done();
  Json result = pairs.size() == 1 ? pairs[0] : Json{{"pairs", pairs}, {"verdict", verdict_name(verdict)}};
  result["relook"] = "compare/1";
  result["psnr_peak"] = arguments.exact_only ? Json(nullptr) : Json(arguments.white.value);
  if (are_folders) {
    if (const std::optional<RunTable> table = read_table(inputs, console)) {
      print_table(*table, console);
      page.set_runs(*table);
      result["runs"] = run_table_json(*table);
    }
  }
  write_json(arguments, result, console);
  if (!arguments.html.empty()) write_file(arguments.html, page.text());
  if (!arguments.output.empty()) write_file(std::filesystem::path(arguments.output) / "compare.html", page.text());
  return verdict == Verdict::failure ? ExitCode::difference : ExitCode::ok;
}

}  // namespace relook
