// The command line, parsed and checked: plain values, one struct for all verbs.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/frame_comparison.h"
#include "edit/draft/draft_moves.h"
#include "edit/draft/draft_rig.h"
#include "edit/draft/journal_draft.h"
#include "frame/image.h"
#include "report/report.h"
#include "scene/gltf/import_rules.h"

namespace relook {

enum class Verb : std::uint8_t {
  render,
  preprocess,
  replay,
  compare,
  inspect,
  check,
  tune,
  journal,
  blame,
  plan,
  completions,
  schema,
  export_scene,
  watch,
  report,
  sheet,
  complete  // what the scripts of `completions` ask; not in --help
};
enum class ProgressStyle : std::uint8_t { automatic, plain, json, openjd, none };
/// What a replay writes beside frames.
enum class ReportKind : std::uint8_t { none, json, html };
enum class JournalSource : std::uint8_t { diff, variants, animation, wedge, turntable, aim, rig };

struct ViewArguments {
  std::string camera;  // NAME | auto | EYE:TARGET:FOV; "": the scene's own
  bool auto_lights = false;
  std::string look_patch;  // RFC 6902 file, or ""
  std::uint32_t width = 960, height = 540;
  ViewOptions sampling;

  ViewArguments() { sampling.diffuse_depth = 2; }
};

/// The integrator, and the samples a pixel of either, where the command line says nothing.
inline constexpr Integrator kUsualIntegrator = Integrator::path;
[[nodiscard]] constexpr std::uint32_t usual_samples(Integrator integrator) {
  return integrator == Integrator::path ? 64 : 1;
}

/// What the command line says of structures; what it does not say is the cache's.
struct NamedStructures {
  std::optional<std::uint32_t> tunnels, tunnel_levels, groups, atoms;
  std::optional<std::uint64_t> most_tunnels;
  std::optional<double> color_trees_percent;
};

/// How a scene file is watched.
struct WatchOptions {
  double interval_seconds = 0.5;
  std::optional<std::uint32_t> most_exports;  // until it ends; none: a signal ends it
};

struct Arguments {
  Verb verb = Verb::render;
  std::vector<std::string> inputs;  // positional, in order
  std::string output;
  ViewArguments view;
  StructureOptions structures;
  NamedStructures named;                     // of `structures`
  std::optional<std::uint32_t> shadow_bits;  // preprocess: of the cache, 0; replay: what it must hold
  std::optional<Integrator> integrator;      // of `view`, where it is given; replay: what the cache must be of
  std::size_t threads = 0;                   // 0: all
  bool quiet = false, json = false;
  ImportRules import;
  bool overlays = false;  // images of the regions found
  bool relight = false;   // replay: layers of light for the page
  ProgressStyle progress = ProgressStyle::automatic;
  bool log_json = false;
  bool overwrite = false;  // replace another run or cache, or a single foreign file, that is in the way
  std::string trace;       // file, or ""

  std::string journal;                // render, export; blame: see `cache`
  std::optional<std::uint32_t> step;  // render, export
  bool float_frames = false;          // render, replay
  bool layers = false;                // render, replay: --aovs
  double exposure = 0;                // render, replay, compare: stops, of previews
  std::optional<double> verify_percent;
  bool baseline = false;                  // replay
  bool strict = false;                    // replay: no cache with damage, even such as can be made good
  std::optional<StepRange> steps;         // replay, sheet
  bool fresh = false;                     // replay: no frame of an earlier run is kept
  ReportKind report = ReportKind::html;   // replay
  std::string cache;                      // blame: folder, or "": where the run says; the same for `journal`; watch
  WatchOptions watch;
  std::string spill;                      // replay: folder of the spill file; "": the run's
  std::string access_log;                 // replay: file, or ""
  bool print_look = false;                // inspect
  bool lists_paths = false, lists_cameras = false;  // inspect
  std::string paths_filter;                         // of lists_paths; "": all
  std::vector<std::string> view_options;  // inspect: those of VIEW that were given, as "--camera"
  std::string scene;                      // inspect, replay, schema

  Thresholds thresholds;                               // compare
  DisplayWhite white;                                  // compare: --peak
  bool exact_only = false;                             // compare: no PSNR, SSIM, FLIP
  std::string json_file;                               // compare, plan: --json=FILE, or ""
  std::string html;                                    // compare: file, or ""
  bool single_file = false;                            // report: one page that holds everything
  std::uint32_t scale = 1;                             // report: pixels at 1/scale
  std::uint32_t columns = 0, sheet_width = 320;        // sheet: pictures in a row, 0: as suits; pixels of a picture
  std::optional<double> own_exposure;                  // sheet: stops, where they are given
  JournalSource journal_source = JournalSource::diff;  // journal; the rest: of an animation
  SampleTimes sample_times;
  std::string animation;  // name or number; "": the first, with a warning if there are several
  TurntableOptions turntable;
  AimOptions aim;
  RigOptions rig;
};

/// The arguments, or what to print instead (--help, --version). Throws UsageError.
struct ParsedCommandLine {
  std::optional<Arguments> arguments;
  std::string text;
};
[[nodiscard]] ParsedCommandLine parse_command_line(int argc, const char* const* argv);

/// The structures of an integrator where nothing else is said: those of whitted that path has none of are none.
[[nodiscard]] StructureOptions usual_structures(Integrator integrator);
/// What the command line does not say of structures, or says of those that the integrator has none of, becomes that of
/// `others`.
void take_structures(const StructureOptions& others, Integrator integrator, Arguments& arguments);

}  // namespace relook
