// The command line as data, read from the same table that parses it: for completions, the manual page, --version
// --json.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace relook {

struct OptionHelp {
  std::vector<std::string> names;    // "-o", "--output"; of an input one word, "CACHE JOURNAL"
  std::string help;                  // one sentence
  std::string value;                 // "WxH", "TEXT", "{auto,plain}": what it takes; "" for a flag
  std::vector<std::string> choices;  // of the value, if there are few
  bool is_required = false;
};
struct VerbHelp {
  std::string name, help;
  std::vector<OptionHelp> options, inputs;
  std::vector<VerbHelp> parts;  // "diff" of "journal"
};

/// All verbs, in the order of --help.
[[nodiscard]] std::vector<VerbHelp> command_line_help();
/// The one of that name; null if there is none.
[[nodiscard]] const VerbHelp* find_verb(const std::vector<VerbHelp>& verbs, std::string_view name);
/// The one that has this name ("-o"); null if there is none.
[[nodiscard]] const OptionHelp* find_option(const VerbHelp& verb, std::string_view name);

}  // namespace relook
