// `relook complete WORD...`: what may stand in the place of the last word, a line each, "WORD<tab>HELP"; a last line
// ":files" asks the shell for files. A word that ends in "/" is a pointer that goes on.
#include <filesystem>

#include "base/files.h"
#include "base/json.h"
#include "input/load_scene.h"
#include "options/completion.h"
#include "verbs.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

/// The look document of a scene or cache.
Json look_of(const std::string& path) {
  const fs::path stored = fs::path(path) / "look.json";
  std::error_code ignored;
  if (!fs::exists(stored, ignored)) return load_document(path, {}).document.look;
  const Bytes bytes = read_file(stored);
  return parse_json(text_of(bytes), stored.string());
}

/// Pointers that go on by one name from what is begun: "/materials/" for "/mat", the materials for "/materials/".
std::vector<std::string> pointers(const Json& look, const std::string& begun) {
  const std::size_t last = begun.rfind('/');
  const std::string above = last == std::string::npos ? "" : begun.substr(0, last);
  const Json* at = &look;
  for (const std::string& name : above.empty() ? std::vector<std::string>() : split_pointer(above, "", ""))
    if (at = at->is_object() && at->contains(name) ? &(*at)[name] : nullptr; at == nullptr) return {};
  std::vector<std::string> result;
  const auto add = [&](const std::string& name, const Json& value) {
    result.push_back(above + "/" + name + (value.is_object() && !value.empty() ? "/" : ""));
  };
  if (at->is_object())
    for (const auto& [name, value] : at->items()) add(escape_token(name), value);
  return result;
}

/// Number and name of each step, whatever else the journal says.
std::vector<OptionHelp> steps_of(const std::string& path) {
  const Bytes bytes = read_file(path);
  const Json journal = parse_json(text_of(bytes), path);
  std::vector<OptionHelp> steps{{{"0"}, "before any step", "", {}, false}};
  if (!journal.is_object() || !journal.contains("steps") || !journal["steps"].is_array()) return {};
  for (const Json& step : journal["steps"]) {
    const bool has_name = step.is_object() && step.contains("name") && step["name"].is_string();
    steps.push_back({{std::to_string(steps.size())}, has_name ? step["name"].get<std::string>() : "", "", {}, false});
  }
  return steps;
}

std::vector<OptionHelp> words_of(const std::vector<std::string>& names) {
  std::vector<OptionHelp> words;
  for (const std::string& name : names) words.push_back({{name}, "", "", {}, false});
  return words;
}

std::vector<OptionHelp> candidates(const CompletionPlace& place) {
  switch (place.wanted) {
    case Wanted::words:
      return place.choices;
    case Wanted::files:
      return {};
    case Wanted::cameras: {
      std::vector<std::string> names{"auto"};
      std::error_code ignored;
      if (place.scene.empty() || fs::is_directory(place.scene, ignored)) return words_of(names);
      const LoadedDocument loaded = load_document(place.scene, {});
      for (const auto& [name, camera] : loaded.document.cameras.items()) names.push_back(name);
      return words_of(names);
    }
    case Wanted::pointers:
      return place.scene.empty() ? std::vector<OptionHelp>() : words_of(pointers(look_of(place.scene), place.begun));
    case Wanted::steps:
      return place.journal.empty() ? std::vector<OptionHelp>() : steps_of(place.journal);
  }
  return {};
}

}  // namespace

ExitCode run_complete(const Arguments& arguments, Console& console) {
  const CompletionPlace place = completion_place(arguments.inputs);
  std::string text;
  for (const OptionHelp& candidate : candidates(place)) {
    const std::string& word = candidate.names.front();
    if (!word.starts_with(place.begun) || printable(word) != word) continue;  // a shell would run what is not plain
    text += place.before + word + (candidate.help.empty() ? "" : "\t" + printable(candidate.help)) + "\n";
  }
  if (place.wanted == Wanted::files) text += ":files\n";
  console.print(text);
  return ExitCode::ok;
}

}  // namespace relook
