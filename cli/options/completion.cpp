#include "options/completion.h"

#include <algorithm>
#include <array>
#include <utility>

namespace relook {
namespace {

OptionHelp choice(std::string name, std::string help) { return {{std::move(name)}, std::move(help), "", {}, false}; }

std::vector<OptionHelp> choices_of(const std::vector<VerbHelp>& verbs) {
  std::vector<OptionHelp> choices;
  for (const VerbHelp& verb : verbs) choices.push_back(choice(verb.name, verb.help));
  return choices;
}

std::vector<OptionHelp> choices_of(const OptionHelp& option) {
  std::vector<OptionHelp> choices;
  for (const std::string& word : option.choices) choices.push_back(choice(word, ""));
  return choices;
}

/// Bash takes "=" for a word of its own: "--camera" "=" "Ma" becomes "--camera=Ma".
std::vector<std::string> rejoined(const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_value = words[i] == "=" && !result.empty() && result.back().starts_with("--");
    if (!is_value) {
      result.push_back(words[i]);
      continue;
    }
    result.back() += "=";
    if (i + 1 < words.size()) result.back() += words[++i];
  }
  return result;
}

/// What an option's value is, by its name.
Wanted kind_of_value(std::string_view option) {
  constexpr std::array<std::pair<std::string_view, Wanted>, 4> kKinds{{{"--camera", Wanted::cameras},
                                                                       {"--params", Wanted::pointers},
                                                                       {"--step", Wanted::steps},
                                                                       {"--steps", Wanted::steps}}};
  const auto found = std::ranges::find(kKinds, option, &std::pair<std::string_view, Wanted>::first);
  return found == kKinds.end() ? Wanted::files : found->second;
}

/// What stands in a command line before its last word.
struct Read {
  std::vector<std::string> inputs;
  const OptionHelp* open = nullptr;  // the option whose value the last word is
};

Read read_words(const VerbHelp& verb, const std::vector<std::string>& words, std::size_t first,
                CompletionPlace& place) {
  Read read;
  const auto take = [&](std::string_view name, const std::string& value) {
    if (name == "--scene") place.scene = value;
    if (name == "--journal") place.journal = value;
  };
  for (std::size_t i = first; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (!word.starts_with('-') || word == "-") {
      read.inputs.push_back(word);
      continue;
    }
    const std::size_t end = word.find('=');
    const std::string name = word.substr(0, end);
    if (end != std::string::npos) take(name, word.substr(end + 1));
    const OptionHelp* const option = find_option(verb, name);
    if (end != std::string::npos || option == nullptr || option->value.empty() || option->value.starts_with('['))
      continue;
    if (i + 2 == words.size()) {
      read.open = option;
    } else {
      take(name, words[++i]);
    }
  }
  return read;
}

void want_value(const OptionHelp& option, CompletionPlace& place) {
  place.wanted = option.choices.empty() ? kind_of_value(option.names.back()) : Wanted::words;
  place.choices = choices_of(option);
}

void want_option(const VerbHelp& verb, CompletionPlace& place) {
  const std::size_t end = place.begun.find('=');
  if (end != std::string::npos) {
    const OptionHelp* const option = find_option(verb, place.begun.substr(0, end));
    if (option == nullptr) return;
    place.before = place.begun.substr(0, end + 1);
    place.begun = place.begun.substr(end + 1);
    want_value(*option, place);
    return;
  }
  place.wanted = Wanted::words;
  for (const OptionHelp& option : verb.options)
    for (const std::string& name : option.names)
      if (name.starts_with("--") || place.begun == "-") place.choices.push_back(choice(name, option.help));
}

}  // namespace

Arguments completion_arguments(const std::vector<std::string_view>& words) {
  Arguments arguments;
  arguments.verb = Verb::complete;
  for (std::size_t i = 1; i < words.size(); ++i) arguments.inputs.emplace_back(words[i]);
  if (arguments.inputs.empty()) arguments.inputs.emplace_back();
  const CompletionPlace place = completion_place(arguments.inputs);
  arguments.scene = place.scene;  // for the sandbox
  arguments.journal = place.journal;
  return arguments;
}

CompletionPlace completion_place(const std::vector<std::string>& typed) {
  const std::vector<std::string> words = rejoined(typed);
  const std::vector<VerbHelp> verbs = command_line_help();
  CompletionPlace place;
  place.begun = words.back();
  std::size_t first = 1;
  const VerbHelp* verb = words.size() > 1 ? find_verb(verbs, words[0]) : nullptr;
  if (words.size() == 1 || (verb != nullptr && !verb->parts.empty() && words.size() == 2)) {
    place.wanted = Wanted::words;
    place.choices = choices_of(verb == nullptr ? verbs : verb->parts);
    if (verb == nullptr) {
      place.choices.push_back(choice("--help", "what there is"));
      place.choices.push_back(choice("--version", "the program and its libraries"));
    }
    return place;
  }
  const std::string name = words[0];
  if (verb != nullptr && !verb->parts.empty()) verb = find_verb(verb->parts, words[first++]);
  if (verb == nullptr) return place;
  const Read read = read_words(*verb, words, first, place);
  const std::size_t count = read.inputs.size();
  if (count > 0 && place.scene.empty()) place.scene = read.inputs[0];
  if (count > 1 && place.journal.empty() && (name == "replay" || name == "plan")) place.journal = read.inputs[1];
  if (read.open != nullptr) {
    want_value(*read.open, place);
  } else if (place.begun.starts_with('-')) {
    want_option(*verb, place);
  } else if (verb->inputs.size() == 1 && !verb->inputs[0].choices.empty()) {
    want_value(verb->inputs[0], place);
  } else if (!verb->inputs.empty() && verb->inputs[0].names[0].starts_with("SCENE POINTER") && count == 1) {
    place.wanted = Wanted::pointers;
  }
  return place;
}

}  // namespace relook
