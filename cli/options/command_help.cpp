#include "options/command_help.h"

#include <algorithm>

#include "options/verb_options.h"

namespace relook {
namespace {

/// What CLI11 shows of a value's type: "TEXT:{weight,lru}" has the choices "weight" and "lru".
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

/// "--look [FILE]" may have a value and needs none.
bool may_have_value(const CLI::Option& option) { return option.get_expected_max() > 0 && option.get_type_size() > 0; }

OptionHelp help_of(const CLI::Option& option) {
  OptionHelp help;
  help.help = option.get_description();
  if (may_have_value(option)) {
    help.value = option.get_type_name();
    help.choices = choices_of(help.value);
    if (option.get_expected_min() == 0) help.value = "[" + help.value + "]";
  }
  help.is_required = option.get_required();
  for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
  if (help.names.empty()) help.names.push_back(option.get_name(true));
  return help;
}

VerbHelp help_of(const CLI::App& verb) {
  VerbHelp help;
  help.name = verb.get_name();
  help.help = verb.get_description();
  for (const CLI::Option* option : verb.get_options())
    (option->nonpositional() ? help.options : help.inputs).push_back(help_of(*option));
  for (const CLI::App* part : verb.get_subcommands([](const CLI::App*) { return true; }))
    help.parts.push_back(help_of(*part));
  return help;
}

}  // namespace

std::vector<VerbHelp> command_line_help() {
  CLI::App app;
  Arguments arguments;
  RawTexts raw;
  add_verbs(app, arguments, raw);
  return help_of(app).parts;
}

const VerbHelp* find_verb(const std::vector<VerbHelp>& verbs, std::string_view name) {
  const auto found = std::ranges::find(verbs, name, &VerbHelp::name);
  return found == verbs.end() ? nullptr : &*found;
}

const OptionHelp* find_option(const VerbHelp& verb, std::string_view name) {
  const auto has_name = [&](const OptionHelp& option) { return std::ranges::count(option.names, name) > 0; };
  const auto found = std::ranges::find_if(verb.options, has_name);
  return found == verb.options.end() ? nullptr : &*found;
}

}  // namespace relook
