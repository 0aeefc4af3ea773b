#include "edit/journal.h"

#include <algorithm>
#include <set>

#include "base/hash.h"
#include "edit/step_errors.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 6> kOperations{"add", "remove", "replace", "move", "copy", "test"};

std::string read_pointer(const JsonView& view) {
  std::string pointer = view.text();
  if (!pointer.empty()) (void)split_pointer(pointer, view.file(), view.pointer());
  return pointer;
}

PatchOperation read_operation(const JsonView& view) {
  PatchOperation operation;
  operation.where = view.pointer();
  operation.value_where = operation.where + "/value";
  operation.op = static_cast<PatchOp>(view.at("op").one_of(kOperations));
  const bool has_from = operation.op == PatchOp::move || operation.op == PatchOp::copy;
  const bool has_value = !has_from && operation.op != PatchOp::remove;
  std::vector<std::string_view> keys{"op", "path"};
  if (has_from) keys.emplace_back("from");
  if (has_value) keys.emplace_back("value");
  view.only_keys(keys);
  operation.path = read_pointer(view.at("path"));
  if (has_from) operation.from = read_pointer(view.at("from"));
  if (has_value) operation.value = view.at("value").value();
  return operation;
}

Edit read_edit(const JsonView& view) {
  view.require_array();
  Edit edit;
  for (std::size_t i = 0; i < view.size(); ++i) edit.push_back(read_operation(view.at(i)));
  return edit;
}

std::vector<std::string> read_selection(const JsonView& view) {
  view.require_array();
  if (view.size() == 0) view.fail("a drag needs at least one selected node");
  std::vector<std::string> selection;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const JsonView item = view.at(i);
    std::string pointer = item.text();
    const std::vector<std::string> tokens = split_pointer(pointer, item.file(), item.pointer());
    if (tokens.size() != 2 || tokens[0] != "nodes") item.fail("expected \"/nodes/<name>\"");
    if (std::find(selection.begin(), selection.end(), pointer) != selection.end()) item.fail("selected twice");
    selection.push_back(std::move(pointer));
  }
  return selection;
}

constexpr std::size_t kMostWedgeValues = 10'000;

/// `range.count` values evenly spaced from `range.from` to `range.to`, numbers or arrays of numbers.
std::vector<Json> spaced_values(const JsonView& range) {
  constexpr std::array<std::string_view, 3> kKeys{"from", "to", "count"};
  constexpr double kLargest = 1e30;
  range.only_keys(kKeys);
  const auto count = static_cast<std::size_t>(range.at("count").integer(2, kMostWedgeValues));
  const auto between = [&](const JsonView& from, const JsonView& to, std::size_t i) -> Json {
    const double a = from.number(-kLargest, kLargest), b = to.number(-kLargest, kLargest);
    return i + 1 == count ? b : a + (b - a) * static_cast<double>(i) / static_cast<double>(count - 1);
  };
  const JsonView from = range.at("from"), to = range.at("to");
  std::vector<Json> values;
  for (std::size_t i = 0; i < count; ++i) {
    if (!from.value().is_array()) {
      values.push_back(between(from, to, i));
      continue;
    }
    to.require_array();
    if (to.size() != from.size()) to.fail("expected as many numbers as in \"from\"");
    values.push_back(Json::array());
    for (std::size_t k = 0; k < from.size(); ++k) values.back().push_back(between(from.at(k), to.at(k), i));
  }
  return values;
}

/// One "replace" for each value.
std::vector<Edit> read_wedge(const JsonView& view) {
  constexpr std::array<std::string_view, 3> kKeys{"path", "values", "range"};
  view.only_keys(kKeys);
  if (view.has("values") == view.has("range")) view.fail("a wedge has either \"values\" or \"range\"");
  std::vector<Json> values;
  if (view.has("range")) {
    values = spaced_values(view.at("range"));
  } else {
    const JsonView list = view.at("values");
    list.require_array();
    if (list.size() == 0 || list.size() > kMostWedgeValues)
      list.fail("expected 1 to " + std::to_string(kMostWedgeValues) + " values");
    for (std::size_t i = 0; i < list.size(); ++i) values.push_back(list.at(i).value());
  }
  std::vector<Edit> wedge;
  for (std::size_t i = 0; i < values.size(); ++i) {
    PatchOperation operation;
    operation.op = PatchOp::replace;
    operation.path = read_pointer(view.at("path"));
    operation.value = std::move(values[i]);
    operation.where = view.pointer();
    operation.value_where =
        view.has("range") ? view.pointer() + "/range" : view.pointer() + "/values/" + std::to_string(i);
    wedge.push_back({std::move(operation)});
  }
  return wedge;
}

JournalStep read_step(const JsonView& view, std::size_t number) {
  constexpr std::array<std::string_view, 5> kKeys{"name", "edit", "select", "drag", "wedge"};
  view.only_keys(kKeys);
  JournalStep step;
  step.where = view.pointer();
  step.name = view.has("name") ? view.at("name").text() : "step " + std::to_string(number);
  const bool has_edit = view.has("edit"), has_drag = view.has("drag");
  if (view.has("wedge")) {
    if (has_edit || has_drag || view.has("select")) view.fail("a step with \"wedge\" has nothing else");
    step.wedge = read_wedge(view.at("wedge"));
    return step;
  }
  if (has_edit && (has_drag || view.has("select"))) view.fail("a step has either \"edit\" or \"select\" and \"drag\"");
  if (has_edit) {
    step.edit = read_edit(view.at("edit"));
    return step;
  }
  if (!has_drag && !view.has("select")) view.fail("a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"");
  step.select = read_selection(view.at("select"));
  const JsonView drag = view.at("drag");
  drag.require_array();
  if (drag.size() == 0) drag.fail("a drag needs at least one entry");
  for (std::size_t i = 0; i < drag.size(); ++i) step.drag.push_back(read_edit(drag.at(i)));
  return step;
}

/// The stem of a file's name; "journal" where that would be none, the folder itself or the one above it.
std::string journal_name(const std::filesystem::path& path) {
  constexpr std::size_t kLongest = 200;
  constexpr std::string_view kSuffix = ".json";
  const std::string file = path.filename().string();
  std::string name = file.ends_with(kSuffix) ? file.substr(0, file.size() - kSuffix.size()) : path.stem().string();
  if (name.size() > kLongest) {
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;  // within a character of UTF-8
    name.resize(end);
  }
  return name.empty() || name == "." || name == ".." ? "journal" : name;
}

}  // namespace

Journal read_journal(const std::filesystem::path& path, const WhileWaiting& while_waiting) {
  const Bytes bytes = read_input(path, while_waiting);
  return parse_journal(text_of(bytes), input_name(path));
}

Journal parse_journal(std::string_view text, const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 3> kKeys{"relook", "steps", "generated"};
  constexpr std::array<std::string_view, 1> kVersions{"journal/1"};
  Journal journal;
  journal.path = path;
  journal.file = path.string();
  journal.name = journal_name(path);
  journal.text = text;
  journal.hash = hash128(bytes_of(text));
  const Json json = parse_json(text, journal.file);
  const JsonView view(json, journal.file);
  view.only_keys(kKeys);
  (void)view.at("relook").one_of(kVersions);
  if (view.has("generated")) (void)view.at("generated").text();
  const JsonView steps = view.at("steps");
  steps.require_array();
  StepErrors errors(journal.file);
  for (std::size_t i = 0; i < steps.size(); ++i)
    errors.is_sound([&] { journal.steps.push_back(read_step(steps.at(i), i + 1)); });
  errors.require_none();
  return journal;
}

Edit parse_patch(std::string_view text, std::string_view file) {
  const Json json = parse_json(text, file);
  return read_edit(JsonView(json, file));
}

}  // namespace relook
