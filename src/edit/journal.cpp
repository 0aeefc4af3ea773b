#include "edit/journal.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/hash.h"
#include "edit/step_errors.h"
#include "edit/wedge/read_wedge.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 6> kOperations{"add", "remove", "replace", "move", "copy", "test"};

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

Annotations read_annotations(const JsonView& view) {
  Annotations said;
  if (view.has("note")) said.note = view.at("note").text();
  if (view.has("author")) said.author = view.at("author").text();
  if (view.has("extras")) said.extras = view.at("extras").value();
  return said;
}

constexpr std::string_view kBase = "base";

/// The numbers of the steps, from 1, by their names.
using StepNumbers = std::map<std::string, std::vector<std::uint32_t>>;

StepNumbers numbers_by_name(const JsonView& steps) {
  StepNumbers numbers;
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    const Json& step = steps.value()[i];
    const bool has_name = step.is_object() && step.contains("name") && step["name"].is_string();
    numbers[has_name ? step["name"].get<std::string>() : "step " + std::to_string(i + 1)].push_back(i + 1);
  }
  return numbers;
}

/// The number of the step that `from` of the step with index `end` means.
std::uint32_t read_from(const JsonView& from, const StepNumbers& numbers, std::size_t end) {
  if (!from.value().is_string() && !from.value().is_number())
    from.fail("expected \"base\", or the name or number of an earlier step");
  if (!from.value().is_string()) return static_cast<std::uint32_t>(from.integer(0, static_cast<std::int64_t>(end)));
  const std::string name = from.text();
  if (name == kBase) return 0;
  const auto found = numbers.find(name);
  if (found == numbers.end() || found->second.front() > end) {
    if (found != numbers.end()) from.fail("step \"" + name + "\" is not before this one");
    std::vector<std::string> known{std::string(kBase)};
    for (const auto& [other, places] : numbers)
      if (places.front() <= end) known.push_back(other);
    const std::string near = nearest_name(name, known);
    from.fail("no earlier step \"" + name + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }
  if (found->second.size() > 1 && found->second[1] <= end)
    from.fail("two earlier steps are called \"" + name + "\"; say its number");
  return found->second.front();
}

/// What the frames of a step are made by.
void read_form(const JsonView& view, FrameCount& frames, JournalStep& step) {
  const bool has_edit = view.has("edit"), has_drag = view.has("drag");
  if (view.has("wedge")) {
    if (has_edit || has_drag || view.has("select")) view.fail("a step with \"wedge\" has no other edits");
    step.wedge = read_wedge(view.at("wedge"), frames);
    return;
  }
  if (has_edit && (has_drag || view.has("select"))) view.fail("a step has either \"edit\" or \"select\" and \"drag\"");
  if (has_edit) {
    frames.add(1, view);
    step.edit = read_edit(view.at("edit"));
    return;
  }
  if (!has_drag && !view.has("select")) view.fail("a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"");
  step.select = read_selection(view.at("select"));
  const JsonView drag = view.at("drag");
  drag.require_array();
  if (drag.size() == 0) drag.fail("a drag needs at least one entry");
  frames.add(drag.size(), drag);
  for (std::size_t i = 0; i < drag.size(); ++i) step.drag.push_back(read_edit(drag.at(i)));
}

/// The step with an index from 0.
JournalStep read_step(const JsonView& steps, const StepNumbers& numbers, std::size_t index, FrameCount& frames) {
  constexpr std::array<std::string_view, 10> kKeys{"name", "edit", "select", "drag",   "wedge",
                                                   "from", "keep", "note",   "author", "extras"};
  const JsonView view = steps.at(index);
  view.only_keys(kKeys);
  JournalStep step;
  step.where = view.pointer();
  step.name = view.has("name") ? view.at("name").text() : "step " + std::to_string(index + 1);
  step.said = read_annotations(view);
  if (view.has("from")) step.from = read_from(view.at("from"), numbers, index);
  read_form(view, frames, step);
  if (view.has("keep")) {
    if (step.form() == StepForm::edit) view.at("keep").fail("only a wedge or a drag has \"keep\"");
    step.keep = view.at("keep").boolean();
  }
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

StepForm JournalStep::form() const {
  return !drag.empty() ? StepForm::drag : !wedge.empty() ? StepForm::wedge : StepForm::edit;
}

std::size_t JournalStep::frames() const {
  switch (form()) {
    case StepForm::drag:
      return drag.size();
    case StepForm::wedge:
      return wedge.size();
    case StepForm::edit:
      break;
  }
  return 1;
}

Edit JournalStep::edit_of(std::size_t frame) const {
  switch (form()) {
    case StepForm::drag:
      return drag[frame];
    case StepForm::wedge:
      return wedge[frame];
    case StepForm::edit:
      break;
  }
  return edit;
}

std::size_t frame_count(const Journal& journal) {
  std::size_t frames = 0;
  for (const JournalStep& step : journal.steps) frames += step.frames();
  return frames;
}

Journal read_journal(const std::filesystem::path& path, const WhileWaiting& while_waiting) {
  const Bytes bytes = read_input(path, while_waiting);
  return parse_journal(text_of(bytes), input_name(path));
}

Journal parse_journal(std::string_view text, const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 7> kKeys{"relook", "steps",  "generated", "$schema",
                                                  "note",   "author", "extras"};
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
  for (const char* key : {"generated", "$schema"})
    if (view.has(key)) (void)view.at(key).text();
  journal.said = read_annotations(view);
  const JsonView steps = view.at("steps");
  steps.require_array();
  StepErrors errors(journal.file);
  FrameCount frames;
  const StepNumbers numbers = numbers_by_name(steps);
  for (std::size_t i = 0; i < steps.size(); ++i)
    errors.is_sound([&] { journal.steps.push_back(read_step(steps, numbers, i, frames)); });
  errors.require_none();
  return journal;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json patch_json(const Edit& edit) {
  Json list = Json::array();
  for (const PatchOperation& operation : edit) {
    Json entry{{"op", kOperations[static_cast<std::size_t>(operation.op)]}, {"path", operation.path}};
    const bool has_from = operation.op == PatchOp::move || operation.op == PatchOp::copy;
    if (has_from) entry["from"] = operation.from;
    if (!has_from && operation.op != PatchOp::remove) entry["value"] = operation.value;
    list.push_back(std::move(entry));
  }
  return list;
}

Edit parse_patch(std::string_view text, std::string_view file) {
  const Json json = parse_json(text, file);
  return read_edit(JsonView(json, file));
}

}  // namespace relook
