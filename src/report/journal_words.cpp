#include "report/journal_words.h"

#include "edit/journal_walk.h"

namespace relook {
namespace {

std::string compact(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// A text as a header can hold it: without NUL, which ends it there.
std::string header_text(std::string text) {
  std::erase(text, '\0');
  return text;
}

std::string edit_text(const Edit& edit) {
  constexpr std::size_t kMostBytes = 16'000;
  std::string text;
  std::size_t left = edit.size();
  for (const Json& operation : patch_json(edit)) {
    const std::string next = compact(operation);
    if (text.size() + next.size() > kMostBytes) break;
    text += (text.empty() ? "[" : ",") + next;
    --left;
  }
  if (left > 0) text += (text.empty() ? "[" : ",") + compact("… and " + std::to_string(left) + " more operations");
  return text.empty() ? "[]" : text + "]";
}

}  // namespace

Json entry_words(const Journal& journal, std::uint32_t step, std::optional<std::size_t> frame) {
  Json words{{"name", step_name(journal, step)},
             {"from", nullptr},
             {"keep", true},
             {"values", nullptr},
             {"axes", nullptr},
             {"note", nullptr},
             {"author", nullptr},
             {"extras", nullptr}};
  if (step == 0) return words;
  const JournalStep& of = journal.steps[step - 1];
  words["from"] = state_before(journal, step);
  words["keep"] = of.keep;
  words["note"] = text_or_null(of.said.note);
  words["author"] = text_or_null(of.said.author);
  words["extras"] = of.said.extras;
  if (of.form() != StepForm::wedge) return words;
  words["values"] = of.wedge.values_json(frame.value_or(of.frames() - 1));
  if (!frame) words["axes"] = of.wedge.axes_json();
  return words;
}

void add_journal_words(FrameMeta& meta, const Journal& journal, std::uint32_t step, std::size_t frame) {
  if (step == 0) return;
  meta.name = header_text(step_name(journal, step));
  const JournalStep& of = journal.steps[step - 1];
  meta.edit = edit_text(of.edit_of(frame));
  if (of.form() == StepForm::wedge) meta.values = compact(of.wedge.values_json(frame));
  meta.note = header_text(of.said.note);
  meta.author = header_text(of.said.author.empty() ? journal.said.author : of.said.author);
  if (!of.said.extras.is_null()) meta.extras = compact(of.said.extras);
}

bool has_journal_words(const FrameMeta& meta, const Journal& journal, std::uint32_t step, std::size_t frame) {
  FrameMeta wanted = meta;
  wanted.name = wanted.edit = wanted.values = wanted.note = wanted.author = wanted.extras = "";
  add_journal_words(wanted, journal, step, frame);
  return wanted == meta;
}

}  // namespace relook
