// What may stand at the end of a command line that is being typed: the scripts of `relook completions` ask `relook
// complete WORD...`, all words so far, the last one unfinished. What the command line itself does not know (cameras,
// pointers, steps) is read from the scene, cache or journal that is named in it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "options/arguments.h"
#include "options/command_help.h"

namespace relook {

enum class Wanted : std::uint8_t { words, files, cameras, pointers, steps };

struct CompletionPlace {
  Wanted wanted = Wanted::files;
  std::string begun;                // of the word
  std::string before;               // what a word that is offered begins with: "--camera="
  std::vector<OptionHelp> choices;  // words: the first name of each, and its help
  std::string scene, journal;       // as named so far, or ""
};

/// `words`: "complete" and what follows.
[[nodiscard]] Arguments completion_arguments(const std::vector<std::string_view>& words);
/// `words`: of a command line, without "relook".
[[nodiscard]] CompletionPlace completion_place(const std::vector<std::string>& words);

}  // namespace relook
