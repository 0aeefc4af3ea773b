// "test": compares as "replace" would write, names for glTF indices included.
#include "edit/transaction.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

std::string short_text(const Json& value) {
  constexpr std::size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

void name_section(const LookDocument& document, Section section, Json& entries) {
  if (!entries.is_object()) return;
  for (Json& entry : entries) name_indices(document, section, entry);
}

}  // namespace

void Transaction::run_test(const Resolved& resolved, const PatchPlace& place) {
  const Json& value = value_at(document().look, resolved.path, place);
  if (value == resolved.operation->value || value == named_value(resolved)) return;
  throw InputError(file_, resolved.operation->value_where,
                   "the test failed: " + pointer_text(resolved.path) + " is " + short_text(value));
}

/// An operation's value with names where it has indices that "replace" would name.
Json Transaction::named_value(const Resolved& resolved) {
  const Tokens& path = resolved.path;
  Json value = resolved.operation->value;
  if (path.empty()) {
    for (std::size_t s = 0; s < kSectionCount && value.is_object(); ++s) {
      const auto section = static_cast<Section>(s);
      if (const auto entries = value.find(section_name(section)); entries != value.end())
        name_section(document(), section, *entries);
    }
    return value;
  }
  const std::optional<Section> section = section_of(path[0]);
  if (!section) return value;
  if (path.size() == 1) {
    name_section(document(), *section, value);
    return value;
  }
  // Wraps the value in as much of its entry as leads to it.
  for (std::size_t depth = path.size() - 1; depth > 1; --depth) {
    const Tokens above(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(depth));
    const bool is_item = value_at(document().look, above, {}).is_array();
    Json outer = is_item ? Json::array() : Json::object();
    if (is_item)
      outer.push_back(std::move(value));
    else
      outer[path[depth]] = std::move(value);
    value = std::move(outer);
  }
  name_indices(document(), *section, value);
  for (std::size_t depth = 2; depth < path.size(); ++depth) {
    Json inner = std::move(*value.begin());
    value = std::move(inner);
  }
  return value;
}

}  // namespace relook
