#include "options/verb_options.h"

#include <cstddef>
#include <cstdint>

#include "options/shared_options.h"
#include "region/quadtree.h"

namespace relook {
namespace {

constexpr int kMostCompared = 26;  // named A to Z

void add_integrator(CLI::App& verb, RawTexts& raw, const char* help) {
  verb.add_option("--integrator", raw.integrator, help)
      ->check(CLI::IsMember(std::vector<std::string>{kIntegratorWords.begin(), kIntegratorWords.end()}));
}

}  // namespace

std::vector<const CLI::Option*> add_view(CLI::App& verb, Arguments& arguments, RawTexts& raw) {
  ViewArguments& view = arguments.view;
  const auto before = static_cast<std::ptrdiff_t>(verb.get_options().size());
  verb.add_option("--camera", view.camera, "NAME, auto, or EYE:TARGET:FOV as x,y,z:x,y,z:degrees");
  add_lights(verb, raw);
  verb.add_option("--resolution", raw.resolution, "WxH in pixels; 960x540");
  verb.add_option("--samples", raw.samples, "Samples per pixel; 64, of whitted 1")->check(CLI::Range(1, 4096));
  verb.add_option("--max-depth", view.sampling.max_depth, "Generations of rays; 6")->check(CLI::Range(1, 16));
  add_integrator(
      verb, raw,
      "path: every light, soft shadows, gloss; whitted: lamps without size, sharp shadows and mirrors; path");
  verb.add_option("--diffuse-depth", view.sampling.diffuse_depth,
                  "Of path: bounces off diffuse surfaces, 0: they are lit by lights alone; 2")
      ->check(CLI::Range(0, 16));
  verb.add_option("--glossy-depth", view.sampling.glossy_depth, "Of path: bounces off glossy surfaces; 4")
      ->check(CLI::Range(0, 16));
  verb.add_option("--transmission-depth", view.sampling.transmission_depth,
                  "Of path: passages through transmissive surfaces, rough or not; 16")
      ->check(CLI::Range(0, 16));
  verb.add_option("--lens", raw.lens, "Of path: RADIUS:FOCUS in metres: what is not FOCUS away is blurred")
      ->type_name("RADIUS:FOCUS");
  const std::vector<CLI::Option*> options = verb.get_options();
  return {options.begin() + before, options.end()};
}

namespace {

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

}  // namespace

void add_frame_options(CLI::App& verb, Arguments& arguments) {
  add_exposure(verb, arguments);
  verb.add_flag("--float", arguments.float_frames, "Write 32-bit float frames instead of half");
  verb.add_flag("--aovs", arguments.layers, "Write layers for compositing into the frames, too");
}

namespace {

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

void add_render(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& render = *app.add_subcommand("render", "Render a scene, edited by a journal perhaps");
  add_inputs(render, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_output(render, arguments, "OpenEXR frame to write")->required();
  render.add_option("--journal", arguments.journal, "Edit the scene by this journal first; -: standard input");
  render.add_option("--step", arguments.step, "Last step to apply; all")
      ->check(CLI::Range(0, 1000000))
      ->needs("--journal");
  add_view(render, arguments, raw);
  render.get_option("--camera")
      ->description(
          "NAME, auto, EYE:TARGET:FOV as x,y,z:x,y,z:degrees, or all: a labelled sheet of all cameras of the scene");
  add_look_patch(render, arguments);
  add_frame_options(render, arguments);
}

void add_preprocess(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& preprocess = *app.add_subcommand("preprocess", "Write the cache of a scene and a camera");
  add_inputs(preprocess, arguments, "SCENE", "glTF scene (.gltf or .glb)", 1, 1);
  add_output(preprocess, arguments, "Cache folder to write")->required();
  add_view(preprocess, arguments, raw);
  add_look_patch(preprocess, arguments);
  add_structures(preprocess, arguments, raw);
  preprocess.add_option(
      "--disk", raw.disk,
      "Most disk for the cache, like 20G: ray trees and tunnels are left out where they are worth the least");
}

void add_replay(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  constexpr int kMostJournals = 10000;
  CLI::App& replay = *app.add_subcommand("replay", "Replay journals against a cache: a frame per step and a report");
  add_inputs(replay, arguments, "CACHE JOURNAL", "Cache folder, then journals; -: standard input", 2, kMostJournals);
  add_output(replay, arguments, "Run folder to write")->required();
  replay.add_flag("--verify{100}", raw.verify, "Compare with a full render after each step; =PERCENT of the tiles");
  replay.add_flag("--baseline", arguments.baseline, "Measure one full render for the report");
  replay.add_flag("--overlays", arguments.overlays, "Write images of the regions that each step found, on its frame");
  replay.add_flag("--relight", arguments.relight,
                  "Write each frame's layers of light, with which report.html lights it otherwise; for path");
  replay.add_flag("--strict", arguments.strict,
                  "Refuse a cache with any damage, instead of tracing again what is damaged or missing");
  replay.add_option("--steps", raw.steps, "Frames of these steps only, like 3, 2-5 or 4-, after the edits before them");
  replay.add_flag("--fresh", arguments.fresh, "Do every frame asked for, also those that are there already");
  replay.add_option("--report", raw.report, "What to write beside the frames: html (and json), json, or none")
      ->check(CLI::IsMember({"none", "json", "html"}));
  replay.add_option("--scene", arguments.scene, "Refuse a cache that is not of this scene");
  add_look_patch(replay, arguments, "The patch that --scene was preprocessed with")->needs("--scene");
  add_lights(replay, raw, "auto: --scene was preprocessed with --lights auto")->needs("--scene");
  add_integrator(replay, raw, "Refuse a cache of the other integrator");
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
}

void add_inspect(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& inspect = *app.add_subcommand("inspect", "Say what a scene, cache, journal or run contains");
  inspect.add_option("INPUT", arguments.inputs, "Scene, cache, journal or run")->expected(0, 1);
  inspect
      .add_option("--look", arguments.view.look_patch,
                  "Print the look document of a scene or cache; with a JSON Patch: patched by it")
      ->expected(0, 1);
  inspect.add_option("--scene", arguments.scene, "Scene or cache that a journal edits: print the class of each step");
  CLI::Option* const paths =
      inspect
          .add_option("--paths", arguments.paths_filter,
                      "List the values of a scene or cache that can be edited: pointer, value, range, class, unit; "
                      "FILTER is a part of the pointer, or a pattern with * and ?")
          ->expected(0, 1)
          ->type_name("FILTER");
  inspect
      .add_flag("--cameras", arguments.lists_cameras, "List the cameras: name, eye, direction, field of view, aspect")
      ->excludes(paths);
  raw.inspection_view = add_view(inspect, arguments, raw);
}

void add_plan(CLI::App& app, Arguments& arguments) {
  CLI::App& plan = *app.add_subcommand("plan", "Say what each step of a replay will cost, without replaying");
  add_inputs(plan, arguments, "CACHE JOURNAL", "Cache folder, and journal or -", 2, 3);
}

void add_blame(CLI::App& app, Arguments& arguments) {
  CLI::App& blame = *app.add_subcommand("blame", "Say which steps of a run changed a pixel, and through what");
  add_inputs(blame, arguments, "RUN PIXEL", "Run folder, and a pixel as X,Y: 0,0 is the upper left one", 2, 2);
  blame.add_option("--cache", arguments.cache, "Where the run's cache is now");
  blame.add_option("--journal", arguments.journal, "Where the run's journal is now");
}

void add_report(CLI::App& app, Arguments& arguments) {
  constexpr int kMostRuns = 10000;
  CLI::App& report = *app.add_subcommand("report", "Make pages of runs: their own anew, an index, or one to send");
  add_inputs(report, arguments, "RUN", "Run folders, or folders of several journals' runs", 1, kMostRuns);
  add_output(report, arguments, "Page to write: an index of the runs, or, with --single-file, all of them");
  report.add_flag("--single-file", arguments.single_file, "Write all that the page shows into one file, to send");
  report.add_option("--scale", arguments.scale, "Of --single-file: pixels at 1/N of the frames' size; 1")
      ->check(CLI::Range(1, 64))
      ->type_name("N");
}

void add_sheet(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& sheet = *app.add_subcommand("sheet", "Write a run's frames as one labelled picture, a contact sheet");
  add_inputs(sheet, arguments, "RUN", "Run folder", 1, 1);
  add_output(sheet, arguments, "Picture to write: .png as previews show frames, or .exr, linear")->required();
  sheet.add_option("--columns", arguments.columns, "Pictures in a row; as suits a sheet about 16:10")
      ->check(CLI::Range(1, 1000));
  sheet.add_option("--width", arguments.sheet_width, "Most pixels across of a picture; 320")
      ->check(CLI::Range(16, 16384));
  sheet.add_option("--steps", raw.steps, "Frames of these steps only, like 3, 2-5 or 4-");
  sheet.add_option("--exposure", arguments.own_exposure, "Show 2^EV times the light; as the run's previews")
      ->type_name("EV");
}

void add_completions(CLI::App& app, Arguments& arguments) {
  CLI::App& completions = *app.add_subcommand("completions", "Print completions for a shell");
  completions.add_option("SHELL", arguments.inputs, "bash, zsh or fish")
      ->required()
      ->expected(1)
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
}

}  // namespace

void add_verbs(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  add_render(app, arguments, raw);
  add_preprocess(app, arguments, raw);
  add_replay(app, arguments, raw);
  add_compare(app, arguments);
  add_inspect(app, arguments, raw);
  CLI::App& check = *app.add_subcommand("check", "Check every byte and invariant of a cache");
  add_inputs(check, arguments, "CACHE", "Cache folder", 1, 1);

  CLI::App& tune = *app.add_subcommand("tune", "Say what each eviction policy and budget would have cost a replay");
  add_inputs(tune, arguments, "ACCESS_LOG", "What replay --access-log wrote", 1, 1);
  add_journal(app, arguments, raw);
  add_plan(app, arguments);
  add_blame(app, arguments);
  add_export(app, arguments, raw);
  add_watch(app, arguments, raw);
  add_report(app, arguments);
  add_sheet(app, arguments, raw);
  add_completions(app, arguments);
  add_schema(app, arguments, raw);
  for (const char* verb : {"render", "preprocess", "replay", "inspect", "plan", "blame", "schema", "export", "watch"})
    add_import_rules(*app.get_subcommand(verb), arguments);
  for (CLI::App* verb : app.get_subcommands(nullptr)) add_common(*verb, arguments, raw);
}

}  // namespace relook
