#include "page/run_marks.h"

#include <algorithm>
#include <string>

#include "page/cut.h"

namespace relook {
namespace {

constexpr std::size_t kLongestNote = 300, kLongestLabel = 80, kLongestPath = 160, kLongestValue = 60;  // bytes
constexpr std::size_t kMostOperations = 3;                                                             // of an edit
constexpr std::size_t kMostAxes = 2;

const Json& member(const Json& entry, const char* key) {
  static const Json kNull;
  const auto found = entry.is_object() ? entry.find(key) : entry.end();
  return entry.is_object() && found != entry.end() ? *found : kNull;
}

Json axes_of(const Json& axes) {
  Json list = Json::array();
  for (const Json& axis : axes) {
    if (!axis.is_object() || list.size() == kMostAxes) break;
    const Json& texts = member(axis, "texts");
    list.push_back({{"path", cut_text(text_at(axis, "path"), kLongestPath)},
                    {"label", cut_text(text_at(axis, "label"), kLongestLabel)},
                    {"count", texts.is_array() ? texts.size() : 0}});
  }
  return list;
}

Json value_texts(const Json& values) {
  Json list = Json::array();
  for (const Json& value : values) {
    if (!value.is_object() || list.size() == kMostAxes) break;
    list.push_back(cut_text(text_at(value, "text"), kLongestLabel));
  }
  return list;
}

Json short_edit(const Edit& edit) {
  constexpr const char* kNames[] = {"add", "remove", "replace", "move", "copy", "test"};
  Json list = Json::array();
  for (const PatchOperation& operation : edit) {
    if (list.size() == kMostOperations) break;
    Json item{kNames[static_cast<std::size_t>(operation.op)], cut_text(operation.path, kLongestPath)};
    if (!operation.value.is_null()) {
      const std::string text = json_text(operation.value);
      item.push_back(text.size() <= kLongestValue ? operation.value : Json("…"));
    }
    list.push_back(std::move(item));
  }
  if (edit.size() > kMostOperations) list.push_back(edit.size() - kMostOperations);
  return list;
}

}  // namespace

std::size_t frame_in_step(const Json& entry) {
  for (const char* kind : {"drag_frame", "wedge_frame"})
    if (const Json& place = member(entry, kind); place.is_number_integer()) return place.get<std::size_t>();
  return 0;
}

const JournalStep* step_of(const Json& entry, const Journal& journal) {
  const Json& number = member(entry, "step");
  const std::size_t place = number.is_number_integer() ? number.get<std::size_t>() : 0;
  return place == 0 || place > journal.steps.size() ? nullptr : &journal.steps[place - 1];
}

Json marks_of(const Json& entry, const Journal& journal, bool has_edit) {
  Json marks = Json::object();
  const JournalStep* step = step_of(entry, journal);
  const std::size_t frame = frame_in_step(entry);
  if (entry.contains("from"))
    marks["from"] = member(entry, "from").is_number_integer() ? member(entry, "from") : Json(0);
  if (member(entry, "keep") == false) marks["keep"] = false;
  if (frame > 0) marks["frame"] = frame;
  if (member(entry, "wedge_frame").is_number() || (step != nullptr && step->form() == StepForm::wedge))
    marks["is"] = "wedge";
  else if (frame > 0 || (step != nullptr && step->form() == StepForm::drag))
    marks["is"] = "drag";
  if (const Json& axes = member(entry, "axes"); axes.is_array()) marks["axes"] = axes_of(axes);
  if (const Json& values = member(entry, "values"); values.is_array()) marks["values"] = value_texts(values);
  if (const std::string note = text_at(entry, "note"); !note.empty()) marks["note"] = cut_text(note, kLongestNote);
  if (const std::string author = text_at(entry, "author"); !author.empty())
    marks["author"] = cut_text(author, kLongestLabel);
  if (!has_edit || step == nullptr) return marks;
  if (frame > 0 && frame <= step->frames())
    marks["edit"] = short_edit(step->edit_of(frame - 1));
  else if (frame == 0 && !step->edit.empty())
    marks["edit"] = short_edit(step->edit);
  return marks;
}

}  // namespace relook
