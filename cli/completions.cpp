// `relook completions`: scripts that complete command lines in bash, zsh and fish, made from the command line's own
// description.
#include "verbs.h"

namespace relook {
namespace {

constexpr const char* kShells = "bash zsh fish";

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> names_of(const std::vector<VerbHelp>& verbs) {
  std::vector<std::string> names;
  for (const VerbHelp& verb : verbs) names.push_back(verb.name);
  return names;
}

/// Text for single quotes, without the characters that mean something to `_arguments` of zsh.
std::string plain(const std::string& text) {
  std::string result;
  for (const char character : text)
    if (character == '\'')
      result += "'\\''";
    else if (character == ':' || character == '[' || character == ']')
      result += std::string("\\") + character;
    else
      result += character;
  return result;
}

std::string bash(const std::vector<VerbHelp>& verbs) {
  std::string options, values;
  for (const VerbHelp& verb : verbs) {
    std::vector<std::string> names;
    for (const OptionHelp& option : verb.options) {
      names.insert(names.end(), option.names.begin(), option.names.end());
      if (option.choices.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) patterns.push_back(verb.name + ":" + name);
      values += "    " + joined(patterns, "|") + ") words='" + joined(option.choices) + "' ;;\n";
    }
    options += "    " + verb.name + ") words='" + joined(names) + "' ;;\n";
  }
  return "_relook() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]} words=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         joined(names_of(verbs)) +
         " --help --version' -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case \"$verb:$before\" in\n" +
         values + "    completions:completions) words='" + std::string(kShells) +
         "' ;;\n"
         "  esac\n"
         "  if [ -z \"$words\" ] && [[ $current == -* ]]; then\n"
         "    case \"$verb\" in\n" +
         options +
         "    esac\n"
         "  fi\n"
         "  if [ -n \"$words\" ]; then COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  else COMPREPLY=($(compgen -f -- \"$current\")); fi\n"
         "}\n"
         "complete -o filenames -F _relook relook\n";
}

std::string zsh_option(const OptionHelp& option) {
  const std::string help = "[" + plain(option.help) + "]";
  std::string value;
  if (option.takes_value) value = option.choices.empty() ? ":value:_files" : ":value:(" + joined(option.choices) + ")";
  std::string text;
  for (const std::string& name : option.names) text += " '" + name + help + value + "'";
  return text;
}

std::string zsh(const std::vector<VerbHelp>& verbs) {
  std::string list, cases;
  for (const VerbHelp& verb : verbs) {
    list += "    '" + verb.name + ":" + plain(verb.help) + "'\n";
    cases += "    " + verb.name + ") _arguments";
    for (const OptionHelp& option : verb.options) cases += zsh_option(option);
    cases += verb.name == "completions" ? " '*:shell:(" + std::string(kShells) + ")' ;;\n" : " '*:file:_files' ;;\n";
  }
  return "#compdef relook\n"
         "_relook() {\n"
         "  local -a verbs\n"
         "  verbs=(\n" +
         list +
         "  )\n"
         "  if (( CURRENT == 2 )); then _describe verb verbs; return; fi\n"
         "  local verb=$words[2]\n"
         "  shift words; (( CURRENT-- ))\n"
         "  case $verb in\n" +
         cases +
         "  esac\n"
         "}\n"
         "if [ \"$funcstack[1]\" = _relook ]; then _relook \"$@\"; else compdef _relook relook; fi\n";
}

std::string fish_quoted(const std::string& text) {
  std::string result = "'";
  for (const char character : text) result += character == '\'' ? std::string("\\'") : std::string(1, character);
  return result + "'";
}

std::string fish(const std::vector<VerbHelp>& verbs) {
  std::string text;
  for (const VerbHelp& verb : verbs)
    text += "complete -c relook -n __fish_use_subcommand -f -a " + verb.name + " -d " + fish_quoted(verb.help) + "\n";
  for (const VerbHelp& verb : verbs)
    for (const OptionHelp& option : verb.options) {
      text += "complete -c relook -n '__fish_seen_subcommand_from " + verb.name + "'";
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.takes_value) text += option.choices.empty() ? " -r" : " -x -a " + fish_quoted(joined(option.choices));
      text += " -d " + fish_quoted(option.help) + "\n";
    }
  return text + "complete -c relook -n '__fish_seen_subcommand_from completions' -f -a " + fish_quoted(kShells) + "\n";
}

}  // namespace

ExitCode run_completions(const Arguments& arguments, Console& console) {
  const std::vector<VerbHelp> verbs = command_line_help();
  const std::string& shell = arguments.inputs[0];
  const std::string script = shell == "bash" ? bash(verbs) : shell == "zsh" ? zsh(verbs) : fish(verbs);
  console.print(script);
  return ExitCode::ok;
}

}  // namespace relook
