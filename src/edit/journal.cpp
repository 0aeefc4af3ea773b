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

/// Counts the frames of a journal as they are read.
class FrameCount {
 public:
  /// Throws JournalLimitError at `place`, which asks for `frames` more, when these are too many.
  void add(std::size_t frames, const JsonView& place) {
    if (frames > kMostFrames - frames_)
      throw JournalLimitError(
          place.file(), place.pointer(),
          "with this the journal has more than " + std::to_string(kMostFrames) + " frames, the most that one may have");
    frames_ += frames;
  }

 private:
  std::size_t frames_ = 0;
};

constexpr double kLargestOfRange = 1e30;

void require_range_value(const JsonView& value) { (void)value.number(-kLargestOfRange, kLargestOfRange); }

void read_range(const JsonView& range, FrameCount& frames, Wedge& wedge) {
  constexpr std::array<std::string_view, 3> kKeys{"from", "to", "count"};
  constexpr std::size_t kMostNumbers = 16;  // of one value: a matrix
  constexpr std::int64_t kMostCount = 1'000'000'000'000;
  range.only_keys(kKeys);
  const JsonView from = range.at("from"), to = range.at("to"), count = range.at("count");
  wedge.count = static_cast<std::size_t>(count.integer(2, kMostCount));
  if (from.value().is_array()) {
    to.require_array();
    if (from.size() > kMostNumbers) from.fail("expected at most " + std::to_string(kMostNumbers) + " numbers");
    if (to.size() != from.size()) to.fail("expected as many numbers as in \"from\"");
    for (std::size_t k = 0; k < from.size(); ++k) {
      require_range_value(from.at(k));
      require_range_value(to.at(k));
    }
  } else {
    require_range_value(from);
    require_range_value(to);
  }
  frames.add(wedge.count, count);
  wedge.from = from.value();
  wedge.to = to.value();
}

Wedge read_wedge(const JsonView& view, FrameCount& frames) {
  constexpr std::array<std::string_view, 3> kKeys{"path", "values", "range"};
  view.only_keys(kKeys);
  if (view.has("values") == view.has("range")) view.fail("a wedge has either \"values\" or \"range\"");
  Wedge wedge;
  wedge.path = read_pointer(view.at("path"));
  wedge.where = view.pointer();
  if (view.has("range")) {
    read_range(view.at("range"), frames, wedge);
    return wedge;
  }
  const JsonView list = view.at("values");
  list.require_array();
  if (list.size() == 0) list.fail("expected at least one value");
  frames.add(list.size(), list);
  wedge.count = list.size();
  wedge.values = list.value().get_ref<const Json::array_t&>();
  return wedge;
}

JournalStep read_step(const JsonView& view, std::size_t number, FrameCount& frames) {
  constexpr std::array<std::string_view, 5> kKeys{"name", "edit", "select", "drag", "wedge"};
  view.only_keys(kKeys);
  JournalStep step;
  step.where = view.pointer();
  step.name = view.has("name") ? view.at("name").text() : "step " + std::to_string(number);
  const bool has_edit = view.has("edit"), has_drag = view.has("drag");
  if (view.has("wedge")) {
    if (has_edit || has_drag || view.has("select")) view.fail("a step with \"wedge\" has nothing else");
    step.wedge = read_wedge(view.at("wedge"), frames);
    return step;
  }
  if (has_edit && (has_drag || view.has("select"))) view.fail("a step has either \"edit\" or \"select\" and \"drag\"");
  if (has_edit) {
    frames.add(1, view);
    step.edit = read_edit(view.at("edit"));
    return step;
  }
  if (!has_drag && !view.has("select")) view.fail("a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"");
  step.select = read_selection(view.at("select"));
  const JsonView drag = view.at("drag");
  drag.require_array();
  if (drag.size() == 0) drag.fail("a drag needs at least one entry");
  frames.add(drag.size(), drag);
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

double between(double from, double to, std::size_t i, std::size_t count) {
  return i + 1 == count ? to : from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
}

}  // namespace

Edit Wedge::operator[](std::size_t i) const {
  PatchOperation operation;
  operation.path = path;
  operation.where = where;
  operation.value_where = where + (values.empty() ? "/range" : "/values/" + std::to_string(i));
  if (!values.empty()) {
    operation.value = values[i];
  } else if (from.is_array()) {
    operation.value = Json::array();
    for (std::size_t k = 0; k < from.size(); ++k)
      operation.value.push_back(between(from[k].get<double>(), to[k].get<double>(), i, count));
  } else {
    operation.value = between(from.get<double>(), to.get<double>(), i, count);
  }
  Edit edit;
  edit.push_back(std::move(operation));
  return edit;
}

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
  FrameCount frames;
  for (std::size_t i = 0; i < steps.size(); ++i)
    errors.is_sound([&] { journal.steps.push_back(read_step(steps.at(i), i + 1, frames)); });
  errors.require_none();
  return journal;
}

Edit parse_patch(std::string_view text, std::string_view file) {
  const Json json = parse_json(text, file);
  return read_edit(JsonView(json, file));
}

}  // namespace relook
