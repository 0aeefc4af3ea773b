#include "inspect/inspect_paths.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "edit/guide/usual_class.h"
#include "input/open_look.h"

namespace relook {
namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Does a pattern with * (any characters) and ? (one) match all of a text?
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool is_wanted(const std::string& filter, const std::string& pointer) {
  const std::string text = lower(pointer);
  return filter.find_first_of("*?") == std::string::npos ? text.find(filter) != std::string::npos
                                                         : matches(filter, text);
}

/// A path that outlives the walk over the document.
struct ListedPath {
  std::string pointer;
  const SchemaField* field;
  Json value;  // null: unset
  Json entity;
  std::string_view section;
  [[nodiscard]] LookPath path() const { return {pointer, *field, value.is_null() ? nullptr : &value, entity, section}; }
};

std::vector<ListedPath> listed_paths(const LookDocument& document, const std::string& filter) {
  std::vector<ListedPath> paths;
  for_each_path(document, [&](const LookPath& path) {
    if (!is_wanted(filter, path.pointer)) return;
    // Of the entity only a light's type matters to units.
    Json entity = path.section == "lights" ? path.entity : Json::object();
    paths.push_back(
        {path.pointer, &path.field, path.value == nullptr ? Json() : *path.value, std::move(entity), path.section});
  });
  return paths;
}

Json entry_of(const LookPath& path, const std::string& change) {
  Json entry{
      {"pointer", path.pointer}, {"set", path.value != nullptr}, {"range", range_text(path.field)}, {"class", change}};
  entry["value"] = path.value == nullptr ? Json() : *path.value;
  if (path.field.kind == FieldKind::number || path.field.kind == FieldKind::integer ||
      path.field.kind == FieldKind::reals) {
    const SchemaField& field = path.field;
    entry["minimum"] = field.low > -kCeiling ? Json(field.low == kAboveZero ? 0.0 : field.low) : Json();
    entry["maximum"] = field.high < kCeiling ? Json(field.high) : Json();
  }
  if (path.field.kind == FieldKind::choice) entry["choices"] = path.field.choices;
  entry["unit"] = unit_of(path);
  return entry;
}

std::string line_of(const LookPath& path, const std::string& change) {
  constexpr std::size_t kLongest = 200;
  std::string value = path.value == nullptr ? "unset" : printable(json_text(*path.value));
  if (value.size() > kLongest) value = value.substr(0, kLongest) + "...";
  std::string line = printable(path.pointer) + " = " + value + "   (" + range_text(path.field) + "; " + change;
  if (const std::string_view unit = unit_of(path); !unit.empty()) line.append("; ").append(unit);
  return line + ")";
}

}  // namespace

void inspect_paths(const Arguments& arguments, Console& console) {
  SceneState state = open_look_state(arguments.inputs[0], arguments, console);
  const std::vector<ListedPath> paths = listed_paths(state.document(), lower(arguments.paths_filter));
  if (paths.empty() && !arguments.paths_filter.empty())
    throw InputError(arguments.inputs[0], "", "no path matches \"" + arguments.paths_filter + "\"");
  Json entries = Json::array();
  for (const ListedPath& listed : paths) {
    console.check_interrupt();
    const LookPath path = listed.path();
    const std::string change = usual_class(state, path);
    console.line(line_of(path, change));
    if (arguments.json) entries.push_back(entry_of(path, change));
  }
  console.json({{"input", arguments.inputs[0]}, {"paths", std::move(entries)}});
}

}  // namespace relook
