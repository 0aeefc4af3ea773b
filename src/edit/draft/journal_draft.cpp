#include "edit/draft/journal_draft.h"

#include <charconv>

#include "base/hash.h"

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

constexpr std::string_view kStart = "{\"relook\":\"journal/1\",\"generated\":\"", kEndOfHash = "\",";
constexpr std::size_t kHashDigits = 32;

}  // namespace

std::string journal_text(const JournalDraft& draft) {
  const std::string steps = "\"steps\":" + lines_of(draft.steps, "  ", step_text) + "}\n";
  return std::string(kStart).append(hash128(bytes_of(steps))).append(kEndOfHash).append(steps);
}

bool is_generated_journal(std::string_view text) {
  constexpr std::size_t kSteps = kStart.size() + kHashDigits + kEndOfHash.size();
  return text.starts_with(kStart) && text.size() > kSteps &&
         text.substr(kStart.size(), kHashDigits) == hash128(bytes_of(text.substr(kSteps)));
}

double short_real(float value) {
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, value);
  double number = 0;
  (void)std::from_chars(text, written.ptr, number);
  return number;
}

}  // namespace relook
