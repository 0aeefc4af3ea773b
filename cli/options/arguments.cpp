#include "options/arguments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/import_memory.h"
#include "frame/display_view.h"
#include "options/completion.h"
#include "options/help_footer.h"
#include "options/manual.h"
#include "options/needless_options.h"
#include "options/values.h"
#include "options/verb_options.h"
#include "options/version_text.h"

namespace relook {
namespace {

constexpr double kHundred = 100;

void add_footers(CLI::App& app, const std::string& verb) {
  app.footer(help_footer(verb));
  for (CLI::App* part : app.get_subcommands([](CLI::App*) { return true; }))
    add_footers(*part, verb.empty() ? part->get_name() : verb + " " + part->get_name());
}

constexpr std::array<std::string_view, 7> kJournalSources{"diff",      "variants", "animation", "wedge",
                                                          "turntable", "aim",      "rig"};

constexpr std::array<std::string_view, 16> kVerbs{"render", "preprocess", "replay", "compare", "inspect",     "check",
                                                  "tune",   "journal",    "blame",  "plan",    "completions", "schema",
                                                  "export", "watch",      "report", "sheet"};
constexpr std::array<std::string_view, 5> kProgressStyles{"auto", "plain", "json", "openjd", "none"};

/// The place of `word` among `choices`. Throws UsageError with the nearest one.
template <class Choices>
std::size_t place_of(std::string_view word, const Choices& choices, const std::string& what) {
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string message = "no " + what + " \"" + std::string(word) + "\"";
  const std::string nearest = nearest_name(word, choices);
  message += nearest.empty() ? "; see relook --help" : "; did you mean \"" + nearest + "\"?";
  throw UsageError(message);
}

void resolve(const RawTexts& raw, Arguments& arguments) {
  if (!raw.resolution.empty())
    std::tie(arguments.view.width, arguments.view.height) = parse_resolution("--resolution", raw.resolution);
  if (!raw.memory.empty()) arguments.structures.memory_bytes = parse_size("--memory", raw.memory);
  if (!raw.import_memory.empty()) set_import_memory(parse_size("--import-memory", raw.import_memory));
  set_import_rules(arguments.import);
  if (!raw.disk.empty()) arguments.structures.disk_bytes = parse_size("--disk", raw.disk);
  if (!raw.ray_trees.empty())
    arguments.structures.ray_trees_percent = parse_percent("--ray-trees", raw.ray_trees, true);
  if (!raw.color_trees.empty())
    arguments.named.color_trees_percent = parse_percent("--color-trees", raw.color_trees, true);
  if (raw.steps) arguments.steps = parse_steps("--steps", *raw.steps);
  arguments.report = raw.report == "none"   ? ReportKind::none
                     : raw.report == "json" ? ReportKind::json
                                            : ReportKind::html;
  if (!raw.verify.empty()) arguments.verify_percent = parse_percent("--verify", raw.verify, false);
  if (!(std::fabs(arguments.exposure) <= kMostExposure))
    throw UsageError("--exposure: a number of stops from -100 to 100");
  if (arguments.own_exposure && !(std::fabs(*arguments.own_exposure) <= kMostExposure))
    throw UsageError("--exposure: a number of stops from -100 to 100");
  ViewOptions& sampling = arguments.view.sampling;
  if (!raw.integrator.empty())
    arguments.integrator = static_cast<Integrator>(place_of(raw.integrator, kIntegratorWords, "--integrator"));
  sampling.integrator = arguments.integrator.value_or(kUsualIntegrator);
  sampling.samples = raw.samples.value_or(usual_samples(sampling.integrator));
  if (!raw.lens.empty()) sampling.lens = parse_lens("--lens", raw.lens);
  if (arguments.verb != Verb::replay)  // whose cache says
    take_structures(usual_structures(sampling.integrator), sampling.integrator, arguments);
  sampling.shadow_bits = sampling.integrator == Integrator::whitted ? arguments.shadow_bits.value_or(0) : 0;
  arguments.view.auto_lights = !raw.lights.empty();
  arguments.progress = static_cast<ProgressStyle>(place_of(raw.progress, kProgressStyles, "--progress style"));
}

/// Takes FILE of "plan CACHE JOURNAL --json FILE", the third word, as if it were written --json=FILE.
void resolve_plan(const RawTexts& raw, Arguments& arguments) {
  const bool has_file = arguments.inputs.size() > 2;
  if (has_file && raw.json != "-") throw UsageError("CACHE JOURNAL: " + arguments.inputs[2] + " is one too many");
  if (has_file) arguments.json_file = arguments.inputs[2];
  arguments.json = raw.json == "-" && !has_file;
  if (!raw.json.empty() && raw.json != "-") arguments.json_file = raw.json;
}

/// Takes the word after "--json", a .json file and so neither a frame nor a folder, as if it were written --json=FILE.
void take_json_file(const RawTexts& raw, Arguments& arguments) {
  if (raw.json.empty()) return;
  arguments.json_file = raw.json == "-" ? "" : raw.json;
  if (!arguments.json_file.empty()) return;
  const auto is_json = [](const std::string& input) { return std::filesystem::path(input).extension() == ".json"; };
  const auto found = std::ranges::find_if(arguments.inputs, is_json);
  arguments.json = found == arguments.inputs.end();
  if (arguments.json) return;
  arguments.json_file = *found;
  arguments.inputs.erase(found);
}

void resolve_compare(const RawTexts& raw, Arguments& arguments) {
  take_json_file(raw, arguments);
  if (arguments.inputs.size() < 2) throw UsageError("A B: two frames or two folders at least");
  const Thresholds& limits = arguments.thresholds;
  const auto require_range = [](const char* option, const std::optional<double>& value, double high) {
    if (value && !(std::isfinite(*value) && *value >= 0 && *value <= high))
      throw UsageError(std::string(option) + ": a finite number of at least 0" +
                       (high == kHundred ? " and at most 100" : ""));
  };
  constexpr double kAny = std::numeric_limits<double>::max();
  require_range("--fail", limits.fail, kAny);
  require_range("--failpercent", limits.fail_percent, kHundred);
  require_range("--hardfail", limits.hard_fail, kAny);
  require_range("--failflip", limits.fail_flip, kAny);
  require_range("--warn", limits.warn, kAny);
  require_range("--warnpercent", limits.warn_percent, kHundred);
  require_range("--hardwarn", limits.hard_warn, kAny);
  require_range("--warnflip", limits.warn_flip, kAny);
  if (!(arguments.white.value > 0 && arguments.white.value <= kAny))
    throw UsageError("--peak: a finite number above 0");
}

/// `inspect --look SCENE`, `inspect --paths SCENE`: the word after the option is the input when there is no other.
void resolve_inspect(const CLI::App& verb, const RawTexts& raw, Arguments& arguments) {
  std::string& patch = arguments.view.look_patch;
  if (arguments.inputs.empty() && !patch.empty()) arguments.inputs.push_back(std::exchange(patch, ""));
  std::string& filter = arguments.paths_filter;
  if (arguments.inputs.empty() && !filter.empty()) arguments.inputs.push_back(std::exchange(filter, ""));
  if (arguments.inputs.empty()) throw UsageError("INPUT is required");
  arguments.lists_paths = verb.count("--paths") > 0;
  arguments.print_look =
      verb.count("--look") > 0 && arguments.scene.empty() && !arguments.lists_paths && !arguments.lists_cameras;
  for (const CLI::Option* option : raw.inspection_view)
    if (option->count() > 0) arguments.view_options.push_back("--" + option->get_lnames().front());
}

void resolve_journal(Arguments& arguments) {
  const bool is_turntable = arguments.journal_source == JournalSource::turntable;
  // Without a node all of them turn, or, with --environment, none.
  if (is_turntable && arguments.inputs.size() < 2)
    arguments.inputs.emplace_back(arguments.turntable.environment ? "" : "all");
}

/// Command lines that are not those of --help.
std::optional<ParsedCommandLine> parse_aside(const std::vector<std::string_view>& words) {
  if (words.size() == 2 && std::ranges::count(words, "--version") == 1 && std::ranges::count(words, "--json") == 1)
    return ParsedCommandLine{std::nullopt, json_text(version_json(), 2) + "\n"};
  if (words.size() == 1 && words[0] == "--help-man") return ParsedCommandLine{std::nullopt, manual_text()};
  if (!words.empty() && words[0] == "complete") return ParsedCommandLine{completion_arguments(words), ""};
  return std::nullopt;
}

}  // namespace

StructureOptions usual_structures(Integrator integrator) {
  StructureOptions structures;
  if (integrator == Integrator::path) structures.tunnels = structures.groups = 0;
  if (integrator == Integrator::path) structures.color_trees_percent = 0;
  return structures;
}

void take_structures(const StructureOptions& others, Integrator integrator, Arguments& arguments) {
  StructureOptions& structures = arguments.structures;
  const bool is_whitted = integrator == Integrator::whitted;
  const NamedStructures named = is_whitted ? arguments.named : NamedStructures();
  structures.tunnels = named.tunnels.value_or(others.tunnels);
  structures.tunnel_levels = named.tunnel_levels.value_or(others.tunnel_levels);
  structures.most_tunnels = named.most_tunnels ? named.most_tunnels : others.most_tunnels;
  structures.groups = named.groups.value_or(others.groups);
  structures.atoms = named.atoms.value_or(others.atoms);
  structures.color_trees_percent = named.color_trees_percent.value_or(others.color_trees_percent);
}

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
  if (std::optional<ParsedCommandLine> parsed = parse_aside({argv + 1, argv + std::max(argc, 1)})) return *parsed;
  CLI::App app("relook: replays edits of a scene and recomputes exactly the part of the image that changed", "relook");
  app.set_version_flag("--version", version_text, "Print versions and exit; with --json all of them, as one object");
  app.require_subcommand(1);
  Arguments arguments;
  RawTexts raw;
  add_verbs(app, arguments, raw);
  add_footers(app, "");
  if (argc < 2) throw UsageError("a verb is required; see relook --help");
  if (argv[1][0] != '-') arguments.verb = static_cast<Verb>(place_of(argv[1], kVerbs, "verb"));
  const bool is_journal = arguments.verb == Verb::journal && argv[1][0] != '-';
  if (is_journal && argc > 2 && argv[2][0] != '-')
    arguments.journal_source = static_cast<JournalSource>(place_of(argv[2], kJournalSources, "kind of journal"));
  try {
    if (is_journal) {
      std::vector<std::string> words = marked_values(argc, argv);
      std::reverse(words.begin(), words.end());  // as CLI11 wants them
      app.parse(std::move(words));
    } else {
      app.parse(argc, argv);
    }
  } catch (const CLI::CallForHelp&) {
    return {std::nullopt, app.help()};
  } catch (const CLI::CallForVersion& version) {
    return {std::nullopt, std::string(version.what()) + "\n"};
  } catch (const CLI::ParseError& error) {
    throw UsageError(refused_line_text(app, {argv, static_cast<std::size_t>(argc)}, error.what()));
  }
  resolve(raw, arguments);
  const CLI::App& verb = *app.get_subcommands().front();
  require_effects(verb, arguments);
  if (arguments.verb == Verb::compare) resolve_compare(raw, arguments);
  if (arguments.verb == Verb::plan) resolve_plan(raw, arguments);
  if (arguments.verb == Verb::inspect) resolve_inspect(verb, raw, arguments);
  if (arguments.verb == Verb::journal) resolve_journal(arguments);
  return {std::move(arguments), ""};
}

}  // namespace relook
