// Values of one parameter as wedge steps.
#include "base/error.h"
#include "edit/draft/journal_draft.h"

namespace relook {
namespace {

/// JSON, or a word that stands for itself.
Json value_of(std::string text) {
  constexpr std::string_view kJsonStarts = "[{\"-+.0123456789";
  text.erase(0, text.find_first_not_of(' '));
  if (text.empty()) throw UsageError("VALUES: a value is empty");
  const bool is_word =
      kJsonStarts.find(text[0]) == std::string_view::npos && text != "true" && text != "false" && text != "null";
  if (is_word) return text;
  try {
    return parse_json(text, "VALUES");
  } catch (const InputError&) {
    throw UsageError("VALUES: \"" + text + "\" is neither JSON, a name nor a range A..B:N");
  }
}

/// "A..B:N" as a journal has it; none when `text` has another form. A is a number or an array of numbers.
std::optional<Json> range_of(const std::string& text) {
  const std::size_t start = text.find_first_not_of(' ');
  const std::size_t dots = text.find(".."), colon = text.rfind(':');
  if (dots == std::string::npos || colon == std::string::npos || colon < dots + 2 || start == std::string::npos)
    return std::nullopt;
  if (std::string_view("[-.0123456789").find(text[start]) == std::string_view::npos) return std::nullopt;
  return Json{{"from", value_of(text.substr(0, dots))},
              {"to", value_of(text.substr(dots + 2, colon - dots - 2))},
              {"count", value_of(text.substr(colon + 1))}};
}

}  // namespace

JournalDraft draft_wedge(const std::string& pointer, const std::vector<std::string>& values) {
  JournalDraft draft;
  const auto add_step = [&](const char* key, Json content) {
    draft.steps.push_back({{"name", pointer}, {"wedge", {{"path", pointer}, {key, std::move(content)}}}});
  };
  Json together = Json::array();
  const auto end_values = [&] {
    if (!together.empty()) add_step("values", std::exchange(together, Json::array()));
  };
  for (const std::string& text : values) {
    if (auto range = range_of(text)) {
      end_values();
      add_step("range", std::move(*range));
    } else {
      together.push_back(value_of(text));
    }
  }
  end_values();
  return draft;
}

}  // namespace relook
