#include "options/arguments.h"

#include <CLI/CLI.hpp>
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
#include "options/help_footer.h"
#include "options/needless_options.h"
#include "options/values.h"
#include "options/version_text.h"

namespace relook {
namespace {

constexpr int kMostCompared = 26;  // named A to Z
constexpr double kHundred = 100;

void add_footers(CLI::App& app, const std::string& verb) {
  app.footer(help_footer(verb));
  for (CLI::App* part : app.get_subcommands([](CLI::App*) { return true; }))
    add_footers(*part, verb.empty() ? part->get_name() : verb + " " + part->get_name());
}

/// Options that need our own syntax, as text until the whole line is read.
struct RawTexts {
  std::string report = "html";
  std::string resolution, memory, import_memory, disk, ray_trees, color_trees, verify, lights, progress = "auto";
  std::string json;  // compare, plan; "-": to stdout
  std::optional<std::string> steps;
  std::vector<const CLI::Option*> inspection_view;  // VIEW of inspect
};

void add_common(CLI::App& verb, Arguments& arguments, RawTexts& raw) {
  verb.add_option("--threads", arguments.threads, "Threads to use; 0: all")->check(CLI::Range(0, 1024));
  verb.add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  if (verb.get_name() == "compare" || verb.get_name() == "plan")
    verb.add_flag("--json{-}", raw.json, "Print results as one JSON object; =FILE writes it there");
  else
    verb.add_flag("--json", arguments.json, "Print results as one JSON object");
  verb.add_option("--progress", raw.progress, "auto, plain, json, openjd or none")
      ->type_name("{auto,plain,json,openjd,none}");
  verb.add_flag("--log-json", arguments.log_json, "Warnings, errors and progress on stderr as one JSON object a line");
  verb.add_flag("--overwrite", arguments.overwrite,
                "Replace another run or cache, or another file, that is where the output goes; never an input");
  verb.add_option("--import-memory", raw.import_memory,
                  "Most memory that scenes' and caches' images and geometry may unpack to, like 4G; 2G");
  verb.add_option("--trace", arguments.trace, "File to write: what took how long, for Perfetto (Chrome trace events)");
}

/// Of verbs that read scenes or journals.
void add_import_rules(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--root", arguments.import.roots,
                  "Folder whose files scenes and journals may name, like a library of textures; may be repeated")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR")
      ->allow_extra_args(false);
  verb.add_flag("--strict-gltf", arguments.import.is_strict,
                "Refuse what is against the glTF specification, also where it has one plain meaning or nothing uses it");
}

CLI::Option* add_look_patch(CLI::App& verb, Arguments& arguments,
                            const char* help = "JSON Patch (RFC 6902) applied to the look document first") {
  return verb.add_option("--look", arguments.view.look_patch, help);
}

CLI::Option* add_lights(CLI::App& verb, RawTexts& raw, const char* help = "auto: add a key, a fill and a rim light") {
  return verb.add_option("--lights", raw.lights, help)->check(CLI::IsMember({"auto"}));
}

/// The options that it adds.
std::vector<const CLI::Option*> add_view(CLI::App& verb, Arguments& arguments, RawTexts& raw) {
  ViewArguments& view = arguments.view;
  const auto before = static_cast<std::ptrdiff_t>(verb.get_options().size());
  verb.add_option("--camera", view.camera, "NAME, auto, or EYE:TARGET:FOV as x,y,z:x,y,z:degrees");
  add_lights(verb, raw);
  verb.add_option("--resolution", raw.resolution, "WxH in pixels; 960x540");
  verb.add_option("--samples", view.sampling.samples, "Samples per pixel; 1")->check(CLI::Range(1, 256));
  verb.add_option("--max-depth", view.sampling.max_depth, "Generations of rays; 6")->check(CLI::Range(1, 16));
  const std::vector<CLI::Option*> options = verb.get_options();
  return {options.begin() + before, options.end()};
}

void add_structures(CLI::App& verb, Arguments& arguments, RawTexts& raw) {
  NamedStructures& named = arguments.named;
  verb.add_option("--memory", raw.memory, "Most memory of the whole process, like 2G; without: no limit");
  verb.add_option("--ray-trees", raw.ray_trees,
                  "Percentage of the samples whose ray trees are kept, not just their paths");
  verb.add_option("--color-trees", raw.color_trees,
                  "Percentage of the samples whose colour trees a replay keeps between steps; 100");
  verb.add_option("--tunnels", named.tunnels, "Most tunnels of a region, the last for all further paths; 0: none; 1")
      ->check(CLI::Range(0, 16));
  verb.add_option("--tunnel-levels", named.tunnel_levels,
                  "The lowest levels of the image's quadtree without tunnels; 2: squares of four pixels have some")
      ->check(CLI::Range(std::uint32_t{0}, kTileLevel));
  verb.add_option("--most-tunnels", named.most_tunnels,
                  "Most tunnels in all: the lowest levels go first; without: no limit");
  verb.add_option("--groups", named.groups, "Most paths of a group in a replay; 0: none; 4")->check(CLI::Range(0, 64));
  verb.add_option("--atoms", named.atoms,
                  "Depth of the node hierarchy at which nodes count as one object for groups and tunnels; 0: none")
      ->check(CLI::Range(0, 64));
  verb.add_option("--shadow-bits", arguments.shadow_bits, "Bits of a shadow counter, fixed by preprocess; 0: a flag")
      ->check(CLI::Range(0, 4));
}

void add_exposure(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--exposure", arguments.exposure,
                  "Previews and pages show 2^EV times the light; frames stay as they are; 0")
      ->type_name("EV");
}

void add_frame_options(CLI::App& verb, Arguments& arguments) {
  add_exposure(verb, arguments);
  verb.add_flag("--float", arguments.float_frames, "Write 32-bit float frames instead of half");
  verb.add_flag("--aovs", arguments.layers, "Write layers for compositing into the frames, too");
}

CLI::Option* add_output(CLI::App& verb, Arguments& arguments, const char* help) {
  return verb.add_option("-o,--output", arguments.output, help);
}

void add_inputs(CLI::App& verb, Arguments& arguments, const char* name, const char* help, int least, int most) {
  verb.add_option(name, arguments.inputs, help)->required()->expected(least, most);
}

void add_compare(CLI::App& app, Arguments& arguments) {
  CLI::App& compare = *app.add_subcommand("compare", "Compare frames, or runs, with the first of them");
  add_inputs(compare, arguments, "A B", "Frames (.exr), or runs or folders of frames", 2, kMostCompared);
  add_output(compare, arguments, "Folder for compare.json and compare.html");
  compare.add_option("--html", arguments.html, "Page to write: tables, and pictures of the frames that differ");
  add_exposure(compare, arguments);
  compare.add_flag("--exact", arguments.exact_only, "Only what is exact and quick: no PSNR, SSIM and FLIP");
  compare.add_option("--peak", arguments.white.value, "PSNR's peak, the linear value that is white on the display; 1");
  Thresholds& limits = arguments.thresholds;
  const auto add = [&](const char* name, auto& value, const char* help) { compare.add_option(name, value, help); };
  add("--fail", limits.fail, "A pixel fails when a channel differs by more; without: by a bit");
  add("--failpercent", limits.fail_percent, "Percentage of the pixels that may fail; 0");
  add("--hardfail", limits.hard_fail, "No pixel may differ by more");
  add("--failflip", limits.fail_flip, "Mean FLIP may not be larger");
  add("--warn", limits.warn, "As --fail, but only said on stderr");
  add("--warnpercent", limits.warn_percent, "As --failpercent");
  add("--hardwarn", limits.hard_warn, "As --hardfail");
  add("--warnflip", limits.warn_flip, "As --failflip");
}

constexpr std::array<std::string_view, 4> kJournalSources{"diff", "variants", "animation", "wedge"};

void add_journal(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& journal = *app.add_subcommand("journal", "Write a journal from what a scene contains");
  journal.require_subcommand(1);
  CLI::App& diff = *journal.add_subcommand("diff", "The step between two exports of a scene");
  CLI::App& variants = *journal.add_subcommand("variants", "A step for each of the scene's material variants");
  CLI::App& animation = *journal.add_subcommand("animation", "A frame for each sample of an animation of the scene");
  CLI::App& wedge = *journal.add_subcommand("wedge", "A frame for each value of one parameter");
  add_inputs(diff, arguments, "A B", "glTF scene, and the same edited", 2, 2);
  add_inputs(variants, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_inputs(animation, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_inputs(wedge, arguments, "SCENE POINTER VALUES",
             "Scene, a parameter's path in its look document, values (JSON or names) or ranges A..B:N", 3, 10000);
  SampleTimes& times = arguments.sample_times;
  animation.add_option("--fps", times.frames_per_second, "Frames a second; 24")->check(CLI::Range(1e-3, 1e4));
  animation.add_option("--from", times.from, "First time in seconds; the first keyframe's")
      ->check(CLI::Range(0.0, 1e6));
  animation.add_option("--to", times.to, "Last time in seconds; the last keyframe's")->check(CLI::Range(0.0, 1e6));
  animation.add_option("--animation", arguments.animation, "Name or number of the animation; the first");
  for (CLI::App* source : journal.get_subcommands(nullptr)) {
    add_output(*source, arguments, "Journal to write")->required();
    source->add_option("--camera", arguments.view.camera, "Camera that the journal is for, which it cannot move");
    add_look_patch(*source, arguments);
    add_lights(*source, raw);
    add_import_rules(*source, arguments);
    add_common(*source, arguments, raw);
  }
}

void add_verbs(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  constexpr int kMostJournals = 10000;
  CLI::App& render = *app.add_subcommand("render", "Render a scene, edited by a journal perhaps");
  add_inputs(render, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_output(render, arguments, "OpenEXR frame to write")->required();
  render.add_option("--journal", arguments.journal, "Edit the scene by this journal first; -: standard input");
  render.add_option("--step", arguments.step, "Last step to apply; all")
      ->check(CLI::Range(0, 1000000))
      ->needs("--journal");
  add_view(render, arguments, raw);
  add_look_patch(render, arguments);
  add_frame_options(render, arguments);

  CLI::App& preprocess = *app.add_subcommand("preprocess", "Write the cache of a scene and a camera");
  add_inputs(preprocess, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_output(preprocess, arguments, "Cache folder to write")->required();
  add_view(preprocess, arguments, raw);
  add_look_patch(preprocess, arguments);
  add_structures(preprocess, arguments, raw);
  preprocess.add_option(
      "--disk", raw.disk,
      "Most disk for the cache, like 20G: ray trees and tunnels are left out where they are worth the least");

  CLI::App& replay = *app.add_subcommand("replay", "Replay journals against a cache: a frame per step and a report");
  add_inputs(replay, arguments, "CACHE JOURNAL", "Cache folder, then journals; -: standard input", 2, kMostJournals);
  add_output(replay, arguments, "Run folder to write")->required();
  replay.add_flag("--verify{100}", raw.verify, "Compare with a full render after each step; =PERCENT of the tiles");
  replay.add_flag("--baseline", arguments.baseline, "Measure one full render for the report");
  replay.add_flag("--overlays", arguments.overlays, "Write images of the regions that each step found, on its frame");
  replay.add_flag("--strict", arguments.strict,
                  "Refuse a cache with any damage, instead of tracing again what is damaged or missing");
  replay.add_option("--steps", raw.steps, "Frames of these steps only, like 3, 2-5 or 4-, after the edits before them");
  replay.add_flag("--fresh", arguments.fresh, "Do every frame asked for, also those that are there already");
  replay.add_option("--report", raw.report, "What to write beside the frames: html (and json), json, or none")
      ->check(CLI::IsMember({"none", "json", "html"}));
  replay.add_option("--scene", arguments.scene, "Refuse a cache that is not of this scene");
  add_look_patch(replay, arguments, "The patch that --scene was preprocessed with")->needs("--scene");
  add_lights(replay, raw, "auto: --scene was preprocessed with --lights auto")->needs("--scene");
  add_frame_options(replay, arguments);
  add_structures(replay, arguments, raw);
  replay
      .add_option(
          "--params", arguments.structures.params,
          "Pointers to what is subject to change: colour trees are kept for each of these alone, from the start")
      ->type_name("POINTER");
  replay
      .add_option(
          "--policy", arguments.structures.policy,
          "What leaves memory first: weight (the paper's), plain-weight (without surface area), lru, size, gdsf")
      ->check(CLI::IsMember({"weight", "plain-weight", "lru", "size", "gdsf"}));
  replay.add_option("--spill", arguments.spill, "Folder for what leaves memory; the run folder")
      ->check(CLI::ExistingDirectory);
  replay.add_option("--disk", raw.disk, "Most disk for what leaves memory, like 20G; 0: it is worked out again");
  replay.add_option("--access-log", arguments.access_log, "File to write: what each step used, for relook tune");

  add_compare(app, arguments);

  CLI::App& inspect = *app.add_subcommand("inspect", "Say what a scene, cache, journal or run contains");
  inspect.add_option("INPUT", arguments.inputs, "Scene, cache, journal or run")->expected(0, 1);
  inspect
      .add_option("--look", arguments.view.look_patch,
                  "Print the look document of a scene or cache; with a JSON Patch: patched by it")
      ->expected(0, 1);
  inspect.add_option("--scene", arguments.scene, "Scene or cache that a journal edits: print the class of each step");
  raw.inspection_view = add_view(inspect, arguments, raw);

  CLI::App& check = *app.add_subcommand("check", "Check every byte and invariant of a cache");
  add_inputs(check, arguments, "CACHE", "Cache folder", 1, 1);

  CLI::App& tune = *app.add_subcommand("tune", "Say what each eviction policy and budget would have cost a replay");
  add_inputs(tune, arguments, "ACCESS_LOG", "What replay --access-log wrote", 1, 1);
  add_journal(app, arguments, raw);

  CLI::App& plan = *app.add_subcommand("plan", "Say what each step of a replay will cost, without replaying");
  add_inputs(plan, arguments, "CACHE JOURNAL", "Cache folder, and journal or -", 2, 3);

  CLI::App& blame = *app.add_subcommand("blame", "Say which steps of a run changed a pixel, and through what");
  add_inputs(blame, arguments, "RUN PIXEL", "Run folder, and a pixel as X,Y: 0,0 is the upper left one", 2, 2);
  blame.add_option("--cache", arguments.cache, "Where the run's cache is now");
  blame.add_option("--journal", arguments.journal, "Where the run's journal is now");
  CLI::App& completions = *app.add_subcommand("completions", "Print completions for a shell");
  completions.add_option("SHELL", arguments.inputs, "bash, zsh or fish")
      ->required()
      ->expected(1)
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  for (CLI::App* verb : {&render, &preprocess, &replay, &inspect, &plan, &blame}) add_import_rules(*verb, arguments);
  for (CLI::App* verb : app.get_subcommands(nullptr)) add_common(*verb, arguments, raw);
}

constexpr std::array<std::string_view, 11> kVerbs{"render", "preprocess", "replay", "compare", "inspect",    "check",
                                                  "tune",   "journal",    "blame",  "plan",    "completions"};
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
  take_structures({}, arguments);
  arguments.view.sampling.shadow_bits = arguments.shadow_bits.value_or(0);
  arguments.view.auto_lights = !raw.lights.empty();
  arguments.progress = static_cast<ProgressStyle>(place_of(raw.progress, kProgressStyles, "--progress style"));
}

/// What CLI11 shows of a value's type: "TEXT:{weight,lru}" has the choices "weight" and "lru".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> choices;
  if (begin != std::string::npos && end != std::string::npos)
    choices = CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
  return choices;
}

/// "plan CACHE JOURNAL --json FILE", too: the third word.
void resolve_plan(const RawTexts& raw, Arguments& arguments) {
  const bool has_file = arguments.inputs.size() > 2;
  if (has_file && raw.json != "-") throw UsageError("CACHE JOURNAL: " + arguments.inputs[2] + " is one too many");
  if (has_file) arguments.json_file = arguments.inputs[2];
  arguments.json = raw.json == "-" && !has_file;
  if (!raw.json.empty() && raw.json != "-") arguments.json_file = raw.json;
}

/// "--json FILE.json", too: the word after --json, which is neither a frame nor a folder.
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

/// `inspect --look SCENE`: the word after --look is the input when there is no other.
void resolve_inspect(const CLI::App& verb, const RawTexts& raw, Arguments& arguments) {
  std::string& patch = arguments.view.look_patch;
  if (arguments.inputs.empty() && !patch.empty()) arguments.inputs.push_back(std::exchange(patch, ""));
  if (arguments.inputs.empty()) throw UsageError("INPUT is required");
  arguments.print_look = verb.count("--look") > 0 && arguments.scene.empty();
  for (const CLI::Option* option : raw.inspection_view)
    if (option->count() > 0) arguments.view_options.push_back("--" + option->get_lnames().front());
}

}  // namespace

void take_structures(const StructureOptions& others, Arguments& arguments) {
  StructureOptions& structures = arguments.structures;
  const NamedStructures& named = arguments.named;
  structures.tunnels = named.tunnels.value_or(others.tunnels);
  structures.tunnel_levels = named.tunnel_levels.value_or(others.tunnel_levels);
  structures.most_tunnels = named.most_tunnels ? named.most_tunnels : others.most_tunnels;
  structures.groups = named.groups.value_or(others.groups);
  structures.atoms = named.atoms.value_or(others.atoms);
  structures.color_trees_percent = named.color_trees_percent.value_or(others.color_trees_percent);
}

std::vector<VerbHelp> command_line_help() {
  CLI::App app;
  Arguments arguments;
  RawTexts raw;
  add_verbs(app, arguments, raw);
  std::vector<VerbHelp> verbs;
  for (const CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) {
    VerbHelp help{verb->get_name(), verb->get_description(), {}};
    for (const CLI::Option* option : verb->get_options()) {
      OptionHelp entry{{}, option->get_description(), option->get_expected_min() > 0, choices_of(*option)};
      for (const std::string& name : option->get_snames()) entry.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) entry.names.push_back("--" + name);
      if (!entry.names.empty()) help.options.push_back(std::move(entry));
    }
    verbs.push_back(std::move(help));
  }
  return verbs;
}

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
  CLI::App app("relook: replays edits of a scene and recomputes exactly the part of the image that changed", "relook");
  app.set_version_flag("--version", version_text);
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
  return {std::move(arguments), ""};
}

}  // namespace relook
