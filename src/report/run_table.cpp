#include "report/run_table.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "report/report.h"

namespace relook {
namespace {

constexpr double kLargest = 1e300;

std::string text_of_setting(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::map<std::string, std::string> settings_of(const JsonView& report) {
  std::map<std::string, std::string> settings;
  const JsonView options = report.at("options");
  options.require_object();
  for (const auto& [name, value] : options.value().items()) settings[name] = text_of_setting(value);
  settings["samples"] = text_of_setting(report.at("samples").value());
  settings["resolution"] = text_of_setting(report.at("resolution").value());
  settings["threads"] = text_of_setting(report.at("machine").at("threads").value());
  return settings;
}

JsonView at_pointer(JsonView view, std::string_view pointer) {
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::string_view token = pointer.substr(0, pointer.find('/'));
    view = view.at(token);
    pointer.remove_prefix(token.size());
  }
  return view;
}

std::optional<std::uint32_t> frame_number(const JsonView& step, std::string_view key) {
  const JsonView number = step.at(key);
  if (number.value().is_null()) return std::nullopt;
  return static_cast<std::uint32_t>(number.integer(1, UINT32_MAX));
}

RunSteps::Step read_step(const JsonView& view) {
  RunSteps::Step step;
  const std::optional<std::uint32_t> drag = frame_number(view, "drag_frame"), wedge = frame_number(view, "wedge_frame");
  const auto number = static_cast<std::uint32_t>(view.at("step").integer(0, UINT32_MAX));
  step.label = step_label({number, drag ? drag : wedge, (drag ? drag : wedge).value_or(0)});
  step.name = view.at("name").text();
  step.change_class = view.at("class").text();
  for (std::size_t i = 0; i < kMeasures.size(); ++i)
    step.values[i] = at_pointer(view, kMeasures[i].pointer).number(0, kLargest);
  return step;
}

/// The names of settings that are not the same in all runs.
std::set<std::string> differing_settings(const std::vector<RunSteps>& runs) {
  std::set<std::string> names, differing;
  for (const RunSteps& run : runs)
    for (const auto& setting : run.settings) names.insert(setting.first);
  const auto value = [](const RunSteps& run, const std::string& name) {
    const auto found = run.settings.find(name);
    return found == run.settings.end() ? std::string() : found->second;
  };
  for (const std::string& name : names)
    if (std::ranges::any_of(runs, [&](const RunSteps& run) { return value(run, name) != value(runs.front(), name); }))
      differing.insert(name);
  return differing;
}

}  // namespace

std::optional<RunSteps> read_run_steps(const std::filesystem::path& run) {
  const std::filesystem::path path = run / "report.json";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  const std::string file = path.string();
  const Bytes bytes = read_file(path);
  const Json document = parse_json(text_of(bytes), file);
  const JsonView report(document, file);
  if (report.at("relook").text() != "report/1") report.at("relook").fail("not a report that this program reads");
  RunSteps result;
  result.run = run.string();
  result.scene_hash = report.at("scene").at("hash").text();
  result.journal_hash = report.at("journal").at("hash").text();
  result.settings = settings_of(report);
  const JsonView full_render = report.at("full_render_seconds");
  if (!full_render.value().is_null()) result.full_render_seconds = full_render.number(0, kLargest);
  const JsonView steps = report.at("steps");
  steps.require_array();
  for (std::size_t i = 0; i < steps.size(); ++i) result.steps.push_back(read_step(steps.at(i)));
  return result;
}

bool RunTable::is_same(std::size_t measure) const {
  return std::ranges::all_of(rows, [&](const Row& row) {
    return std::ranges::all_of(row.values, [&](const auto& values) {
      return values && row.values.front() && (*values)[measure] == (*row.values.front())[measure];
    });
  });
}

RunTable run_table(const std::vector<RunSteps>& runs) {
  RunTable table;
  const std::set<std::string> differing = differing_settings(runs);
  std::map<std::string, std::size_t> places;  // of rows, by label
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSteps& run = runs[i];
    RunTable::Column column{run.run, {}, run.full_render_seconds};
    for (const auto& [name, value] : run.settings)
      if (differing.contains(name)) column.settings[name] = value;
    table.columns.push_back(std::move(column));
    table.has_one_journal = table.has_one_journal && run.journal_hash == runs.front().journal_hash;
    table.has_one_scene = table.has_one_scene && run.scene_hash == runs.front().scene_hash;
    for (const RunSteps::Step& step : run.steps) {
      const auto [place, is_new] = places.try_emplace(step.label, table.rows.size());
      if (is_new) table.rows.push_back({step.label, step.name, step.change_class, {}});
      RunTable::Row& row = table.rows[place->second];
      row.values.resize(runs.size());
      row.values[i] = step.values;
    }
  }
  return table;
}

Json run_table_json(const RunTable& table) {
  Json columns = Json::array(), rows = Json::array();
  for (const RunTable::Column& column : table.columns)
    columns.push_back(
        {{"run", printable(column.run)},
         {"settings", column.settings},
         {"full_render_seconds", column.full_render_seconds ? Json(*column.full_render_seconds) : Json(nullptr)}});
  for (const RunTable::Row& row : table.rows) {
    Json entry{{"step", row.label}, {"name", row.name}, {"class", row.change_class}};
    for (std::size_t m = 0; m < kMeasures.size(); ++m) {
      Json& values = entry[std::string(kMeasures[m].name)] = Json::array();
      for (const auto& cell : row.values) values.push_back(cell ? Json((*cell)[m]) : Json(nullptr));
    }
    rows.push_back(std::move(entry));
  }
  return {{"columns", std::move(columns)},
          {"rows", std::move(rows)},
          {"one_journal", table.has_one_journal},
          {"one_scene", table.has_one_scene}};
}

}  // namespace relook
