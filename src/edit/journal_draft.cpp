#include "edit/journal_draft.h"

#include <charconv>

namespace relook {
namespace {

/// `items` one a line, indented by `indent`.
template <class Text>
std::string lines_of(const Json& items, const std::string& indent, const Text& text) {
  std::string lines = "[";
  for (const Json& item : items) lines += (lines.size() > 1 ? ",\n" : "\n") + indent + text(item);
  return lines + "]";
}

std::string step_text(const Json& step) {
  if (!step.contains("drag")) return step.dump();
  Json head = step;
  head.erase("drag");
  std::string text = head.dump();
  text.pop_back();
  return text + ",\"drag\":" + lines_of(step["drag"], "    ", [](const Json& entry) { return entry.dump(); }) + "}";
}

}  // namespace

std::string journal_text(const JournalDraft& draft) {
  return "{\"relook\":\"journal/1\",\"steps\":" + lines_of(draft.steps, "  ", step_text) + "}\n";
}

double short_real(float value) {
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, value);
  double number = 0;
  (void)std::from_chars(text, written.ptr, number);
  return number;
}

}  // namespace relook
