#include "options/manual.h"

#include <algorithm>
#include <string_view>

#include "options/command_help.h"
#include "options/help_footer.h"
#include "report/report.h"

namespace relook {
namespace {

/// Text as roff takes it: a backslash or a minus is itself, and no line is taken for a request.
std::string roff(std::string_view text) {
  std::string result;
  if (text.starts_with('.') || text.starts_with('\'')) result = "\\&";
  for (const char character : text)
    if (character == '\\')
      result += "\\e";
    else if (character == '-')
      result += "\\-";
    else
      result += character;
  return result;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

/// "TEXT:{a,b}" as "a|b", "UINT:INT in [0 - 16]" as "UINT", our own "RADIUS:FOCUS" as it is.
std::string value_text(const OptionHelp& option) {
  if (!option.choices.empty()) return joined(option.choices, "|");
  const bool is_needless = option.value.starts_with('[');
  std::string value = is_needless ? option.value.substr(1, option.value.size() - 2) : option.value;
  for (const std::string_view type : {"TEXT:", "INT:", "UINT:", "FLOAT:"})
    if (value.starts_with(type)) value.resize(type.size() - 1);
  return is_needless ? "[" + value + "]" : value;
}

std::string entry(const OptionHelp& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  const std::string value = value_text(option);
  if (!value.empty()) names += " \\fI" + roff(value) + "\\fR";
  return ".TP\n" + names + "\n" + roff(option.help) + (option.is_required ? " (required)" : "") + ".\n";
}

bool is_same(const OptionHelp& a, const OptionHelp& b) { return a.names == b.names && a.help == b.help; }

/// Options that every verb has, in the order of the first.
std::vector<OptionHelp> common_options(const std::vector<VerbHelp>& verbs) {
  std::vector<OptionHelp> common;
  for (const OptionHelp& option : verbs.front().options) {
    const auto has_it = [&](const VerbHelp& verb) {
      return std::ranges::any_of(verb.options, [&](const OptionHelp& other) { return is_same(option, other); });
    };
    if (std::ranges::all_of(verbs, has_it)) common.push_back(option);
  }
  return common;
}

/// Verbs, and in the place of one that has parts these: "journal diff".
std::vector<VerbHelp> flat(const std::vector<VerbHelp>& verbs) {
  std::vector<VerbHelp> all;
  for (const VerbHelp& verb : verbs) {
    if (verb.parts.empty()) all.push_back(verb);
    for (VerbHelp part : verb.parts) {
      part.name = verb.name + " " + part.name;
      all.push_back(std::move(part));
    }
  }
  return all;
}

std::string synopsis(const VerbHelp& verb) {
  std::string line = ".B relook " + roff(verb.name);
  line += "\n.RI";
  for (const OptionHelp& input : verb.inputs) line += " \"" + roff(input.names.front()) + "\" \" \"";
  for (const OptionHelp& option : verb.options)
    if (option.is_required)
      line += " \"\\fB" + roff(option.names.front()) + "\\fI " + roff(value_text(option)) + "\" \" \"";
  return line + " [ OPTIONS ]\n.br\n";
}

std::string verb_section(const VerbHelp& verb, const std::vector<OptionHelp>& common) {
  std::string text = ".SS relook " + roff(verb.name) + "\n" + roff(verb.help) + ".\n";
  for (const OptionHelp& input : verb.inputs) text += entry(input);
  for (const OptionHelp& option : verb.options)
    if (std::ranges::none_of(common, [&](const OptionHelp& other) { return is_same(option, other); }))
      text += entry(option);
  const std::vector<std::string_view> examples = examples_of(verb.name);
  if (examples.empty()) return text;
  text += ".PP\nExamples:\n.PP\n.nf\n.RS\n";
  for (const std::string_view example : examples) text += "relook " + roff(example) + "\n";
  return text + ".RE\n.fi\n";
}

constexpr std::string_view kDescription =
    "relook replays look-development edits in batch. It renders a glTF 2.0 scene once, for one fixed camera, and keeps "
    "the\n"
    "path of every ray on disk. Then it replays journals: lists of edits to materials, textures, lights and objects. "
    "After\n"
    "each step it recomputes the part of the image that the edit reaches, and nothing else, and writes an EXR frame "
    "and a\n"
    "report. Every frame is, bit for bit, what a full render of the edited scene gives.\n"
    ".PP\n"
    "Results go to the standard output, progress, warnings and errors to the standard error, a line each. A journal or "
    "a\n"
    "look patch named \\- is the standard input.\n"
    ".PP\n"
    "Units are those of glTF: metres, radians, candela for point and spot lights, lux for directional ones, nits for "
    "area\n"
    "lights; colours are linear Rec.709.\n";

constexpr std::string_view kEnvironment =
    ".TP\n.B OCIO\nAn OpenColorIO config: previews have the default view of its default display instead of sRGB.\n"
    ".TP\n.B NO_COLOR\nNo escape sequences on a terminal.\n"
    ".TP\n.B RELOOK_SANDBOX\noff: the program keeps its rights to start programs and to open all files, for "
    "debuggers.\n";

}  // namespace

std::string manual_text() {
  const std::vector<VerbHelp> verbs = flat(command_line_help());
  const std::vector<OptionHelp> common = common_options(verbs);
  std::string text = ".TH RELOOK 1 \"\" \"relook " + std::string(program_version()) + "\" \"User Commands\"\n";
  text += ".SH NAME\nrelook \\- replay edits of a scene and recompute exactly the part of the image that changed\n";
  text += ".SH SYNOPSIS\n";
  for (const VerbHelp& verb : verbs) text += synopsis(verb);
  text.append(".B relook \\-\\-version\n[\\fB\\-\\-json\\fR]\n.SH DESCRIPTION\n")
      .append(kDescription)
      .append(".SH VERBS\n");
  for (const VerbHelp& verb : verbs) text += verb_section(verb, common);
  text += ".SH COMMON OPTIONS\n";
  for (const OptionHelp& option : common) text += entry(option);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : exit_meanings()) text += ".TP\n.B " + roff(code) + "\n" + roff(meaning) + "\n";
  return text.append(".SH ENVIRONMENT\n").append(kEnvironment);
}

}  // namespace relook
