#include "options/needless_options.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "options/named_files.h"

namespace relook {
namespace {

const auto kAnyApp = [](const CLI::App*) { return true; };

/// The verb that was given; `name` becomes "journal wedge", "replay".
const CLI::App& given_verb(const CLI::App& app, std::string& name) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) {
    verb = verb->get_subcommands().front();
    name += (name.empty() ? "" : " ") + verb->get_name();
  }
  return *verb;
}

/// Whether a word is an option: "--x" and "-x" are; "-", "--", "-1" and "-.5" are not.
bool is_option(const std::string& word) {
  if (word.size() < 2 || word[0] != '-' || word == "--") return false;
  return word[1] != '.' && (word[1] < '0' || word[1] > '9');
}

/// The option of a word, without a value that is written to it: "--x" of "--x=1", "-x" of "-x1".
std::string option_of(const std::string& word) {
  return word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

std::vector<std::string> long_options(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> verbs_with(const CLI::App& app, const std::string& option) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands(kAnyApp))
    if (verb->get_option_no_throw(option) != nullptr) names.push_back(verb->get_name());
  return names;
}

bool is_given(const CLI::App& verb, const std::string& option) {
  const CLI::Option* const known = verb.get_option_no_throw(option);
  return known != nullptr && known->count() > 0;
}

/// An option that changes nothing while `is_idle`, and why.
struct Condition {
  const char* option;
  bool is_idle;
  const char* reason;
};

/// What only paths have.
std::vector<Condition> conditions_of_view(const ViewArguments& view) {
  const bool is_whitted = view.sampling.integrator == Integrator::whitted;
  constexpr const char* kReason = "it is for --integrator path";
  return {{"--diffuse-depth", is_whitted, kReason},
          {"--glossy-depth", is_whitted, kReason},
          {"--transmission-depth", is_whitted, kReason},
          {"--lens", is_whitted, kReason}};
}

std::vector<Condition> conditions_of(const Arguments& arguments) {
  std::vector<Condition> conditions = conditions_of_view(arguments.view);
  switch (arguments.verb) {
    case Verb::render: {
      const bool is_png = is_preview_name(arguments.output);
      conditions.push_back({"--float", is_png, "a PNG has no floats"});
      conditions.push_back({"--aovs", is_png, "a PNG has no layers"});
      return conditions;
    }
    case Verb::replay: {
      return {{"--baseline", arguments.report == ReportKind::none, "it is for the report, which --report none omits"}};
    }
    case Verb::report:
      return {{"--scale", !arguments.single_file, "it is for --single-file"}};
    case Verb::sheet:
      return {{"--exposure", !is_preview_name(arguments.output), "an .exr keeps its light; it is for .png"}};
    case Verb::compare: {
      constexpr const char* kExact = "not with --exact, which works out no PSNR, SSIM and FLIP";
      const bool has_page = !arguments.html.empty() || !arguments.output.empty();
      return {{"--exposure", !has_page, "it is for the pictures of the page; give --html or -o"},
              {"--peak", arguments.exact_only, kExact},
              {"--failflip", arguments.exact_only, kExact},
              {"--warnflip", arguments.exact_only, kExact}};
    }
    case Verb::schema:
      return {{"--scene", arguments.inputs[0] == "report", "report.json is of no scene"}};
    default:
      return conditions;
  }
}

}  // namespace

std::string refused_line_text(const CLI::App& app, std::span<const char* const> words, const std::string& otherwise) {
  std::string name;
  const CLI::App& verb = given_verb(app, name);
  const auto found = std::ranges::find_if(words, [&](const std::string& word) {
    return is_option(word) && verb.get_option_no_throw(option_of(word)) == nullptr;
  });
  if (name.empty() || found == words.end()) return otherwise;
  const std::string option = option_of(*found);
  std::string text = name + " takes no " + option;
  const std::string near = nearest_name(option, long_options(verb));
  if (!near.empty()) return text + "; did you mean \"" + near + "\"?";
  std::string others;
  for (const std::string& other : verbs_with(app, option)) others += (others.empty() ? "" : ", ") + other;
  return others.empty() ? text + "; see relook " + name + " --help" : text + ", an option of " + others;
}

void require_effects(const CLI::App& verb, const Arguments& arguments) {
  for (const Condition& condition : conditions_of(arguments))
    if (condition.is_idle && is_given(verb, condition.option))
      throw UsageError(verb.get_name() + " " + condition.option + ": " + condition.reason);
}

std::vector<std::string> idle_structures_warning(const Arguments& arguments, Integrator integrator) {
  if (integrator == Integrator::whitted) return {};
  const NamedStructures& named = arguments.named;
  std::string options;
  const auto note = [&](const char* option, bool is_asked_for) {
    if (is_asked_for) options += (options.empty() ? "" : ", ") + std::string(option);
  };
  note("--shadow-bits", arguments.shadow_bits.value_or(0) > 0);
  note("--tunnels", named.tunnels.value_or(0) > 0);
  note("--groups", named.groups.value_or(0) > 0);
  note("--atoms", named.atoms.value_or(0) > 0);
  note("--color-trees", named.color_trees_percent.value_or(0) > 0);
  if (options.empty()) return {};
  return {options + ": of --integrator whitted alone; images of path keep rays and terms of light in their place"};
}

}  // namespace relook
